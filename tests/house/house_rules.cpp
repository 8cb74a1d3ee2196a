#include "tests/house/house_rules.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <regex>

namespace brume::house {
namespace {

constexpr std::array<std::string_view, 36> kFolders{"core",
                                                    "palettes",
                                                    "spheres",
                                                    "image",
                                                    "scene",
                                                    "scene/files",
                                                    "voxel",
                                                    "vxl",
                                                    "volume",
                                                    "grids",
                                                    "grids/files",
                                                    "trace",
                                                    "bake",
                                                    "sim",
                                                    "smoke",
                                                    "textures",
                                                    "wire",
                                                    "api",
                                                    "volumes",
                                                    "planning",
                                                    "scenario",
                                                    "surfaces",
                                                    "reference",
                                                    "gpu",
                                                    "passes",
                                                    "render",
                                                    "film",
                                                    "host",
                                                    "bench",
                                                    "apps/vdb",
                                                    "apps/command_line",
                                                    "apps/mpi",
                                                    "apps/viewer",
                                                    "apps/cli",
                                                    "examples",
                                                    "python"};

// The first group of every match.
std::vector<std::string> matches(std::string_view text, const std::regex& pattern) {
  std::vector<std::string> found;
  using Iterator = std::regex_iterator<std::string_view::const_iterator>;
  for (Iterator it(text.begin(), text.end(), pattern); it != Iterator(); ++it)
    found.push_back((*it)[1].str());
  return found;
}

std::size_t indent_of(std::string_view line) {
  return std::min(line.find_first_not_of(' '), line.size());
}

/// Whether a block that begins with this line is no function.
bool is_other_block(std::string_view line) {
  static const std::regex other(
      R"re(\s*((namespace|class|struct|enum|union|extern|if|for|while|switch|else|do)\b|\}|//).*)re");
  return std::regex_match(line.begin(), line.end(), other);
}

auto place(std::string_view folder) {
  return std::distance(kFolders.begin(), std::find(kFolders.begin(), kFolders.end(), folder));
}

}  // namespace

std::span<const std::string_view> folders() {
  return kFolders;
}

std::string_view folder_of(std::string_view path) {
  if (path.starts_with("src/")) path.remove_prefix(4);
  // A folder within a folder is one of its own where it is listed.
  const std::size_t slash = path.find('/'), inner = path.find('/', slash + 1);
  if (slash == std::string_view::npos) return {};
  const bool is_listed =
      inner != std::string_view::npos && place(path.substr(0, inner)) < std::ssize(kFolders);
  return path.substr(0, is_listed ? inner : slash);
}

std::vector<std::string> upward_includes(std::string_view folder, std::string_view text) {
  std::vector<std::string> found;
  for (const std::string& path : quoted_includes(text)) {
    const std::string_view other = folder_of(path);
    if (other.empty()) continue;      // A generated header.
    if (other == "shared") continue;  // The lowest layer: plain structs for C++ and GLSL.
    if (place(other) > place(folder) || place(other) == std::ssize(kFolders)) found.push_back(path);
  }
  return found;
}

std::vector<std::string> vulkan_calls(std::string_view text) {
  static const std::regex call(R"re((\bvk[A-Z]\w*\s*\(|#\s*include\s*[<"]vulkan/[^>"]*))re");
  return matches(text, call);
}

std::vector<std::string> platform_code(std::string_view text) {
  static const std::regex used(
      R"re((#\s*(?:el)?if[^\n]*\b(?:_WIN32|_WIN64|WIN32|_MSC_VER|__MINGW\w+__|__CYGWIN__)re"
      R"re(|__linux__|__unix__|__APPLE__|__EMSCRIPTEN__)\b)re"
      R"re(|#\s*include\s*<(?:windows|unistd|dlfcn|poll|fcntl|signal|pthread|dirent|spawn|process|io)\.h)re"
      R"re(|#\s*include\s*<(?:sys|linux|netinet|arpa)/|"[^"\n]*/proc/))re");
  return matches(text, used);
}

std::vector<std::string> unsized_structs(std::string_view text) {
  static const std::regex declared(R"re(\bstruct\s+(\w+)\s*\{)re");
  static const std::regex sized(R"re(\bSHARED_(?:SIZE|LOCAL)\(\s*(\w+)\s*[,)])re");
  const std::vector<std::string> with_size = matches(text, sized);
  std::vector<std::string> found;
  for (const std::string& name : matches(text, declared)) {
    if (std::find(with_size.begin(), with_size.end(), name) == with_size.end()) found.push_back(name);
  }
  return found;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::vector<std::string> quoted_includes(std::string_view text) {
  static const std::regex include(R"re(#\s*include\s*"([^"]+)")re");
  return matches(text, include);
}

std::size_t line_count(std::string_view text) {
  return lines_of(text).size();
}

std::vector<std::size_t> wide_lines(std::string_view text, std::size_t limit) {
  std::vector<std::size_t> wide;
  const auto lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    // Continuation bytes of UTF-8 are no characters of their own.
    const auto characters =
        std::count_if(lines[i].begin(), lines[i].end(), [](char c) { return (c & 0xc0) != 0x80; });
    if (static_cast<std::size_t>(characters) > limit) wide.push_back(i + 1);
  }
  return wide;
}

std::vector<Length> long_functions(std::string_view text, std::size_t limit) {
  std::vector<Length> found;
  const auto lines = lines_of(text);
  for (std::size_t end = 0; end < lines.size(); ++end) {
    if (lines[end] != "}" && lines[end] != "  }") continue;
    // Up to the line that begins in the same column: the signature.
    const std::size_t indent = indent_of(lines[end]);
    std::size_t begin = end;
    while (begin > 0) {
      const std::string_view line = lines[--begin];
      if (!line.empty() && indent_of(line) == indent && !line.starts_with('#')) break;
    }
    const std::size_t length = end - begin + 1;
    if (length >= limit && !is_other_block(lines[begin]))
      found.push_back({begin + 1, length, std::string(lines[begin])});
  }
  return found;
}

std::vector<std::string> replaced_words(std::string_view glossary) {
  static const std::regex word("`([^`]+)`");
  std::vector<std::string> words;
  for (const std::string_view line : lines_of(glossary)) {
    if (!line.starts_with("| ") || !line.ends_with(" |")) continue;
    const std::size_t column = line.rfind('|', line.size() - 2);
    for (const std::string& found : matches(line.substr(column), word)) words.push_back(found);
  }
  return words;
}

std::vector<std::string> occurring(std::span<const std::string> words, std::string_view text) {
  std::vector<std::string> found;
  for (const std::string& word : words) {
    // "lamp" stands in lamp, far_lamp and kFarLamp, but not in clamp.
    std::string capital = word;
    capital[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(capital[0])));
    if (text.find(word) == text.npos && text.find(capital) == text.npos) continue;  // much faster than regex
    const std::regex whole("(^|[^A-Za-z])" + word + "s?(?![a-z])|" + capital + "s?(?![a-z])");
    if (std::regex_search(text.begin(), text.end(), whole)) found.push_back(word);
  }
  return found;
}

}  // namespace brume::house
