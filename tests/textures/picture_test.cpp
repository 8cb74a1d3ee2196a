// What a renderer that has the textures and the exported shader alone draws, beside pictures of `brume
// render`: the same scenes with the same lights, over the same surfaces. With BRUME_PICTURES, a folder, each
// case writes both and their difference, four times as strong.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/textures/compare_pictures.hpp"
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

class PictureTest : public testing::TestWithParam<Scene> {
 protected:
  std::string timeline() const { return std::string(BRUME_SOURCE_DIR "/scenes/") + GetParam().timeline; }
  Layers rendered() const {
    return Layers::rendered(timeline(), GetParam().seconds, kWidth, kHeight, folder_.path());
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

TEST_P(PictureTest, IsThatOfBrumeRender) {
  const auto& [name, seconds, near] = GetParam();
  const Layers layers = rendered();
  auto loaded = scenario::load_scenario(timeline(), {});
  ASSERT_TRUE(loaded) << loaded.failure().message;
  Stage stage(std::move(*loaded));
  GlEngine engine;
  stage.show(engine, seconds);
  const Picture smoke = drawn(stage, engine, layers, seconds);

  Comparison comparison(stage.exposure(), kWidth, kHeight);
  for (std::size_t i = 0; i < kPixels; ++i) comparison.add(layers, i, smoke.texels[i]);
  RecordProperty("mean", std::to_string(comparison.mean()));
  std::printf("%s: %.2f of 255, pixels with smoke (%.0f %%) %.2f, transmittance %.4f\n", name,
              comparison.mean(), 100 * comparison.smoky_part(), comparison.smoky_mean(),
              comparison.passed_apart());
  EXPECT_GT(comparison.smoky_part(), 0.1);
  EXPECT_LT(comparison.mean(), 2);
  if (near == Near::where_smoke_is) {
    EXPECT_LT(comparison.smoky_mean(), 2);
  }
  EXPECT_LT(comparison.passed_apart(), 2.0 / 255);
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
