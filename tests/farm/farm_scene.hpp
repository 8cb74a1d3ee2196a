// A scene of smoke that takes little time, and script/farm.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "core/file.hpp"
#include "tests/cli/documents.hpp"
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

/// flight.toml of a second: a camera that moves through the room without smoke, so that the reference draws
/// its frames in hundredths of a second, and needs no device.
inline void write_flight(const WorkFolder& folder) {
  folder.write("room.obj", room_obj());
  folder.write("flight.toml",
               "version = 1\nscene = \"room.obj\"\nduration = 1.0\n"
               "[[camera]]\ntime = 0.0\nposition = [0.0, 1.7, 1.8]\ntarget = [0.0, 1.2, -1.0]\nfov = 70.0\n"
               "[[camera]]\ntime = 1.0\nposition = [0.5, 1.5, 1.0]\ntarget = [0.0, 1.2, -1.0]\nfov = 70.0\n");
}

/// script/farm with the program of this build.
inline Outcome run_farm(const WorkFolder& folder, std::vector<std::string> arguments,
                        const std::string& build = BRUME_BUILD_DIR, RunOptions options = {}) {
  arguments.insert(arguments.begin(), {"--build", build});
  options.program = BRUME_SOURCE_DIR "/script/farm";
  return run_brume(folder.path(), arguments, options);
}

/// The arguments of every line of docs/guides/farm.md that runs script/farm.
inline std::vector<std::vector<std::string>> farm_calls() {
  std::vector<std::vector<std::string>> calls;
  const std::string page = read_text_file(BRUME_SOURCE_DIR "/docs/guides/farm.md").value_or_throw();
  std::istringstream lines(shell_blocks(page));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != "script/farm") continue;
    calls.push_back({std::istream_iterator<std::string>(words), {}});
  }
  return calls;
}

/// The same call with another timeline, in the folder "page", with two small frames.
inline std::vector<std::string> quick(std::vector<std::string> call, const std::string& timeline) {
  call[0] = timeline;
  call[1] = "page";
  const auto options = std::find(call.begin(), call.end(), "--");
  call.insert(options, {"--frames", "0-1", "--shards", "2"});
  call.insert(call.end(), {"--size", "32x18"});
  return call;
}

inline std::string text_of(const WorkFolder& folder, const std::string& name) {
  return read_text_file(folder.path() / name).value_or_throw();
}

}  // namespace brume::cli
