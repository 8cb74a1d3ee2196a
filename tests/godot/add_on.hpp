// The project of the add-on with the scripts of the tests, and Godot to run them.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/api/run_shell.hpp"
#include "tests/work_folder.hpp"

namespace brume {

class GodotAddOn : public testing::Test {
 protected:
  void SetUp() override {
    if (std::string(BRUME_GODOT_PROJECT).empty())
      GTEST_SKIP() << "the add-on is not built: script/godot-headers, then configure and build again";
    if (api::run_shell("command -v godot3-server").status != 0)
      GTEST_SKIP() << "godot3-server is not installed; script/bootstrap test installs it";
    std::filesystem::copy(BRUME_GODOT_PROJECT, project(), std::filesystem::copy_options::recursive);
    for (const char* script :
         {"play_match.gd", "call_match.gd", "compare_rays.gd", "picture.gd", "smoke_alone.gd"})
      std::filesystem::copy_file(std::string(BRUME_SOURCE_DIR "/tests/godot/") + script, project() / script);
  }
  std::filesystem::path project() const { return folder_.path() / "project"; }

  /// Runs a script without a window; errors of Godot are part of the output. The time limit ends only what
  /// hangs.
  api::ShellRun run(const std::string& script, const std::string& environment = "",
                    const std::string& program = "godot3-server") const {
    return api::run_shell("HOME='" + folder_.path().string() + "' LC_ALL=C.UTF-8 " + environment +
                          " timeout --kill-after=9 600 " + program + " --path '" + project().string() +
                          "' -s " + script + " 2>&1");
  }
  /// Runs a script that draws, in a virtual display and on the CPU.
  api::ShellRun run_drawing(const std::string& script, const std::string& environment = "") const {
    return run(script, "LIBGL_ALWAYS_SOFTWARE=1 " + environment,
               "xvfb-run -a -s '-screen 0 1280x720x24' godot3 --audio-driver Dummy");
  }
  static bool draws() { return api::run_shell("command -v godot3 && command -v xvfb-run").status == 0; }

  cli::WorkFolder folder_;
};

/// The numbers that follow a word in an output.
inline std::vector<double> numbers_after(const std::string& output, const std::string& word) {
  std::vector<double> numbers;
  for (std::size_t at = 0; (at = output.find(word + " ", at)) != output.npos; at += word.size())
    numbers.push_back(std::strtod(output.c_str() + at + word.size() + 1, nullptr));
  return numbers;
}

}  // namespace brume
