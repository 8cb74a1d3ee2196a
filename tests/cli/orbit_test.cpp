// `brume render --orbit`: the camera circles what it shows.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

class RenderOrbit : public CommandTest {
 protected:
  void bake(const std::string& name, const std::string& seed = "1") const {
    run_well({"bake", "pyroclastic", "--edge", "24", "--seed", seed, "-o", name});
  }
  void expect_renders(const std::string& input, const Arguments& more) const {
    run_well({"render", input, "--size", "48x36"}, more);
  }
  std::vector<std::uint8_t> png(const std::string& name) const { return CommandTest::png(name).rgba; }
};

/// A camera as --camera, after a rotation about the vertical axis through its target.
std::string camera_at(double degrees) {
  const double radians = degrees * std::numbers::pi / 180;
  char text[160];
  std::snprintf(text, sizeof text, "%.9g,1.25,%.9g 0.5,0.75,0 50", 0.5 + 3 * std::sin(radians),
                3 * std::cos(radians));
  return text;
}

TEST_F(RenderOrbit, FrameKOfNIsTurnedByItsPartOfTheAngle) {
  bake("cloud.brv");
  expect_renders("cloud.brv",
                 {"-o", "o_%d.png", "--frames", "2-5", "--orbit", "-120", "--camera", camera_at(0)});
  for (int k = 0; k < 4; ++k) {
    const std::string number = std::to_string(2 + k), range = number + "-" + number;
    expect_renders("cloud.brv", {"-o", "c_%d.png", "--frames", range, "--camera", camera_at(-30.0 * k)});
    EXPECT_EQ(png("o_" + number + ".png"), png("c_" + number + ".png")) << k;
  }
}

TEST_F(RenderOrbit, TheFirstFrameIsThatWithoutAnOrbit) {
  bake("cloud.brv");
  folder_.write("room.obj", room_obj());
  folder_.write("keys.toml",
                "version = 1\nscene = \"room.obj\"\n"
                "[[camera]]\ntime = 0.0\nposition = [0.0, 1.7, 1.8]\ntarget = [0.0, 1.2, -1.0]\n"
                "[[camera]]\ntime = 1.0\nposition = [0.5, 1.7, 1.8]\ntarget = [0.0, 1.2, -1.0]\n");
  for (const std::string input : {"cloud.brv", "room.obj", "keys.toml"}) {
    SCOPED_TRACE(input);
    expect_renders(input, {"-o", "o_%d.png", "--frames", "0-1", "--orbit", "120"});
    expect_renders(input, {"-o", "s_%d.png", "--frames", "0-1"});
    EXPECT_EQ(png("o_0.png"), png("s_0.png"));
    EXPECT_NE(png("o_1.png"), png("s_1.png"));
    if (input != "cloud.brv") continue;
    // One frame is the first of one.
    expect_renders(input, {"-o", "one_%d.png", "--frames", "0-0", "--orbit", "120"});
    EXPECT_EQ(png("one_0.png"), png("s_0.png"));
  }
}

TEST_F(RenderOrbit, ASequencePlaysWhileItTurns) {
  bake("a_0001.brv", "1");
  bake("a_0002.brv", "2");
  const Arguments orbit{"--orbit", "360",   "--frames", "0-1",      "--exposure",
                        "0",       "--fps", "24",       "--camera", camera_at(0)};
  // Beside the same sequence, held at its first frame.
  for (const std::string name : {"a", "b"}) {
    const Arguments speed = name == "b" ? Arguments{"--volume-fps", "0.01"} : Arguments();
    expect_renders("a_%04d.brv", joined(joined({"-o", name + "_%d.png"}, orbit), speed));
  }
  EXPECT_EQ(png("a_0.png"), png("b_0.png"));
  EXPECT_NE(png("a_1.png"), png("b_1.png"));
}

// A frame of another range is at another angle.
TEST_F(RenderOrbit, ResumesOnlyFramesOfTheSameTurn) {
  bake("cloud.brv");
  const auto draw = [&](const std::string& name, const std::string& frames) {
    expect_renders("cloud.brv", {"-o", name, "--orbit", "360", "--resume", "--frames", frames});
  };
  draw("a_%d.png", "0-1");
  draw("a_%d.png", "0-3");
  draw("b_%d.png", "0-3");
  EXPECT_EQ(png("a_1.png"), png("b_1.png"));
}

TEST_F(RenderOrbit, RefusesWhatWouldTurnNothing) {
  bake("cloud.brv");
  const auto refused = [&](const Arguments& more, const std::string& part) {
    expect_failure(folder_, joined({"render", "cloud.brv", "--size", "48x36"}, more), 2, {part});
  };
  refused({"-o", "a.png", "--orbit", "90"}, "--orbit requires a film");
  for (const std::string angle : {"nan", "inf", "36001", "-1e9", "full", ""})
    refused({"-o", "a_%d.png", "--frames", "0-1", "--orbit=" + angle}, "--orbit");
  refused({"-o", "a_%d.png", "--frames", "0-1", "--orbit", "0"}, "0 degrees are no turn");
  refused(words("-o a_%d.png --frames 0-1 --orbit 90 --scale 10 --camera '1,9,1 1,0,1'"),
          "right above or below");
}

}  // namespace
}  // namespace brume::cli
