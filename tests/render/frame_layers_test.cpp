// The numbers behind a frame: bit for bit the device's, and what they mean.
#include "film/frame_layers.hpp"
#include "film/layer_mean.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "core/file.hpp"
#include "film/playback.hpp"
#include "image/exr.hpp"
#include "scene/color.hpp"
#include "shared/opaque.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/image/image_test_tools.hpp"
#include "tests/passes/half.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {
namespace {

using Halves = std::vector<std::uint16_t>;
using Floats = std::vector<float>;

/// Layers that went through a file.
class Layers {
 public:
  explicit Layers(const image::LayeredImage& image) {
    const cli::WorkFolder folder;
    image::save_exr(folder.path() / "a.exr", image).value_or_throw();
    image_ = image::decode_exr(*read_file(folder.path() / "a.exr"), "a.exr").value_or_throw();
  }
  const Halves& halves(const std::string& name) const { return std::get<Halves>(values(name)); }
  const Floats& floats(const std::string& name) const { return std::get<Floats>(values(name)); }
  bool has(const std::string& name) const {
    return std::ranges::find(image_.layers, name, &image::Layer::name) != image_.layers.end();
  }
  float half(const std::string& name, std::size_t i) const { return glm::unpackHalf1x16(halves(name)[i]); }
  glm::uvec2 size() const { return {image_.width, image_.height}; }

 private:
  const std::variant<Halves, Floats>& values(const std::string& name) const {
    for (const image::Layer& layer : image_.layers)
      if (layer.name == name) return layer.values;
    throw Error(ErrorCode::bad_input, "no layer " + name);
  }
  image::LayeredImage image_;
};

/// A cube of 4 m around the origin with an extinction of 0.8 per metre, a grey floor, a sky of one colour.
class FrameLayersTest : public gpu::GpuTest {
 protected:
  static constexpr glm::uvec2 kSize{33, 17};
  static constexpr float kExtinction = 0.8f, kFloor = -4;

  /// One for all tests: compiling its pipelines takes longer than most of them.
  static Renderer& renderer() {
    RendererOptions options{kSize};
    options.smoke.record_entries = true;
    static Renderer instance(context(), runner(), grey_floor(), options);
    return instance;
  }
  static scene::Scene grey_floor() {
    scene::Scene scene = scene_of({{{-40, kFloor - 1, -40}, {40, kFloor, 40}}}, {}, 0);
    scene.materials[0].base_color = glm::vec3(0.5f, 0.25f, 0.125f);
    return scene;
  }

  FrameLayersTest() {
    volume_.begin_update();
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(2)}, [&](glm::ivec3 brick) {
      const std::uint32_t slot = volume_.acquire(brick);
      for (std::uint16_t& texel : volume_.texels<std::uint16_t>(volume::ChannelId{0}, slot))
        texel = glm::packHalf1x16(1);
    });
    volume_.set_bounds(glm::vec3(0), glm::vec3(16));
    volume_.end_update();
    input_.volumes = {
        {&volume_,
         glm::translate(glm::mat4(1), glm::vec3(-2)) * glm::scale(glm::mat4(1), glm::vec3(0.25f)),
         {},
         {}}};
    input_.volumes[0].look = {glm::vec3(0), kExtinction, glm::vec3(0.3f, 0.2f, 0.1f), 0, 0};
    input_.view.camera = {{0, 1, 9}, {0, 0, 0}, 1.2f};
    input_.environment.sky = {glm::vec3(0.25f, 0.5f, 2), 0, glm::vec3(0.25f, 0.5f, 2), 0, glm::vec3(0.1f)};
    input_.smoke.look.swirl_width = 1;
    input_.smoke.look.noise_frequency = 1;
    renderer().set_march_scale(1);
    renderer().resize(kSize);
  }

  Layers draw() {
    film::FrameLayers layers(context(), renderer().targets().size_px);
    renderer().draw(input_, [&](gpu::Recorder& recorder) { layers.record(recorder, renderer()); });
    film::LayerMean mean;
    mean.add(layers.image());
    return Layers(mean.mean());
  }
  /// Direction of a pixel's ray; its part along the view axis is 1.
  glm::dvec3 ray(std::size_t i, glm::uvec2 size) const {
    const shared::Camera camera = planning::FramePlan(input_, size).camera;
    const glm::dvec2 ndc = (glm::dvec2(i % size.x, i / size.x) + 0.5) / glm::dvec2(size) * 2.0 - 1.0;
    return glm::dvec3(camera.forward) + ndc.x * glm::dvec3(camera.right) - ndc.y * glm::dvec3(camera.up);
  }
  /// Where a pixel's ray is inside the cube [m]; empty where x >= y.
  glm::dvec2 inside_cube(std::size_t i) const {
    const glm::dvec3 direction = glm::normalize(ray(i, kSize)), eye(input_.view.camera.position_world);
    glm::dvec2 inside(0, 1e30);
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (-2 - eye[axis]) / direction[axis], b = (2 - eye[axis]) / direction[axis];
      inside = {std::max(inside.x, std::min(a, b)), std::min(inside.y, std::max(a, b))};
    }
    return inside;
  }

  volume::SparseVolume volume_{{{}, 1, {{sizeof(std::uint16_t)}}}};
  FrameInput input_;
};

TEST_F(FrameLayersTest, AreTheBitsOfTheDeviceAtEverySize) {
  for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(7, 3), kSize}) {
    renderer().resize(size);
    const Layers layers = draw();
    EXPECT_EQ(layers.size(), size);
    const auto radiance = read_back<passes::Half4>(renderer().targets().radiance);
    const auto media = read_back<passes::Half4>(renderer().media());
    // Before the sky they are those of the media, and the rest is behind them.
    ASSERT_EQ(layers.halves("R").size(), std::size_t{size.x} * size.y);
    for (std::size_t i = 0; i < radiance.size(); ++i) {
      const passes::Half4 drawn{layers.halves("R")[i], layers.halves("G")[i], layers.halves("B")[i],
                                radiance[i][3]};
      const bool is_sky = std::isinf(layers.floats("Z")[i]);
      passes::Half4 expected = is_sky ? media[i] : radiance[i];
      expected[3] = radiance[i][3];
      EXPECT_EQ(drawn, expected) << i;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::string color = std::string("background.") + "RGB"[c];
        const float all = passes::from_half(radiance[i])[static_cast<int>(c)];
        const float sum = passes::from_half(drawn)[static_cast<int>(c)] + layers.half(color, i);
        // A half rounds by 2^-11 of it.
        EXPECT_NEAR(sum, all, std::ldexp(all, -11)) << i;
        EXPECT_EQ(is_sky || layers.half(color, i) == 0, true) << i;
      }
      const passes::Half4 marched{layers.halves("media.R")[i], layers.halves("media.G")[i],
                                  layers.halves("media.B")[i], layers.halves("transmittance.V")[i]};
      EXPECT_EQ(marched, media[i]) << i;
    }
  }
}

TEST_F(FrameLayersTest, AConstantSkyIsItsRadiance) {
  input_.volumes.clear();
  input_.view.camera = {{0, 1, 9}, {0, 60, 0}, 0.5f};
  const Layers layers = draw();
  for (std::size_t i = 0; i < layers.halves("R").size(); ++i) {
    EXPECT_EQ(glm::vec4(layers.half("R", i), layers.half("G", i), layers.half("B", i), layers.half("A", i)),
              glm::vec4(0));
    EXPECT_EQ(glm::vec3(layers.half("background.R", i), layers.half("background.G", i),
                        layers.half("background.B", i)),
              glm::vec3(0.25f, 0.5f, 2));
    EXPECT_EQ(layers.half("transmittance.V", i), 1);
    EXPECT_EQ(layers.half("albedo.R", i), 0);
    EXPECT_EQ(layers.floats("Z")[i], std::numeric_limits<float>::infinity());
    EXPECT_EQ(layers.floats("depth_in.V")[i], std::numeric_limits<float>::infinity());
  }
}

TEST_F(FrameLayersTest, SurfacesHaveDistanceAlbedoAndFullAlpha) {
  const Layers layers = draw();
  int floor = 0, sky = 0;
  for (std::size_t i = 0; i < layers.floats("Z").size(); ++i) {
    const glm::dvec3 along = ray(i, kSize), eye(input_.view.camera.position_world);
    const double z = (kFloor - eye.y) / along.y;
    if (along.y < 0 && std::abs(eye.z + z * along.z) < 39 && std::abs(z * along.x) < 39) {
      ++floor;
      EXPECT_NEAR(double{layers.floats("Z")[i]}, z, 1e-4 * z) << i;
      EXPECT_EQ(layers.half("A", i), 1) << i;
      // The G-buffer holds 8 bits in sRGB.
      EXPECT_NEAR(layers.half("albedo.R", i), 0.5f, 0.005f) << i;
      EXPECT_NEAR(layers.half("albedo.B", i), 0.125f, 0.003f) << i;
    } else if (along.y > 0) {
      ++sky;
      EXPECT_EQ(layers.floats("Z")[i], std::numeric_limits<float>::infinity());
      EXPECT_EQ(layers.halves("A")[i], glm::packHalf1x16(1 - layers.half("transmittance.V", i))) << i;
    }
  }
  EXPECT_GT(floor, 50);
  EXPECT_GT(sky, 50);
}

TEST_F(FrameLayersTest, DecalsHaveTheirOcclusionAsALayer) {
  EXPECT_FALSE(draw().has("occlusion.V"));
  grids::DenseGrid grid;
  grid.size = glm::uvec3(1);
  grid.box = {glm::dvec3(-5), glm::dvec3(5)};
  grid.values = {0.5f};
  input_.slices =
      std::make_shared<const grids::DenseVolumes>(1, std::make_shared<const grids::DenseVolume>(2, grid));
  input_.decals.resize(1);
  const Layers layers = draw();
  const auto occlusion = read_back<passes::Half4>(*renderer().occlusion());
  int darkened = 0;
  for (std::size_t i = 0; i < occlusion.size(); ++i) {
    EXPECT_EQ(layers.halves("occlusion.V")[i], occlusion[i][0]) << i;
    darkened += layers.half("occlusion.V", i) == 0.5f;
  }
  EXPECT_GT(darkened, 20);
  // Behind the camera: a film keeps its layers.
  input_.decals[0].world_from_box = glm::translate(glm::mat4(1), glm::vec3(0, 0, 50));
  const Layers away = draw();
  EXPECT_EQ(renderer().occlusion(), nullptr);
  EXPECT_EQ(away.halves("occlusion.V"), Halves(occlusion.size(), 0));
}

TEST_F(FrameLayersTest, TheMediaBeginWhereTheTransmittanceFalls) {
  const Layers layers = draw();
  const double step = 0.25;  // a voxel: no step is longer
  const double behind = -std::log(double{shared::kEntryTransmittance}) / double{kExtinction};
  int entered = 0;
  for (std::size_t i = 0; i < layers.floats("depth_in.V").size(); ++i) {
    const glm::dvec2 inside = inside_cube(i);
    const double entry{layers.floats("depth_in.V")[i]};
    // Half floats round the transmittance.
    const float transmittance = layers.half("transmittance.V", i);
    if (std::abs(transmittance - shared::kEntryTransmittance) > 1e-3f) {
      EXPECT_EQ(std::isfinite(entry), transmittance < shared::kEntryTransmittance) << i;
    }
    if (inside.y - inside.x < 2 * step) continue;
    ++entered;
    EXPECT_NEAR(entry, inside.x + behind, step) << i;
  }
  EXPECT_GT(entered, 30);
}

TEST_F(FrameLayersTest, TheMediaBeginWithTheRayOfATile) {
  const Layers full = draw();
  for (const std::uint32_t scale : {2u, 4u}) {
    renderer().set_march_scale(scale);
    const Layers reduced = draw();
    int entered = 0;
    for (std::size_t i = 0; i < full.floats("depth_in.V").size(); ++i) {
      const glm::uvec2 px(i % kSize.x, i / kSize.x);
      // Tiles well inside of the cube's outline.
      if (px.x < 13 || px.x > 19 || px.y < 7 || px.y > 9) continue;
      ++entered;
      EXPECT_NEAR(full.floats("depth_in.V")[i], reduced.floats("depth_in.V")[i], 0.6f)
          << scale << " at " << i;
    }
    EXPECT_EQ(entered, 21);
  }
}

/// Khronos PBR Neutral, as shaders/lib/tone.glsl.
glm::dvec3 neutral_tone(glm::dvec3 colour) {
  const double x = std::min({colour.r, colour.g, colour.b});
  colour -= x < 0.08 ? x - 6.25 * x * x : 0.04;
  const double start = 0.76, peak = std::max({colour.r, colour.g, colour.b});
  if (peak < start) return colour;
  const double new_peak = 1 - (1 - start) * (1 - start) / (peak + 1 - 2 * start);
  const double bleach = 1 - 1 / (0.15 * (peak - new_peak) + 1);
  return glm::mix(colour * (new_peak / peak), glm::dvec3(new_peak), bleach);
}

double srgb_of(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

/// Smoke in front of a wall in sunlight, under the sky.
scenario::Scenario small_scenario() {
  scene::Scene scene = scene_of({{{-4, -0.4f, -3}, {4, -0.1f, 3}}, {{-3, -0.1f, -2.2f}, {1, 2, -2}}},
                                {scene_sun({0.4f, -1, -0.5f}, 2)}, 0);
  scene.camera = {{0, 1.4f, 4.5f}, {0, 1, 0}, 0.9f};
  scene::Timeline timeline;
  timeline.exposure = 0.5f;
  timeline.smoke.voxels = 600;
  timeline.smokes = {{0, {0, 0.3f, 0}, {0, 0.3f, 0}}};
  return scenario_of(std::move(scene), std::move(timeline), {{36, 16, 28}, 0.25f, {-4.5f, -0.6f, -3.5f}});
}

TEST_F(FrameLayersTest, ExposureAndToneCurveGiveTheShownImage) {
  const scenario::Scenario scenario = small_scenario();
  for (const std::uint32_t scale : {1u, 4u}) {
    RendererOptions options{{33, 17}};
    options.smoke.march_scale = scale;
    film::Playback usual(context(), scenario, options);
    options.smoke.record_entries = true;
    film::Playback playback(context(), scenario, options);
    const image::Image8 shown = usual.draw(1.5, 0);
    EXPECT_EQ(playback.draw(1.5, 0).rgba, shown.rgba) << "recording entries changes nothing";
    const Layers layers(playback.draw_layers(1.5, 0));
    int smoke = 0, thin = 0;
    for (std::size_t i = 0; i < layers.halves("R").size(); ++i) {
      const auto of = [&](const std::string& color) {
        return double{layers.half(color, i)} + double{layers.half("background." + color, i)};
      };
      const glm::dvec3 radiance(of("R"), of("G"), of("B"));
      const glm::dvec3 toned = neutral_tone(radiance * std::exp2(0.5));
      // Half a step for the noise against bands, half for rounding. Behind smoke that the picture takes for
      // opaque (shared/opaque.h), and beside it between the rays of tiles, the numbers have more light.
      const bool cut = layers.half("transmittance.V", i) < 4 * 0.004f;
      for (int c = 0; c < 3; ++c) {
        const double least = cut ? toned[c] - 0.004 * double{shared::kBrightDisplayed} : toned[c];
        const double value = shown.rgba[4 * i + static_cast<std::size_t>(c)];
        EXPECT_GE(value, 255 * srgb_of(least) - 1.001) << i;
        EXPECT_LE(value, 255 * srgb_of(toned[c]) + 1.001) << i;
      }
      smoke += layers.half("transmittance.V", i) < 0.5f;
      thin += layers.half("transmittance.V", i) > 0 && layers.half("transmittance.V", i) < 0.004f;
    }
    EXPECT_GT(smoke, 40) << scale;
    EXPECT_GT(thin, 5) << "light that the picture cuts";
  }
}

}  // namespace
}  // namespace brume::render
