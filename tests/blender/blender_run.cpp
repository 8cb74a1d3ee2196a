#include "tests/blender/blender_run.hpp"

#include <cstdlib>
#include <sstream>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::blender {
namespace {

BlenderRun run_blender(const std::filesystem::path& folder) {
  BlenderRun run;
  run.folder = folder;
  run.blender_is_there = std::system("command -v blender > /dev/null 2>&1") == 0;
  if (!run.blender_is_there) return run;
  std::ostringstream command;
  command << "'" BRUME_SOURCE_DIR "/tests/blender/run_blender' " BRUME_BLENDER_PART " '" BRUME_PROGRAM "' '"
          << folder.string() << "' > '" << (folder / "log").string() << "' 2>&1";
  run.exit_code = std::system(command.str().c_str());
  run.log = read_text_file(folder / "log").value_or_throw();
  return run;
}

}  // namespace

const BlenderRun& blender_run() {
  static const cli::WorkFolder folder;
  static const BlenderRun run = run_blender(folder.path());
  return run;
}

nlohmann::json read_json(const std::filesystem::path& path) {
  return nlohmann::json::parse(read_text_file(path).value_or_throw());
}

}  // namespace brume::blender
