// What a renderer that has the textures and the exported shader alone draws, beside pictures of `brume
// render`: the same scenes with the same lights, over the same surfaces. With BRUME_PICTURES, a folder, each
// case writes both and their difference, four times as strong.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <glm/gtc/packing.hpp>
#include <map>

#include "core/file.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"
#include "shared/tone.h"
#include "tests/textures/stage.hpp"
#include "tests/work_folder.hpp"

namespace brume::textures {
namespace {

constexpr int kWidth = 320, kHeight = 180;
constexpr std::size_t kPixels = kWidth * kHeight;

/// Where colours are within 2/255 on average.
enum class Near { where_smoke_is, picture };
/// A scene at a time, drawn by both.
struct Scene {
  const char* timeline;
  double seconds;
  Near near;
};
void PrintTo(const Scene& scene, std::ostream* out) {
  *out << scene.timeline << " at " << scene.seconds << " s";
}

/// The layers of an image as floats, by name.
class Layers {
 public:
  explicit Layers(const image::LayeredImage& image) {
    for (const image::Layer& layer : image.layers) {
      std::vector<float>& to = values_[layer.name];
      if (const auto* const floats = std::get_if<std::vector<float>>(&layer.values)) to = *floats;
      if (const auto* const halves = std::get_if<std::vector<std::uint16_t>>(&layer.values))
        for (const std::uint16_t half : *halves) to.push_back(glm::unpackHalf1x16(half));
    }
  }
  float at(const std::string& name, std::size_t i) const { return values_.at(name)[i]; }
  glm::vec3 color(const std::string& start, std::size_t i) const {
    return {at(start + "R", i), at(start + "G", i), at(start + "B", i)};
  }

 private:
  std::map<std::string, std::vector<float>> values_;
};

class PictureTest : public testing::TestWithParam<Scene> {
 protected:
  std::string timeline() const { return std::string(BRUME_SOURCE_DIR "/scenes/") + GetParam().timeline; }
  Layers rendered() const {
    const std::string exr = (folder_.path() / "rendered.exr").string();
    const std::string command = std::string(BRUME_PROGRAM) + " render -q " + timeline() + " -o " + exr +
                                " --size 320x180 --time " + std::to_string(GetParam().seconds);
    EXPECT_EQ(std::system(command.c_str()), 0);
    const auto bytes = read_file(exr);
    if (!bytes) throw std::runtime_error(bytes.failure().message);
    const auto image = image::decode_exr(*bytes, exr);
    if (!image) throw std::runtime_error(image.failure().message);
    return Layers(*image);
  }
  /// The smoke in front of the rendered surfaces.
  static Picture drawn(const Stage& stage, GlEngine& engine, const Layers& rendered, double seconds) {
    const Eye eye = stage.eye(seconds);
    const Picture size{kWidth, kHeight, {}};
    FloatMap distances{"distances", kWidth, kHeight, 1, {}};
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        distances.values.push_back(rendered.at("Z", distances.values.size()) /
                                   glm::dot(eye.direction(size, x, y), eye.forward));
    const GLuint program = engine.program(
        kShadowLookup + kLights,
        "ivec3 pixel = ivec3(gl_FragCoord.x, view[4].y - gl_FragCoord.y, 0);\n"
        "float jitter = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));\n"
        "color = brume_march(origin, direction, texelFetch(distances, pixel, 0).r, jitter, pixel_width);\n");
    return engine.draw(program, eye, kWidth, kHeight, stage.uniforms(), {distances, stage.shadows()});
  }
  const cli::WorkFolder folder_;
};

/// The sums of differences of displayed colours, and the pictures.
class Comparison {
 public:
  explicit Comparison(float exposure) : exposure_(exposure) {}
  void add(glm::vec3 expected, glm::vec3 found, bool smoky) {
    const glm::vec3 a = display(expected), b = display(found), apart = glm::abs(a - b);
    const double mean = double{apart.x + apart.y + apart.z} / 3;
    all_ += mean;
    if (smoky) smoky_ += mean, ++smoky_count_;
    for (const glm::vec3 color : {a, b, 127.5f + 4.0f * (b - a)}) pictures_[number_++ % 3].push_back(color);
  }
  double mean() const { return all_ / kPixels; }
  double smoky_mean() const { return smoky_ / std::max(smoky_count_, 1.0); }
  double smoky_part() const { return smoky_count_ / kPixels; }
  void save(const std::string& path) const {
    image::Image8 image{3 * kWidth, kHeight, {}};
    for (std::size_t y = 0; y < kHeight; ++y)
      for (const std::vector<glm::vec3>& picture : pictures_)
        for (std::size_t x = 0; x < kWidth; ++x) {
          const glm::vec3 color = glm::clamp(picture[x + kWidth * y] + 0.5f, 0.0f, 255.0f);
          for (int c = 0; c < 3; ++c) image.rgba.push_back(static_cast<std::uint8_t>(color[c]));
          image.rgba.push_back(255);
        }
    const auto saved = image::save_png(path, image);
    EXPECT_TRUE(saved);
  }

 private:
  glm::vec3 display(glm::vec3 radiance) const {
    return 255.0f * shared::srgb_from_linear(shared::neutral_tone(exposure_ * radiance));
  }

  float exposure_;
  double all_ = 0, smoky_ = 0, smoky_count_ = 0;
  std::size_t number_ = 0;
  std::array<std::vector<glm::vec3>, 3> pictures_;
};

TEST_P(PictureTest, IsThatOfBrumeRender) {
  const auto& [name, seconds, near] = GetParam();
  const Layers layers = rendered();
  auto loaded = scenario::load_scenario(timeline(), {});
  ASSERT_TRUE(loaded) << loaded.failure().message;
  Stage stage(std::move(*loaded));
  GlEngine engine;
  stage.show(engine, seconds);
  const Picture smoke = drawn(stage, engine, layers, seconds);

  Comparison comparison(stage.exposure());
  double passed_apart = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    const float passed = layers.at("transmittance.V", i);
    const glm::vec3 media = layers.color("media.", i);
    const glm::vec3 whole = layers.color("", i) + layers.color("background.", i);
    const glm::vec3 surface = passed > 1e-3f ? (whole - media) / passed : glm::vec3(0);
    comparison.add(whole, glm::vec3(smoke.texels[i]) + smoke.texels[i].w * surface, passed < 0.99f);
    passed_apart += std::abs(double{passed - smoke.texels[i].w}) / kPixels;
  }
  RecordProperty("mean", std::to_string(comparison.mean()));
  std::printf("%s: %.2f of 255, pixels with smoke (%.0f %%) %.2f, transmittance %.4f\n", name,
              comparison.mean(), 100 * comparison.smoky_part(), comparison.smoky_mean(), passed_apart);
  EXPECT_GT(comparison.smoky_part(), 0.1);
  EXPECT_LT(comparison.mean(), 2);
  if (near == Near::where_smoke_is) {
    EXPECT_LT(comparison.smoky_mean(), 2);
  }
  EXPECT_LT(passed_apart, 2.0 / 255);
  if (const char* const folder = std::getenv("BRUME_PICTURES")) {
    std::string file = name;
    std::replace(file.begin(), file.end(), '/', '_');
    comparison.save(std::string(folder) + "/" + file + ".png");
  }
}

// The finest shadows of noise are missing, which show outdoors (docs/start/your-engine.md has figures).
constexpr auto kWhereSmokeIs = Near::where_smoke_is, kPicture = Near::picture;
INSTANTIATE_TEST_SUITE_P(Rooms, PictureTest,
                         testing::Values(Scene{"fidelity/one_light.toml", 2, kWhereSmokeIs},
                                         Scene{"fidelity/wall_edge.toml", 2, kWhereSmokeIs},
                                         Scene{"fidelity/five_lights.toml", 2, kWhereSmokeIs},
                                         Scene{"walls/flat.toml", 2, kWhereSmokeIs},
                                         Scene{"fidelity/shot.toml", 2, kPicture}));
INSTANTIATE_TEST_SUITE_P(Yards, PictureTest,
                         testing::Values(Scene{"fidelity/word.toml", 3.7, kPicture},
                                         Scene{"fidelity/blast.toml", 2.5, kPicture},
                                         Scene{"demo.toml", 3.7, kPicture}));

}  // namespace
}  // namespace brume::textures
