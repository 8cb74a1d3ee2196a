#include "apps/cli/data_files.hpp"

#include <vector>

#include "bench/bench.hpp"
#include "core/error.hpp"

namespace brume::cli {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> data_folders() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  return {program, program.parent_path() / "share/brume", fs::path(BRUME_SOURCE_DIR)};
}

}  // namespace

std::optional<fs::path> find_data_file(const std::string& name) {
  std::error_code ignored;
  for (const fs::path& folder : data_folders())
    if (fs::exists(folder / name, ignored)) return folder / name;
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

fs::path scenes_folder(const std::string& folder) {
  if (folder.empty()) return data_file("scenes/demo.toml").parent_path();
  std::error_code ignored;
  if (!fs::exists(fs::path(folder) / "demo.toml", ignored))
    throw Error(ErrorCode::usage, "--scenes " + folder + ": has no demo.toml; name the folder with the demo");
  return folder;
}

std::string build_facts() {
  std::string text = "brume " BRUME_VERSION "\ncommit    " + bench::commit() + "\ncompiler  ";
#ifdef __clang__
  text += "Clang " __clang_version__;
#else
  text += "GCC " __VERSION__;
#endif
  text += "\nbuild     " BRUME_BUILD_TYPE "\nviewer    ";
#ifdef BRUME_VIEWER
  text += "yes";
#else
  text += "no";
#endif
  return text;
}

}  // namespace brume::cli
