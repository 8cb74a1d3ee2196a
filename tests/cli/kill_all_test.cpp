// The whole matrix: every command that writes, ended by KILL, TERM, HUP, the file size limit and a full disk.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "tests/cli/kill_matrix.hpp"
#include "tests/cli/reference_kills.hpp"
#ifdef BRUME_VIEWER
#include "tests/viewer/desktop.hpp"
#endif

namespace brume::cli {
namespace {

TEST(KillAll, TwoHundredEnds) {
  int ended = 0;
  for (const WritingCommand& command : writing_commands()) {
    SCOPED_TRACE(testing::PrintToString(command.arguments));
    KillMatrix matrix(command);
    int here = matrix.end_by_signal(SIGKILL, 16);
    for (const int signal : {SIGTERM, SIGHUP}) here += matrix.end_by_signal(signal, 4);
    here += matrix.end_by_file_size(3);
    here += matrix.end_by_full_disk(6);
    std::printf("%3d ends of brume %s\n", here, command.arguments[0].c_str());
    ended += here;
  }
  std::printf("%3d ends in all\n", ended);
  // Without root there is no small disk. Signals that arrive after the last check change nothing.
  EXPECT_GE(ended, ::geteuid() == 0 ? 200 : 170);
}

class KillReference : public ReferenceFolder {};
TEST_F(KillReference, AtTwentyMoments) {
  expect_equal_after_kills(20);
}

#ifdef BRUME_VIEWER
TEST(KillAll, TheViewer) {
  const viewer::Desktop desktop;
  WritingCommand view{{"view", "--play", "room.toml", "--exit-after", "0.2", "--size", "64x40", "--quality",
                       "smallest", "--record", "out/r.toml", "--screenshot", "out/s.png", "--json",
                       "out/a.json"}};
  view.exact = false;
  view.environment = {{"DISPLAY", desktop.name()}};
  KillMatrix matrix(view);
  int ended = matrix.end_by_signal(SIGKILL, 12);
  for (const int signal : {SIGTERM, SIGHUP}) ended += matrix.end_by_signal(signal, 2);
  ended += matrix.end_by_file_size(2);
  EXPECT_GT(ended, 10);
}
#endif

}  // namespace
}  // namespace brume::cli
