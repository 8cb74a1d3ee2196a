#include "core/data_files.hpp"

#include <vector>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/platform/process.hpp"
#include "core/utf8.hpp"

namespace brume {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMostPathBytes = 4096;

std::vector<fs::path> data_folders() {
  const fs::path program = platform::program_file().parent_path();
  std::vector<fs::path> folders{program, program.parent_path() / "share/brume"};
  if (auto tree = read_text_file(program / "brume-source.txt", kMostPathBytes)) {
    tree->erase(tree->find_last_not_of('\n') + 1);
    folders.push_back((program / to_path(*tree)).lexically_normal());
  }
  return folders;
}

}  // namespace

std::optional<fs::path> find_data_file(const std::string& name) {
  std::error_code ignored;
  for (const fs::path& folder : data_folders())
    if (fs::exists(folder / to_path(name), ignored)) return folder / to_path(name);
  return std::nullopt;
}

fs::path data_file(const std::string& name) {
  if (const auto found = find_data_file(name)) return *found;
  std::string places;
  for (const fs::path& folder : data_folders()) places += (places.empty() ? "" : ", ") + folder.string();
  throw Error(ErrorCode::bad_input, name + ": is missing; looked in " + places +
                                        "; install the program with cmake --install, or copy the folder "
                                        "beside it");
}

}  // namespace brume
