// A scene of smoke that takes little time, and script/farm.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {

/// room.toml, of so many seconds.
inline void write_scene(const WorkFolder& folder, int seconds) {
  folder.write("room.obj", room_obj());
  folder.write(
      "room.toml",
      "version = 1\nscene = \"room.obj\"\nduration = " + std::to_string(seconds) +
          ".0\n[smoke]\nvoxels = 200\n"
          "[[camera]]\ntime = 0.0\nposition = [0.0, 1.7, 1.8]\ntarget = [0.0, 1.2, -1.0]\nfov = 70.0\n"
          "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [0.0, 1.5, 1.0]\nat = [0.0, 0.5, -1.0]\n");
}

/// script/farm with the program of this build.
inline Outcome run_farm(const WorkFolder& folder, std::vector<std::string> arguments,
                        const std::string& build = BRUME_BUILD_DIR) {
  arguments.insert(arguments.begin(), {"--build", build});
  RunOptions options;
  options.program = BRUME_SOURCE_DIR "/script/farm";
  return run_brume(folder.path(), arguments, options);
}

inline std::string text_of(const WorkFolder& folder, const std::string& name) {
  return read_text_file(folder.path() / name).value_or_throw();
}

}  // namespace brume::cli
