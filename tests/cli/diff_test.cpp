// `brume diff`: the difference of two images.
#include <gtest/gtest.h>

#include <cmath>

#include "image/png.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

// A grey image, one with a texel 20 brighter in green, one of another size.
class Diff : public CommandTest {
 protected:
  Diff() {
    image::Image8 image{33, 17, std::vector<std::uint8_t>(33 * 17 * 4, 100)};
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    image::save_png(folder_.path() / "a.png", image).value_or_throw();
    image.rgba[4 * (8 * 33 + 16) + 1] = 120;
    image::save_png(folder_.path() / "b.png", image).value_or_throw();
    image.rgba[4 * (8 * 33 + 16) + 1] = 100;
    image.rgba[3] = 155;
    image::save_png(folder_.path() / "clear.png", image).value_or_throw();
    const image::Image8 small{16, 17, std::vector<std::uint8_t>(16 * 17 * 4, 255)};
    image::save_png(folder_.path() / "small.png", small).value_or_throw();
  }
  Outcome diff(const Arguments& more) const { return run({"diff"}, more); }
};

TEST_F(Diff, OneTexel) {
  const Json json = json_of({"diff", "a.png", "b.png", "-o", "map.png"});
  constexpr double kValues = 33 * 17 * 3;
  EXPECT_NEAR(json["max"].get<double>(), 20, 1e-4);
  EXPECT_NEAR(json["mean"].get<double>(), 20 / kValues, 1e-6);
  EXPECT_NEAR(json["rmse"].get<double>(), 20 / std::sqrt(kValues), 1e-5);
  EXPECT_NEAR(json["psnr"].get<double>(), 20 * std::log10(255 * std::sqrt(kValues) / 20), 1e-4);
  EXPECT_EQ(json["alpha_max"], 0);
  EXPECT_GT(json["ssim"], 0.9);
  EXPECT_LT(json["ssim"], 1);
  EXPECT_GT(json["flip"], 0);
  // Brightest where they differ.
  const auto map = png("map.png");
  ASSERT_EQ(map.width, 33u);
  EXPECT_EQ(map.rgba[0], 0);
  EXPECT_GT(map.rgba[4 * (8 * 33 + 16)], 0);
  std::size_t brightest = 0;
  for (std::size_t i = 0; i < map.rgba.size(); i += 4)
    if (map.rgba[i] > map.rgba[brightest]) brightest = i;
  EXPECT_EQ(brightest, std::size_t{4 * (8 * 33 + 16)});
}

TEST_F(Diff, EqualImages) {
  const Json json = json_of({"diff", "a.png", "a.png", "--fail-above", "0", "--psnr-below", "200"});
  EXPECT_TRUE(json["psnr"].is_null());
  EXPECT_EQ(json["ssim"], 1);
  EXPECT_EQ(json["flip"], 0);
  EXPECT_NE(diff({"a.png", "a.png"}).out.find("psnr   inf dB\n"), std::string::npos);
}

TEST_F(Diff, FailsBeyondItsThresholdsAndReportsTheDifference) {
  const auto exit_code = [&](const Arguments& more) { return diff(more).exit_code; };
  EXPECT_EQ(exit_code({"a.png", "b.png", "--fail-above", "20.1"}), 0);
  const Outcome above = diff({"a.png", "b.png", "--fail-above", "19.9", "--json", "d.json"});
  EXPECT_EQ(above.exit_code, 7);
  EXPECT_EQ(above.error, "brume: a.png and b.png differ by 20 of 255, more than --fail-above 19.9\n");
  EXPECT_EQ(folder_.files(), (Arguments{"a.png", "b.png", "clear.png", "d.json", "small.png"}));
  EXPECT_EQ(exit_code({"a.png", "b.png", "--psnr-below", "54"}), 0);
  EXPECT_EQ(exit_code({"a.png", "b.png", "--psnr-below", "55"}), 7);
  EXPECT_EQ(exit_code({"a.png", "clear.png", "--fail-above", "99"}), 7);  // alpha counts
}

TEST_F(Diff, RejectsIncomparableImages) {
  const auto refuses = [&](const Arguments& more, int exit_code, const std::string& part) {
    expect_failure(folder_, joined({"diff"}, more), exit_code, {part});
  };
  refuses({"a.png", "small.png"}, 7, "small.png: expected 33x17 texels as in a.png, found 16x17");
  refuses({"a.png", "missing.png"}, 3, "missing.png");
  refuses({"a.png"}, 2, "TEST");
  refuses({"a.png", "b.png", "-o", "map.jpg"}, 2, "-o map.jpg: unknown file suffix; expected .png");
  refuses({"a.png", "b.png", "--fail-above", "256"}, 2, "--fail-above");
  refuses({"a.png", "b.png", "--psnr-below", "nan"}, 2, "--psnr-below");
  refuses({"a.png", "b.png", "-o", "no/such/folder/map.png"}, 2, "no/such/folder");
}

}  // namespace
}  // namespace brume::cli
