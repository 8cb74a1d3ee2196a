// Tanks of spheres: `brume query --sense`, and as volumes.
#include <gtest/gtest.h>

#include <cmath>

#include "spheres/file.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

// An opaque red ball of 0.5 m at the origin, and to the right of it a white medium.
class Tanks : public CommandTest {
 protected:
  Tanks() {
    const spheres::Tank tank{
        {40, 20, 20}, 0.1f, {{{20, 10, 10}, 5}, {{32, 10, 10}, 4}}, {0xff0000ff, 0x1affffff}};
    spheres::save_tank(folder_.path() / "two.spheres", tank).value_or_throw();
  }
  Outcome sense(const Arguments& more) const {
    return run({"query", "two.spheres", "--sense", "0,0,2 0,0,0 60"}, more);
  }
};

TEST_F(Tanks, AreSensedAsJson) {
  const Json json = json_of({"query", "two.spheres", "--sense", "0,0,2 0,0,0 60", "--size", "3x1"});
  EXPECT_EQ(json["size"], (Json{3, 1}));
  ASSERT_EQ(json["color"].size(), 3u);
  ASSERT_EQ(json["depth"].size(), 3u);
  // The middle ray meets the ball in front; the left one nothing; the right one goes through the medium.
  EXPECT_EQ(json["color"][1], (Json{1.0, 0.0, 0.0}));
  EXPECT_NEAR(json["depth"][1].get<double>(), 1.5, 1e-6);
  EXPECT_EQ(json["opacity"][0], 0.0);
  EXPECT_TRUE(json["depth"][0].is_null());
  EXPECT_GT(json["rays_per_second"].get<double>(), 0);
}

TEST_F(Tanks, AreSensedAsPictures) {
  ASSERT_EQ(sense({"--size", "33x17", "-o", "seen.exr"}).exit_code, 0);
  const image::LayeredImage picture = exr("seen.exr");
  ASSERT_EQ(picture.layers.size(), 5u);  // sorted: A B G R Z
  const auto value = [&](std::size_t layer, std::size_t pixel) {
    return std::get<std::vector<float>>(picture.layers[layer].values)[pixel];
  };
  EXPECT_EQ(value(3, 8 * 33 + 16), 1);
  EXPECT_NEAR(value(4, 8 * 33 + 16), 1.5, 1e-6);
  EXPECT_TRUE(std::isinf(value(4, 0)));
  ASSERT_EQ(sense({"--size", "33x17", "-o", "seen.png"}).exit_code, 0);
  const image::Image8 colors = png("seen.png");
  EXPECT_EQ(colors.width, 33u);
  EXPECT_EQ(colors.rgba[4 * (8 * 33 + 16)], 255);
  EXPECT_EQ(colors.rgba[3], 0);
}

TEST_F(Tanks, RefuseWhatIsNoSensing) {
  folder_.write("room.obj", room_obj());
  const auto refuses = [&](const Arguments& arguments, int code, const std::string& text) {
    expect_failure(folder_, arguments, code, {text});
  };
  refuses({"query", "room.obj", "--sense", "0,0,2 0,0,0"}, 2, "is no tank");
  refuses({"query", "two.spheres", "--sense", "0,0,2 0,0,2"}, 2, "--sense");
  refuses({"query", "two.spheres", "--sense", "0,0,1e6 0,0,0"}, 2, "--sense");
  refuses({"query", "two.spheres", "--sense", "0,0,2 0,0,0", "--time", "1"}, 2, "--time");
  refuses({"query", "two.spheres", "--sense", "0,0,2 0,0,0", "--size", "2000x2000"}, 2, "--size");
  refuses({"query", "two.spheres", "--sense", "0,0,2 0,0,0", "-o", "a.jpg"}, 2, "a.jpg");
  refuses({"query", "room.obj", "--size", "2x2", "--from", "0,0,0", "--to", "0,0,1"}, 2, "--size");
  refuses({"query", "room.obj", "--time", "1"}, 2, "--from");
  folder_.write("broken.spheres", "no tank");
  refuses({"query", "broken.spheres", "--sense", "0,0,2 0,0,0"}, 3, "broken.spheres");
}

TEST_F(Tanks, AreVolumes) {
  EXPECT_EQ(json_of({"convert", "two.spheres", "two.brv"})["grids"], (Json{"density", "Cd"}));
}

// In a level, against the same without the tank.
TEST_F(Tanks, StandInLevels) {
  folder_.write("room.obj", room_obj());
  const std::string level =
      "version = 1\nscene = \"room.obj\"\nduration = 1.0\n[sky]\nambient = [0.4, 0.4, 0.5]\n"
      "[[camera]]\ntime = 0.0\nposition = [0.0, 1.7, 1.8]\ntarget = [0.0, 1.2, -1.0]\nfov = 70.0\n";
  folder_.write("empty.toml", level);
  folder_.write("tank.toml", level + "[[volume]]\nfile = \"two.spheres\"\nposition = [0.0, 1.2, -0.6]\n");
  for (const char* name : {"empty", "tank"}) {
    run_well({"render", name + std::string(".toml"), "-o", name + std::string(".png"), "--size", "64x36",
              "--time", "0.5"});
  }
  const image::Image8 without = png("empty.png"), with = png("tank.png");
  int differing = 0;
  for (std::size_t i = 0; i < with.rgba.size(); i += 4) differing += with.rgba[i] != without.rgba[i];
  // The ball of 0.5 m, 2.4 m away, has 0.5 / 2.4 / tan(35 deg) of half the height as radius: 5 pixels, an
  // area of 88, of which the rim may look like the wall; and the medium beside it.
  EXPECT_GT(differing, 60);
}

}  // namespace
}  // namespace brume::cli
