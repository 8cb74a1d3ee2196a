#include "tests/house/words.hpp"

#include <regex>
#include <string>

namespace brume::house {
namespace {

/// A line in two: code, without what stands in quotes, and the comment behind it.
struct Line {
  std::string code, comment;
};

Line split(std::string_view line) {
  static const std::regex quoted(R"re("(\\.|[^"\\])*"|'(\\.|[^'\\])')re");
  std::string code = std::regex_replace(std::string(line), quoted, "\"\"");
  const std::size_t begin = code.find("//");
  if (begin == std::string::npos) return {code, ""};
  return {code.substr(0, begin), code.substr(begin)};
}

bool is_blank(const std::string& code) {
  return code.find_first_not_of(' ') == std::string::npos;
}

}  // namespace

std::vector<Length> uncommented_functions(std::string_view text, std::size_t limit) {
  const std::vector<std::string_view> lines = lines_of(text);
  std::vector<Length> found;
  for (const Length& function : long_functions(text, limit + 1)) {
    bool has_comment = false;
    for (std::size_t i = function.line; i + 1 < function.line + function.lines && !has_comment; ++i)
      has_comment = !split(lines[i]).comment.empty();
    if (!has_comment) found.push_back(function);
  }
  return found;
}

std::vector<std::size_t> nounless_comments(std::string_view text) {
  static const std::regex nounless(R"re(//[/!]?<?\s*([Oo]f|[Tt]hose of|[Tt]hat of)\b.*)re");
  const std::vector<std::string_view> lines = lines_of(text);
  std::vector<std::size_t> found;
  bool goes_on = false;  // a sentence of the line before
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto [code, comment] = split(lines[i]);
    if (std::regex_match(comment, nounless) && !(goes_on && is_blank(code))) found.push_back(i + 1);
    goes_on = !comment.empty() && comment.back() != '.';
  }
  return found;
}

std::vector<std::size_t> lines_with_of(std::string_view text) {
  static const std::regex name(R"re((^|[^\w:])of(?!\w|::))re");
  const std::vector<std::string_view> lines = lines_of(text);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string code = split(lines[i]).code;
    if (!code.starts_with('#') && std::regex_search(code, name)) found.push_back(i + 1);
  }
  return found;
}

}  // namespace brume::house
