// script/bench-peers: Brume agrees with the reference, and so do the renderers beside it that are installed.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

RunOptions bench_peers() {
  RunOptions options;
  options.program = BRUME_SOURCE_DIR "/script/bench-peers";
  return options;
}

TEST(BenchPeersTest, RenderersAgreeWithTheReference) {
  const WorkFolder folder;
  const Outcome outcome = run_brume(folder.path(),
                                    {"--quick", "--edge", "48", "--size", "64x48", "--without", "cycles",
                                     "--build", BRUME_BUILD_DIR, "-o", "found"},
                                    bench_peers());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_EQ(folder.files(), std::vector<std::string>{"found"});
  const auto results = nlohmann::json::parse(*read_text_file(folder.path() / "found/results.json"));
  ASSERT_FALSE(results.at("renderers").empty());
  for (const auto& row : results.at("renderers")) {
    const std::string name = row.at("renderer");
    EXPECT_LT(row.at("rmse").get<double>(), 10) << name;
    EXPECT_NEAR(row.at("ratio").get<double>(), 1, 0.1) << name;
    for (const double pixels : row.at("offset_px")) EXPECT_LT(std::abs(pixels), 0.1) << name;
    EXPECT_GT(row.at("cpu").get<double>(), 0) << name;
  }
  for (const char* file : {"results.md", "plot.svg", "pictures.png"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "found" / file)) << file;
}

// script/bench-claims: one file has what all three programs measure, or why they do not.
TEST(BenchClaimsTest, OneFileHasThemAll) {
  const WorkFolder folder;
  RunOptions options;
  options.program = BRUME_SOURCE_DIR "/script/bench-claims";
  const Outcome outcome =
      run_brume(folder.path(), {"--quick", "--build", BRUME_BUILD_DIR, "-o", "claims.json"}, options);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const auto found = nlohmann::json::parse(*read_text_file(folder.path() / "claims.json"));
  std::set<std::string> measured, skipped;
  for (const auto& result : found.at("results")) {
    measured.insert(result.at("name"));
    EXPECT_GT(result.at("median").get<double>(), 0) << result;
  }
  for (const std::string line : found.at("skipped")) skipped.insert(line.substr(0, line.find(": ")));
  EXPECT_TRUE(measured.contains("tank/pack/65535"));
  for (const char* other :
       {"vdb_render/cpu", "vdb_render/error", "nanovdb/gpu", "cycles/time", "cycles/mean"})
    EXPECT_NE(measured.contains(std::string("peers/") + other),
              skipped.contains(std::string("peers/") + other))
        << other;
}

TEST(BenchPeersTest, NamesWhatIsWrong) {
  const WorkFolder folder;
  const Outcome size = run_brume(folder.path(), {"--size", "1x"}, bench_peers());
  EXPECT_EQ(size.exit_code, 2);
  EXPECT_NE(size.error.find("expected WIDTHxHEIGHT"), std::string::npos) << size.error;
  const Outcome build = run_brume(folder.path(), {"--build", "nowhere"}, bench_peers());
  EXPECT_EQ(build.exit_code, 1);
  EXPECT_NE(build.error.find("nowhere/brume is missing"), std::string::npos) << build.error;
  EXPECT_TRUE(folder.files().empty());
}

}  // namespace
}  // namespace brume::cli
