#include "tests/house/house_rules.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <regex>

namespace brume::house {
namespace {

constexpr std::array<std::string_view, 15> kFolders{"core", "image",  "scene",  "voxel",    "volume",
                                                    "sim",  "smoke",  "wire",   "scenario", "planning",
                                                    "gpu",  "passes", "render", "bench",    "apps"};

// The first group of every match.
std::vector<std::string> matches(std::string_view text, const std::regex& pattern) {
  std::vector<std::string> found;
  using Iterator = std::regex_iterator<std::string_view::const_iterator>;
  for (Iterator it(text.begin(), text.end(), pattern); it != Iterator(); ++it)
    found.push_back((*it)[1].str());
  return found;
}

auto place(std::string_view folder) {
  return std::distance(kFolders.begin(), std::find(kFolders.begin(), kFolders.end(), folder));
}

}  // namespace

std::vector<std::string> upward_includes(std::string_view folder, std::string_view text) {
  static const std::regex include(R"re(#\s*include\s*"([^"]+)")re");
  std::vector<std::string> found;
  for (const std::string& path : matches(text, include)) {
    const std::size_t slash = path.find('/');
    if (slash == std::string::npos) continue;  // A generated header.
    const std::string_view other = std::string_view(path).substr(0, slash);
    if (other == "shared") continue;  // The lowest layer: plain structs for C++ and GLSL.
    if (place(other) > place(folder) || place(other) == std::ssize(kFolders)) found.push_back(path);
  }
  return found;
}

std::vector<std::string> vulkan_calls(std::string_view text) {
  static const std::regex call(R"re((\bvk[A-Z]\w*\s*\(|#\s*include\s*[<"]vulkan/[^>"]*))re");
  return matches(text, call);
}

std::vector<std::string> unsized_structs(std::string_view text) {
  static const std::regex declared(R"re(\bstruct\s+(\w+)\s*\{)re");
  static const std::regex sized(R"re(\bSHARED_SIZE\(\s*(\w+)\s*,)re");
  const std::vector<std::string> with_size = matches(text, sized);
  std::vector<std::string> found;
  for (const std::string& name : matches(text, declared)) {
    if (std::find(with_size.begin(), with_size.end(), name) == with_size.end()) found.push_back(name);
  }
  return found;
}

}  // namespace brume::house
