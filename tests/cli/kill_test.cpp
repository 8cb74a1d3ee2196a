// Interrupted, killed or out of space, at any call: no torn file, and nothing left behind.
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/cli/kill_matrix.hpp"

namespace brume::cli {
namespace {

// A few of the ends that cli_kill_tests tries on every command.
TEST(Kill, LeavesWholeFilesThatTheNextRunCompletes) {
  const auto commands = writing_commands();
  KillMatrix voxelize(commands[0]);
  EXPECT_GT(voxelize.end_by_signal(SIGKILL, 8), 6);
  voxelize.end_by_signal(SIGTERM, 2);
  voxelize.end_by_signal(SIGHUP, 2);
  EXPECT_EQ(voxelize.end_by_file_size(2), 2);
  voxelize.end_by_full_disk(2);
}

TEST(Kill, LeavesFramesThatResume) {
  KillMatrix frames(writing_commands()[3]);
  EXPECT_GT(frames.end_by_signal(SIGKILL, 2), 0);
  EXPECT_GT(frames.end_by_signal(SIGTERM, 2), 0);
  EXPECT_EQ(frames.end_by_file_size(1), 1);
}

}  // namespace
}  // namespace brume::cli
