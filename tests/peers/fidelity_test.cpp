// script/fidelity: the real-time renderer is as far from the path tracer as the kept figures say.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

TEST(FidelityTest, KeptFiguresHold) {
  const WorkFolder folder;
  RunOptions options;
  options.program = BRUME_SOURCE_DIR "/script/fidelity";
  const Outcome outcome = run_brume(folder.path(), {"--check", "--build", BRUME_BUILD_DIR, "found"}, options);
  std::fputs(outcome.out.c_str(), stdout);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_NE(outcome.out.find("one_light_single"), std::string::npos) << outcome.out;
}

// The figures of one scene at a tiny size: that all still works.
TEST(FidelityTest, ComparesAScene) {
  const WorkFolder folder;
  RunOptions options;
  options.program = BRUME_SOURCE_DIR "/script/fidelity";
  const Outcome outcome = run_brume(
      folder.path(),
      {"--scenes", "doorway", "--size", "30x20", "--samples", "16", "--build", BRUME_BUILD_DIR, "found"},
      options);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_NE(outcome.out.find("| doorway | full |"), std::string::npos) << outcome.out;
  for (const char* file : {"fidelity.json", "results.md", "doorway_full.png", "doorway_single_flip.png"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "found" / file)) << file;
}

}  // namespace
}  // namespace brume::cli
