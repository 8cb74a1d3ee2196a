// The smoke of the demo in Godot beside that of `brume render`: the same room, camera and lights, over the
// surfaces of the render. With BRUME_PICTURES, a folder, writes both and their difference, four times as
// strong.
#include <algorithm>

#include "tests/godot/add_on.hpp"
#include "tests/textures/compare_pictures.hpp"

namespace brume {
namespace {

constexpr int kWidth = 640, kHeight = 360;

float linear(std::uint8_t displayed) {
  const float c = static_cast<float>(displayed) / 255.0f;
  return c < 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

class GodotPicture : public GodotAddOn {
 protected:
  void SetUp() override {
    GodotAddOn::SetUp();
    if (!IsSkipped() && !draws())
      GTEST_SKIP() << "godot3 or xvfb is not installed; script/bootstrap test installs them";
  }
  /// Draws the smoke in Godot, and compares.
  textures::Comparison compared(const std::string& name, const std::string& environment) const {
    namespace fs = std::filesystem;
    const fs::path scene = folder_.path() / name;
    fs::create_directory(scene);
    fs::copy(BRUME_SOURCE_DIR "/scenes/fidelity/Meshes", scene / "Meshes");
    const std::string size = std::to_string(kWidth) + "x" + std::to_string(kHeight);
    const api::ShellRun drawn =
        run_drawing("smoke_alone.gd", "FOLDER='" + scene.string() + "' SIZE=" + size + " " + environment);
    EXPECT_EQ(drawn.output.find("SCRIPT ERROR"), drawn.output.npos) << drawn.output;
    EXPECT_EQ(drawn.output.find("smoke_alone.gd:"), drawn.output.npos) << drawn.output;
    const auto light = read_file(scene / "light.rgb").value_or_throw();
    const auto opaque = read_file(scene / "opaque.rgb").value_or_throw();
    if (light.size() != 3 * kPixels || opaque.size() != light.size())
      throw std::runtime_error("pictures of another size\n" + drawn.output);

    const auto layers =
        textures::Layers::rendered((scene / "timeline.toml").string(), 3, kWidth, kHeight, scene);
    textures::Comparison comparison(1, kWidth, kHeight);
    const auto at = [](const auto& picture, std::size_t i) {
      return linear(static_cast<std::uint8_t>(picture[i]));
    };
    for (std::size_t i = 0; i < kPixels; ++i)
      comparison.add(
          layers, i,
          {at(light, 3 * i), at(light, 3 * i + 1), at(light, 3 * i + 2), 1 - at(opaque, 3 * i + 1)});
    std::printf("%s: %.2f of 255, pixels with smoke (%.0f %%) %.2f, transmittance %.4f, opposite %.5f\n",
                name.c_str(), comparison.mean(), 100 * comparison.smoky_part(), comparison.smoky_mean(),
                comparison.passed_apart(), comparison.opposite_part());
    if (const char* const pictures = std::getenv("BRUME_PICTURES"))
      comparison.save(std::string(pictures) + "/godot_" + name + ".png");
    return comparison;
  }
  static constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
};

TEST_F(GodotPicture, IsThatOfBrumeRender) {
  const textures::Comparison comparison = compared("demo", "HALF=0");
  EXPECT_GT(comparison.smoky_part(), 0.1);
  EXPECT_LT(comparison.mean(), 2);
  EXPECT_LT(comparison.passed_apart(), 2.0 / 255);
  // A quarter of a pixel along outlines of surfaces, which are some 900 pixels long.
  EXPECT_LT(comparison.opposite_part(), 1e-3);
}

}  // namespace
}  // namespace brume
