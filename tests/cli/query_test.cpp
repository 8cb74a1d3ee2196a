// `brume query`: visibility through smoke, holes and walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

// A closed room of 4 x 3 x 4 m with a block in it, with a smoke at 0.1 s that dissolves within 2 s.
class Query : public RoomTest {
 protected:
  Query() {
    folder_.write(
        "smoke.toml",
        "version = 1\nscene = \"room.obj\"\nduration = 3.0\n"
        "[smoke]\nvoxels = 3000\nbloom = 0.3\nhold = 1.2\ndissolve = 0.3\nextinction = 4.0\n"
        "[[event]]\ntype = \"smoke\"\ntime = 0.1\nfrom = [-1.5, 2.5, 1.5]\nat = [-1.5, 2.4, 1.5]\n");
  }
  Outcome query(const Arguments& more) const { return run({"query", "smoke.toml"}, more); }
  Json answer(const Arguments& more) const { return json_of({"query", "smoke.toml"}, more); }
  // Through the upper half of the room, over the block.
  static Arguments across(const Arguments& more) {
    return joined({"--from", "-1.6,2.5,-1.6", "--to", "1.6,2.5,1.6"}, more);
  }
};

TEST_F(Query, SmokeHidesWhileItLasts) {
  const Json before = answer(across({"--time", "0"}));
  EXPECT_TRUE(before["visible"]);
  EXPECT_EQ(before["optical_depth"], 0);
  EXPECT_EQ(before["transmittance"], 1);
  EXPECT_NEAR(before["distance"].get<double>(), std::hypot(3.2, 3.2), 1e-5);
  EXPECT_TRUE(before["first_solid"].is_null());

  const Json during = answer(across({"--time", "1"}));
  EXPECT_FALSE(during["visible"]);
  EXPECT_EQ(during["hidden_by"], "smoke");
  // At most dense smoke along the whole line.
  EXPECT_LE(during["optical_depth"].get<double>(), 4 * std::hypot(3.2, 3.2) * 1.0001);
  EXPECT_NEAR(during["transmittance"].get<double>(), std::exp(-during["optical_depth"].get<double>()), 1e-9);
  EXPECT_TRUE(answer(across({"--time", "1", "--threshold", "1000"}))["visible"]);
  EXPECT_TRUE(answer(across({"--time", "2.9"}))["visible"]);
}

TEST_F(Query, DrawnSmokeIsErodedByTheSceneSNoise) {
  const Json smooth = answer(across({"--time", "1"})), drawn = answer(across({"--time", "1", "--drawn"}));
  EXPECT_FALSE(smooth["drawn"]);
  EXPECT_TRUE(drawn["drawn"]);
  EXPECT_NE(drawn["optical_depth"], smooth["optical_depth"]);
  EXPECT_EQ(drawn["first_solid"], smooth["first_solid"]);
  folder_.write("smooth.toml", std::regex_replace(*read_text_file(folder_.path() / "smoke.toml"),
                                                  std::regex("extinction"), "erosion = 0\nextinction"));
  const Json without = json_of({"query", "smooth.toml"}, across({"--time", "1", "--drawn"}));
  // Steps of 1.8 cm where the smoke begins and ends.
  EXPECT_NEAR(without["optical_depth"].get<double>(), smooth["optical_depth"].get<double>(), 4 * 0.04);
  const Json report = answer(across({"--report", "--times", "0.9-1.1", "--drawn"}));
  EXPECT_NEAR(report["intervals"][0]["max_optical_depth"].get<double>(), drawn["optical_depth"].get<double>(),
              4 * 0.2);
}

TEST_F(Query, WallsHideWithoutSmoke) {
  const Json out = answer({"--from", "0,2.5,0", "--to", "9,2.5,0", "--time", "0"});
  EXPECT_FALSE(out["visible"]);
  EXPECT_EQ(out["hidden_by"], "wall");
  EXPECT_NEAR(out["first_solid"]["distance"].get<double>(), 2, 0.26);  // the wall at x = 2, in its voxel
}

TEST_F(Query, PrintsTheSameAsText) {
  const Outcome run = query(across({"--time", "1"}));
  EXPECT_EQ(run.exit_code, 0) << run.error;
  EXPECT_NE(run.out.find("visible         no, hidden by smoke\n"), std::string::npos) << run.out;
  const Outcome report = query(across({"--report", "--shots", "1", "--shots-at", "1"}));
  EXPECT_EQ(report.exit_code, 0) << report.error;
  EXPECT_EQ(report.out.rfind("hidden for ", 0), 0u) << report.out;
  EXPECT_NE(report.out.find("visible after 1 of 1 shots\n"), std::string::npos) << report.out;
}

TEST_F(Query, ReportsHiddenIntervals) {
  const Json report = answer(across({"--report"}));
  ASSERT_EQ(report["intervals"].size(), 1u) << report;
  const Json& hidden = report["intervals"][0];
  EXPECT_EQ(hidden["by"], "smoke");
  // Not before the detonation and not after the end: 0.1 + 0.3 + 1.2 + 0.3 s.
  EXPECT_GT(hidden["begin"], 0.1);
  EXPECT_LT(hidden["begin"], 0.5);
  EXPECT_GT(hidden["end"], 1.5);
  EXPECT_LT(hidden["end"], 2.0);
  EXPECT_NEAR(report["hidden_seconds"].get<double>(),
              hidden["end"].get<double>() - hidden["begin"].get<double>(), 1e-6);
  // The report agrees with single samples at the ends of the interval.
  for (const double off : {-1.5, 0.5}) {
    const double begin = hidden["begin"].get<double>() + off / 64,
                 end = hidden["end"].get<double>() + off / 64;
    EXPECT_EQ(answer(across({"--time", std::to_string(begin)}))["visible"], off < 0);
    EXPECT_EQ(answer(across({"--time", std::to_string(end)}))["visible"], off > 0);
  }
  // A shorter report.
  const Json part = answer(across({"--report", "--times", "0.75-1.25"}));
  ASSERT_EQ(part["intervals"].size(), 1u);
  EXPECT_EQ(part["intervals"][0]["begin"], 0.75);
  EXPECT_EQ(part["intervals"][0]["end"], 1.25);
}

TEST_F(Query, ExitCodeOfAnExpectation) {
  EXPECT_EQ(query(across({"--time", "1", "--expect", "hidden"})).exit_code, 0);
  EXPECT_EQ(query(across({"--time", "2.9", "--expect", "visible"})).exit_code, 0);
  EXPECT_EQ(query(across({"--report", "--expect", "hidden"})).exit_code, 0);
  const Outcome hidden = query(across({"--time", "1", "--expect", "visible"}));
  EXPECT_EQ(hidden.exit_code, 7);
  EXPECT_EQ(hidden.error, "brume: --to is hidden, expected visible\n");
  EXPECT_NE(hidden.out.find("hidden by smoke"), std::string::npos) << "the result is there all the same";
}

TEST_F(Query, WarnsOfEndsInsideOfWalls) {
  const Outcome run = query({"--from", "2,1,0", "--to", "0,1,0", "--time", "0"});
  EXPECT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(run.error, "brume: warning: --from lies in something solid\n");
}

TEST_F(Query, CountsTheShotsUntilVisible) {
  const auto shots = [&](const Arguments& more) {
    return answer(joined(across({"--report", "--times", "0.5-1.4"}), more))["shots"];
  };
  // One shot along the line is enough.
  const Json one = shots({"--shots", "3", "--shots-at", "0.6", "--shots-every", "0.25"});
  EXPECT_EQ(one["visible_after"], 1);
  EXPECT_EQ(one["each"].size(), 1u);
  EXPECT_EQ(one["each"][0]["time"], 0.6);
  EXPECT_LT(one["each"][0]["min_optical_depth"], 0.05);
  // Shots beside the line are not.
  const Json none = shots({"--shots", "2", "--shots-at", "0.6", "--spread", "40"});
  EXPECT_TRUE(none["visible_after"].is_null());
  ASSERT_EQ(none["each"].size(), 2u);
  EXPECT_FALSE(none["each"][1]["visible"]);
  EXPECT_GT(none["each"][0]["min_optical_depth"], 3);
  // No shot is needed if nothing hides the target.
  const Json needless = answer(across({"--report", "--shots", "2", "--shots-at", "2.5"}))["shots"];
  EXPECT_EQ(needless["visible_after"], 0);
}

TEST_F(Query, RejectsInvalidArguments) {
  const auto refuses = [&](const Arguments& more, int exit_code, const std::string& part) {
    expect_failure(folder_, joined({"query", "smoke.toml"}, more), exit_code, {part});
  };
  refuses(across({}), 2, "--time");
  refuses(across({"--time", "-1"}), 2, "--time");
  refuses(across({"--time", "nan"}), 2, "--time");
  refuses(across({"--time", "1", "--report"}), 2, "--times");
  refuses(across({"--time", "1", "--shots", "2"}), 2, "--report");
  refuses(across({"--time", "1", "--spread", "2"}), 2, "--report");
  refuses(across({"--report", "--shots-at", "1"}), 2, "--shots-at requires --shots");
  refuses(across({"--report", "--times", "3-1"}), 2, "--times");
  refuses(across({"--time", "1", "--scale", "0"}), 2, "--scale");
  refuses(across({"--report", "--times", "0-nan"}), 2, "--times");
  refuses(across({"--time", "1", "--threshold", "-2"}), 2, "--threshold");
  refuses({"--from", "0,nan,0", "--to", "1,1,1", "--time", "1"}, 2, "--from");
  refuses({"--from", "0,0,0", "--to", "1,1e6,1", "--time", "1"}, 2, "--to");
  refuses({"--from", "0,1,0", "--to", "0,1,0", "--report", "--shots", "1"}, 2, "--shots");
  refuses(across({"--time", "1", "--json", "no/such/folder/a.json"}), 2, "no/such/folder");
  expect_failure(folder_, words("query missing.toml --from 0,0,0 --to 1,1,1 --time 1"), 3, {"missing.toml"});
}

}  // namespace
}  // namespace brume::cli
