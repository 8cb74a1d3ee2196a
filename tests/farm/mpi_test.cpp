// brume-mpi by several processes on this machine, and the picture of one brume render.
#include <nlohmann/json.hpp>

#include "tests/farm/farm_scene.hpp"

namespace brume::cli {
namespace {

class Mpi : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v mpirun > /dev/null") != 0) GTEST_SKIP() << "mpirun is not installed";
    const Outcome made =
        run_brume(folder_.path(), {"bake", "pyroclastic", "--edge", "48", "-o", "cloud.brv"});
    ASSERT_EQ(made.exit_code, 0) << made.error;
  }
  Outcome run(const std::string& processes, std::vector<std::string> arguments) const {
    RunOptions options;
    options.program = "/usr/bin/env";
    options.environment = {{"OMPI_ALLOW_RUN_AS_ROOT", "1"}, {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"}};
    arguments.insert(arguments.begin(), {"mpirun", "--oversubscribe", "-n", processes, BRUME_MPI_PROGRAM});
    return run_brume(folder_.path(), arguments, options);
  }
  WorkFolder folder_;
};

TEST_F(Mpi, ProcessesMakeThePictureOfOne) {
  const Outcome whole = run_brume(
      folder_.path(), {"render", "cloud.brv", "-o", "whole.png", "--size", "64x48", "--ground", "none"});
  ASSERT_EQ(whole.exit_code, 0) << whole.error;
  const Outcome parts =
      run("3", {"render", "cloud.brv", "-o", "parts.png", "--size", "64x48", "--json", "facts.json"});
  ASSERT_EQ(parts.exit_code, 0) << parts.error;
  const Outcome diff = run_brume(folder_.path(), {"diff", "whole.png", "parts.png", "--json", "-"});
  // Optical depths of the parts are halves: three of a depth of 12 add an error of up to 3 * 2^-11 * 12 to
  // it, 1.8 % of the light behind it, which is 2 of 255 where the display is steep.
  EXPECT_LE(nlohmann::json::parse(diff.out)["max"].get<double>(), 2.0) << "of 255";

  // Each holds about a third of the bricks.
  const auto processes = nlohmann::json::parse(text_of(folder_, "facts.json"))["processes"];
  ASSERT_EQ(processes.size(), 3u);
  std::uint64_t sum = 0, most = 0;
  for (const auto& process : processes) {
    const auto bytes = process["volume_bytes"].get<std::uint64_t>();
    sum += bytes;
    most = std::max(most, bytes);
  }
  EXPECT_GT(sum, 0u);
  EXPECT_LT(most, sum / 2);
}

// A volume that is out of view, of which parts have nothing to show.
TEST_F(Mpi, OneProcessRendersWhateverRenderDoes) {
  const Outcome made = run_brume(folder_.path(), {"bake", "sphere", "--edge", "12", "-o", "ball.brv"});
  ASSERT_EQ(made.exit_code, 0) << made.error;
  const std::vector<std::string> more{"--size", "32x24", "--camera", "0.1,0.2,9 0,0,99 50"};
  std::vector<std::string> render{"render", "ball.brv", "-o", "render.png", "--ground", "none"};
  std::vector<std::string> alone{"render", "ball.brv", "-o", "alone.png"};
  for (auto* words : {&render, &alone}) words->insert(words->end(), more.begin(), more.end());
  ASSERT_EQ(run_brume(folder_.path(), render).exit_code, 0);
  const Outcome one = run("1", alone);
  ASSERT_EQ(one.exit_code, 0) << one.error;
  EXPECT_TRUE(text_of(folder_, "render.png") == text_of(folder_, "alone.png"));
  std::vector<std::string> parts{"render", "ball.brv", "-o", "two.png"};
  parts.insert(parts.end(), more.begin(), more.end());
  const Outcome two = run("2", parts);
  EXPECT_EQ(two.exit_code, 3) << two.error;
  EXPECT_NE(two.error.find("brume: ball.brv: "), std::string::npos) << two.error;
  EXPECT_EQ(two.error.find("MPI_ABORT"), std::string::npos) << two.error;
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "two.png"));
}

TEST_F(Mpi, FailuresHaveTheirCodes) {
  const auto fails = [&](const std::vector<std::string>& arguments, int code, const std::string& part) {
    const Outcome failed = run("2", arguments);
    EXPECT_EQ(failed.exit_code, code) << failed.error;
    const std::size_t at = failed.error.find(part);
    EXPECT_NE(at, std::string::npos) << failed.error;
    EXPECT_EQ(failed.error.find(part, at + 1), std::string::npos) << "once: " << failed.error;
  };
  fails({"render", "none.brv", "-o", "a.png"}, 3, "brume: none.brv");
  fails({"render", "cloud.brv", "-o", "a.jpg"}, 2, "brume: -o a.jpg");
  fails({"render", "cloud.brv", "-o", "cloud.brv.png", "--size", "0x1"}, 2, "brume: --size");
  fails({"render", "cloud.brv"}, 2, "expected -o");
}

}  // namespace
}  // namespace brume::cli
