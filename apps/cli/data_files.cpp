#include "apps/cli/data_files.hpp"

#include "bench/bench.hpp"
#include "core/data_files.hpp"
#include "core/error.hpp"
#include "core/utf8.hpp"

namespace brume::cli {

namespace fs = std::filesystem;

fs::path scenes_folder(const std::string& folder) {
  if (folder.empty()) return data_file("scenes/demo.toml").parent_path();
  std::error_code ignored;
  if (!fs::exists(to_path(folder) / "demo.toml", ignored))
    throw Error(ErrorCode::usage, "--scenes " + folder + ": has no demo.toml; name the folder with the demo");
  return to_path(folder);
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
