// script/compare-decals: decals agree with rays.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

TEST(CompareDecalsTest, DecalsAgreeWithRays) {
  const WorkFolder folder;
  RunOptions options;
  options.program = BRUME_SOURCE_DIR "/script/compare-decals";
  const Outcome outcome =
      run_brume(folder.path(), {"--quick", "--build", BRUME_BUILD_DIR, "-o", "found"}, options);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_EQ(folder.files(), std::vector<std::string>{"found"});
  const auto results = nlohmann::json::parse(*read_text_file(folder.path() / "found/results.json"));
  ASSERT_EQ(results.size(), 1u);
  const auto& inside = results[0].at("sum").at("inside");
  EXPECT_GT(inside.at("pixels").get<int>(), 500);
  EXPECT_GT(inside.at("reference").get<double>(), 0.03);
  EXPECT_LT(inside.at("rmse").get<double>(), inside.at("reference").get<double>());
  for (const char* file : {"results.md", "pose_00.png", "pose_02.png"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "found" / file)) << file;
}

}  // namespace
}  // namespace brume::cli
