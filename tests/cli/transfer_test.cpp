// --color-map, --opacity and --range of a volume without a timeline.
#include <gtest/gtest.h>

#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

class TransferOptions : public RoomTest {
 protected:
  TransferOptions() {
    run_well({"bake", "pyroclastic", "--edge", "32", "-o", "scan.brv"});
    folder_.write("t.toml", "version = 1\nscene = \"scan.brv\"\n");
  }
  Outcome render(const std::string& input, const std::string& output, const Arguments& more) const {
    return run({"render", input, "-o", output, "--size", "48x36"}, more);
  }
  std::vector<std::uint8_t> png(const std::string& name) const { return CommandTest::png(name).rgba; }
};

TEST_F(TransferOptions, ChangeThePicture) {
  const std::vector<std::vector<std::string>> variants{{},
                                                       {"--color-map", "viridis"},
                                                       {"--color-map", "inferno"},
                                                       {"--opacity", "0:0,0.4:0,0.5:1,0.6:0"},
                                                       {"--opacity", "0:0,1:1", "--range", "0.5,2"}};
  std::vector<std::vector<std::uint8_t>> pictures;
  for (const auto& variant : variants) {
    const std::string name = std::to_string(pictures.size()) + ".png";
    const Outcome run = render("scan.brv", name, variant);
    ASSERT_EQ(run.exit_code, 0) << run.error;
    pictures.push_back(png(name));
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i) EXPECT_NE(pictures[i], pictures.back()) << name;
  }
}

// A box of which one half is -1, the other 1: curves for either half draw a half, one for both all.
TEST_F(TransferOptions, ValuesBelowZeroAreDrawn) {
  std::string raw;
  for (int i = 0; i < 16 * 16 * 16; ++i) {
    const float value = i % 16 < 8 ? -1 : 1;
    raw.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  folder_.write("signed.raw", raw);
  folder_.write("signed.json",
                R"({"format": "brume raw volume", "version": 1, "raw": "signed.raw", "size": [16, 16, 16]})");
  const std::vector<std::string> view{"--ground", "none", "--camera", "0,8,60 0,8,0 30"};
  const auto draw = [&](const std::string& name, const Arguments& more) {
    const Outcome run = render("signed.json", name, joined(more, view));
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return run.error;
  };
  // Columns of the middle row that differ from the sky.
  const auto width = [&](const std::string& name) {
    const std::vector<std::uint8_t> seen = png(name), sky = png("sky.png");
    int columns = 0;
    for (std::size_t at = 4 * 18 * 48; at < 4 * 19 * 48; at += 4)
      columns += std::abs(seen[at] - sky[at]) + std::abs(seen[at + 1] - sky[at + 1]) > 24;
    return columns;
  };
  EXPECT_EQ(draw("sky.png", {"--range", "-1,1", "--opacity", "0:0,1:0"}), "");
  EXPECT_EQ(draw("low.png", {"--range", "-1,1", "--opacity", "0:1,0.2:1,0.4:0,1:0"}), "");
  EXPECT_EQ(draw("high.png", {"--range", "-1,1", "--opacity", "0:0,0.6:0,0.8:1,1:1"}), "");
  EXPECT_EQ(draw("both.png", {"--range", "-1,1", "--opacity", "0:1,0.4:1,0.5:0,0.6:1,1:1"}), "");
  EXPECT_NE(draw("plain.png", {}).find("has values below 0, down to -1, which count as 0"),
            std::string::npos);
  // 48 columns are 43 m of the middle of the box, and its front is nearer: a half is 9 to 10.5.
  for (const char* name : {"low.png", "high.png", "plain.png"}) EXPECT_NEAR(width(name), 9.5, 1.5) << name;
  EXPECT_NEAR(width("both.png"), 19, 2);
}

TEST_F(TransferOptions, MistakesAreOneLine) {
  const std::string of_timeline = "is for a volume without a timeline; set it in [[volume]] of the timeline";
  for (const auto& [input, more, message] :
       std::vector<std::tuple<std::string, std::vector<std::string>, std::string>>{
           {"scan.brv", {"--color-map", "virdis"}, "no colour map \"virdis\"; did you mean \"viridis\"?"},
           {"scan.brv", {"--opacity", "0:0"}, "expected 2 to 64 points [position, opacity], found 1"},
           {"scan.brv", {"--opacity", "0,1"}, "expected points position:opacity, such as 0:0,0.3:0,1:1"},
           {"scan.brv", {"--opacity", "0:0,nan:1"}, "expected points position:opacity"},
           {"scan.brv", {"--opacity", "0.5:0,0.25:1"}, "point 2: expected a position from 0.5 on"},
           {"scan.brv", {"--opacity", "0:0,1:2"}, "point 2: expected numbers from 0 to 1"},
           {"scan.brv", {"--range", "3,1"}, "expected the lower value first"},
           {"scan.brv", {"--range", "3"}, "expected the lowest and the highest value"},
           {"scan.brv", {"--color-map", "grey", "--raycast", "two-pass"}, "draws no transfer functions"},
           {"t.toml", {"--color-map", "grey"}, of_timeline},
           {"t.toml", {"--range", "0,1"}, of_timeline},
           {"room.obj", {"--opacity", "0:0,1:1"}, "is for a volume; room.obj is a scene"}}) {
    expect_failure(folder_, joined({"render", input, "-o", "x.png"}, more), 2, {message});
  }
}

}  // namespace
}  // namespace brume::cli
