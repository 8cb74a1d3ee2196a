// Lens and shutter of `brume render`.
#include <gtest/gtest.h>

#include <glm/glm.hpp>

#include "image/png.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

class CameraOptions : public RoomTest {
 protected:
  /// A timeline with a camera that moves, with further keys.
  void write(const std::string& name, const std::string& keys) const {
    std::string text =
        "version = 1\nscene = \"room.obj\"\nduration = 1.0\n[sky]\nambient = [0.4, 0.4, 0.5]\n";
    for (const char* place :
         {"time = 0.0\nposition = [0.0, 1.7, 1.8]\n", "time = 1.0\nposition = [0.5, 1.7, 1.8]\n"})
      text += std::string("[[camera]]\n") + place + "target = [0.0, 1.2, -1.0]\nfov = 70.0\n" + keys;
    // A closed room, lit by the flash of a shot.
    folder_.write(name, text +
                            "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [0.0, 1.5, 1.0]\n"
                            "at = [0.0, 0.5, -1.0]\n[[event]]\ntype = \"shot\"\ntime = 0.49\n"
                            "from = [1.0, 2.0, 1.0]\ntoward = [0.0, 0.5, -1.9]\nflash = 200\n");
  }
  void write_opening(const std::string& name, glm::uvec2 size, std::uint8_t value) const {
    image::Image8 picture{size.x, size.y, std::vector<std::uint8_t>(4 * std::size_t{size.x} * size.y, value)};
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
    image::save_png(folder_.path() / name, picture).value_or_throw();
  }
  Outcome render(const std::string& timeline, const Arguments& more) const {
    return run({"render", timeline, "--size", "40x24"}, more);
  }
  Outcome render_well(const std::string& timeline, const Arguments& more) const {
    return run_well({"render", timeline, "--size", "40x24"}, more);
  }
  /// The picture at half a second.
  std::vector<std::uint8_t> picture(const std::string& timeline, const Arguments& more) const {
    const Outcome run = render_well(timeline, joined(more, {"-o", "a.png", "--time", "0.5"}));
    EXPECT_EQ(run.error, "");
    return png("a.png").rgba;
  }
};

TEST_F(CameraOptions, LensesBlurWhateverTheMode) {
  write("sharp.toml", "");
  write("lens.toml", "aperture = 0.2\nfocus = 1.0\nblades = 6\n");
  for (const char* mode : {"realtime", "reference"}) {
    const auto sharp = picture("sharp.toml", {"--mode", mode, "--samples", "4"});
    const auto blurred = picture("lens.toml", {"--mode", mode, "--samples", "4"});
    EXPECT_NE(blurred, sharp) << mode;
    EXPECT_EQ(picture("lens.toml", {"--mode", mode, "--samples", "4"}), blurred) << mode;
    // A camera of its own is a pinhole.
    EXPECT_EQ(picture("lens.toml", {"--mode", mode, "--camera", "0,1,1.5 0,1,0 50", "--samples", "4"}),
              picture("sharp.toml", {"--mode", mode, "--camera", "0,1,1.5 0,1,0 50", "--samples", "4"}));
  }
  // One sample is that of a pinhole in the middle.
  EXPECT_EQ(picture("lens.toml", {"--samples", "1"}), picture("sharp.toml", {}));
}

TEST_F(CameraOptions, ShuttersBlurWhatMoves) {
  write("still.toml", "");
  write("open.toml", "shutter = 0.3\n");
  for (const char* mode : {"realtime", "reference"}) {
    const auto open = picture("open.toml", {"--mode", mode, "--samples", "4"});
    EXPECT_EQ(picture("still.toml", {"--mode", mode, "--samples", "4", "--shutter", "0.3"}), open) << mode;
    EXPECT_NE(picture("still.toml", {"--mode", mode, "--samples", "4"}), open) << mode;
    EXPECT_EQ(picture("open.toml", {"--mode", mode, "--samples", "4", "--shutter", "0"}),
              picture("still.toml", {"--mode", mode, "--samples", "4"}))
        << mode;
    // The camera of --orbit moves, too.
    for (const char* shutter : {"0", "0.1"})
      render_well("still.toml", {"-o", std::string("o") + shutter + "_%d.png", "--frames", "0-1", "--orbit",
                                 "90", "--mode", mode, "--samples", "4", "--shutter", shutter});
    EXPECT_NE(png("o0_1.png").rgba, png("o0.1_1.png").rgba) << mode;
  }
}

TEST_F(CameraOptions, OpeningsAreImages) {
  write_opening("white.png", {5, 3}, 255);
  write("opening.toml", "aperture = 0.2\nfocus = 1.0\nopening = \"white.png\"\n");
  write("round.toml", "aperture = 0.2\nfocus = 1.0\n");
  for (const char* mode : {"realtime", "reference"})
    EXPECT_NE(picture("opening.toml", {"--mode", mode, "--samples", "4"}),
              picture("round.toml", {"--mode", mode, "--samples", "4"}));

  write_opening("black.png", {4, 4}, 0);
  folder_.write("broken.png", "no image");
  const auto refuse = [&](const std::string& file, const std::vector<std::string>& parts) {
    write("bad.toml", "aperture = 0.2\nopening = \"" + file + "\"\n");
    expect_failure(folder_, {"render", "bad.toml", "-o", "b.png"}, 3, parts);
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "b.png"));
  };
  write_opening("large.png", {1025, 2}, 255);
  write("large.toml", "aperture = 0.2\nopening = \"large.png\"\n");
  expect_failure(folder_, {"render", "large.toml", "-o", "b.png"}, 4,
                 {"large.toml:", "large.png: 1025 x 2 texels", "at most 1024"});
  refuse("black.png", {"bad.toml:", "black.png", "lets no light through"});
  refuse("broken.png", {"bad.toml:", "broken.png"});
  refuse("missing.png", {"bad.toml:", "missing.png"});
  refuse("../white.png", {"bad.toml:", "opening", "below the folder of this file"});
}

TEST_F(CameraOptions, FramesAsNumbersAreMeans) {
  write("lens.toml", "aperture = 0.2\nfocus = 1.0\n");
  for (const char* file : {"a.exr", "a.png"})
    render_well("lens.toml", {"-o", file, "--samples", "8", "--time", "0"});
  for (const image::Layer& layer : exr("a.exr").layers) {
    const bool is_radiance =
        layer.name == "R" || layer.name == "G" || layer.name == "B" || layer.name.starts_with("background.");
    EXPECT_EQ(std::holds_alternative<std::vector<float>>(layer.values), !is_radiance) << layer.name;
    if (layer.name != "A") continue;
    for (const float alpha : std::get<std::vector<float>>(layer.values)) {
      EXPECT_GE(alpha, 0);
      EXPECT_LE(alpha, 1);
    }
  }
}

TEST_F(CameraOptions, AccumulatedFilmsSayThatTheyAreSharp) {
  write("lens.toml", "aperture = 0.2\nfocus = 1.0\n");
  const Outcome run = render("lens.toml", {"-o", "f_%d.png", "--frames", "0-0", "--temporal"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.error.find("--temporal shows neither the aperture nor the shutter"), std::string::npos)
      << run.error;
  const Outcome view = render("lens.toml", {"-o", "v.png", "--view", "depth"});
  EXPECT_NE(view.error.find("--view shows neither"), std::string::npos) << view.error;
  const Outcome none =
      render("room.obj", {"-o", "g_%d.png", "--frames", "0-0", "--temporal", "--shutter", "0.1"});
  EXPECT_NE(none.error.find("--temporal shows neither"), std::string::npos) << none.error;
  expect_failure(folder_, {"render", "lens.toml", "-o", "f_%d.png", "--temporal", "--samples", "4"}, 2,
                 {"--samples", "--temporal"});
}

}  // namespace
}  // namespace brume::cli
