// Kills of a reference rendering, which goes on from its checkpoint.
#pragma once

#include <signal.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "tests/cli/command_test.hpp"

namespace brume::cli {

inline const Arguments kRenderReference = words("render room.toml --mode reference --size 40x24");

class ReferenceFolder : public RoomTest {
 protected:
  ReferenceFolder() {
    folder_.write(
        "room.toml",
        "version = 1\nscene = \"room.obj\"\nduration = 1.0\n[sky]\nambient = [0.4, 0.4, 0.5]\n"
        "[[camera]]\ntime = 0.0\nposition = [0.0, 1.7, 1.8]\ntarget = [0.0, 1.2, -1.0]\nfov = 70.0\n"
        "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [0.0, 1.5, 1.0]\nat = [0.0, 0.5, -1.0]\n");
  }
  Outcome render(const Arguments& more, const RunOptions& options = {}) const {
    return run(kRenderReference, more, options);
  }
  Outcome render_well(const Arguments& more) const { return run_well(kRenderReference, more); }

  /// Kills the program so many times, each at one of the calls by which it writes files after a new
  /// checkpoint, at random; compares what the last run writes with the picture of a run that nothing ended.
  void expect_equal_after_kills(int kills) const {
    namespace fs = std::filesystem;
    const std::vector<std::string> arguments{
        "-o",           "resumed.exr", "--samples", std::to_string(80 * (kills + 1)),
        "--checkpoint", "room.brc",    "--threads", "2"};
    const fs::path file = folder_.path() / "room.brc";
    const auto written = [&] {
      std::error_code error;
      const auto time = fs::last_write_time(file, error);
      return error ? fs::file_time_type::min() : time;
    };
    std::mt19937 random(11);
    // To write a picture takes at least four calls, so that each run lives until then.
    std::uniform_int_distribution<int> more_calls(0, 3);
    int killed = 0;
    for (int i = 0; i < kills; ++i) {
      const auto before = written();
      int calls = more_calls(random);
      RunOptions options;
      options.signal = SIGKILL;
      options.signal_when = [&] { return written() > before && calls-- == 0; };
      options.signal_before_call = true;
      killed += render(arguments, options).exit_code == 128 + SIGKILL;
    }
    EXPECT_EQ(killed, kills) << "the others ended before";
    RunOptions process;  // Checkpoints name the program.
    process.own_process = true;
    ASSERT_EQ(render(arguments, process).exit_code, 0);
    std::vector<std::string> whole = arguments;
    whole[1] = "whole.exr";
    whole[5] = "whole.brc";
    ASSERT_EQ(render(whole, process).exit_code, 0);
    EXPECT_EQ(bytes("resumed.exr"), bytes("whole.exr"));
    EXPECT_EQ(bytes("room.brc"), bytes("whole.brc"));
  }
};

}  // namespace brume::cli
