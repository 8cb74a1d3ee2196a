#include "tests/house/pages.hpp"

#include <cctype>
#include <map>
#include <regex>
#include <sstream>

namespace brume::house {
namespace {

std::vector<std::string> page_lines(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// `[text](target)` in a heading counts as its text, and code as what it holds.
std::string plain(const std::string& heading) {
  static const std::regex kLink(R"(\[([^\]]*)\]\([^)]*\))");
  return std::regex_replace(heading, kLink, "$1");
}

std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : plain(heading)) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '-' || c == '_' || byte >= 0x80)
      anchor += static_cast<char>(std::tolower(byte));
    else if (c == ' ')
      anchor += '-';
  }
  return anchor;
}

}  // namespace

std::string without_code(std::string_view markdown) {
  std::string result;
  bool in_code = false;
  for (const std::string& line : page_lines(markdown)) {
    const bool is_fence = line.starts_with("```");
    if (!is_fence && !in_code) result += line;
    if (is_fence) in_code = !in_code;
    result += '\n';
  }
  return result;
}

std::vector<Link> links_of(std::string_view markdown) {
  static const std::regex kTarget(R"(\]\(([^)\s]+)\)|(?:href|src)=\"([^\"]+)\")"), kCode("`[^`]*`");
  std::vector<Link> links;
  std::size_t number = 0;
  for (const std::string& whole : page_lines(without_code(markdown))) {
    ++number;
    const std::string line = std::regex_replace(whole, kCode, "");
    for (std::sregex_iterator at(line.begin(), line.end(), kTarget), end; at != end; ++at)
      links.push_back({number, (*at)[1].matched ? (*at)[1].str() : (*at)[2].str()});
  }
  return links;
}

std::set<std::string> anchors_of(std::string_view markdown) {
  std::set<std::string> anchors;
  std::map<std::string, int> seen;
  for (const std::string& line : page_lines(without_code(markdown))) {
    const std::size_t level = line.find_first_not_of('#');
    if (level == 0 || level == std::string::npos || level > 6 || line[level] != ' ') continue;
    const std::string anchor = anchor_of(line.substr(level + 1));
    const int before = seen[anchor]++;
    anchors.insert(before == 0 ? anchor : anchor + "-" + std::to_string(before));
  }
  return anchors;
}

std::vector<Reference> references_in(std::string_view source) {
  static const std::regex kFile(
      R"re(\b((?:docs/[\w/-]+|[A-Z]{4,})\.md|(?:lib|shared)/\w+\.(?:glsl|h))\b(?:, "([^"]+)")?)re");
  std::vector<Reference> found;
  std::size_t number = 0;
  for (const std::string& line : page_lines(source)) {
    ++number;
    const std::size_t begin = line.find("//");
    if (begin == std::string::npos) continue;
    const std::string comment = line.substr(begin);
    for (std::sregex_iterator at(comment.begin(), comment.end(), kFile), end; at != end; ++at)
      found.push_back({number, (*at)[1].str(), (*at)[2].str()});
  }
  return found;
}

std::vector<std::string> vague_phrases(std::string_view text) {
  static const std::regex kPhrase(R"(\b([Tt]hat|[Tt]hose) of\b|(^|[.|:] |/// |// |< )Of )");
  std::vector<std::string> found;
  std::size_t number = 0;
  for (const std::string& line : page_lines(without_code(text))) {
    ++number;
    std::smatch match;
    if (std::regex_search(line, match, kPhrase)) found.push_back(std::to_string(number) + ": " + match.str());
  }
  return found;
}

}  // namespace brume::house
