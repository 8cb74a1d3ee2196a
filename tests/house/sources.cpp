#include "tests/house/sources.hpp"

#include <set>

#include "core/file.hpp"

namespace brume::house {

int for_each_source(const std::filesystem::path& folder,
                    const std::function<void(const std::filesystem::path&, const std::string&)>& visit) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    static const std::set<std::filesystem::path> kSources{".c",    ".cpp",  ".hpp",  ".h",   ".comp",
                                                          ".vert", ".frag", ".glsl", ".hlsl"};
    if (!kSources.contains(extension)) continue;
    visit(entry.path(), *read_text_file(entry.path()));
    ++count;
  }
  return count;
}

}  // namespace brume::house
