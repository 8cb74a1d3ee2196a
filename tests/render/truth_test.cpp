// The renderer's images against what they should be, pixel by pixel (tests/reference/truth.hpp).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

#include "film/playback.hpp"
#include "image/metrics.hpp"
#include "image/png.hpp"
#include "passes/noise.hpp"
#include "planning/device_camera.hpp"
#include "planning/device_lights.hpp"
#include "smoke/drawn_smoke.hpp"
#include "smoke/noise_tile.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/reference/truth.hpp"
#include "tests/render/even_light.hpp"
#include "tests/render/truth_scenes.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kSize{64, 36};

/// What the device made of a case.
struct Drawn {
  std::vector<glm::dvec4> smoke;  ///< Premultiplied radiance, transmittance.
  std::vector<glm::dvec3> image;
  reference::NoiseAdvectionField displacement;
};

class TruthTest : public gpu::GpuTest {
 protected:
  static std::vector<glm::dvec4> texels(const gpu::Image& image) {
    std::vector<glm::dvec4> out;
    for (const passes::Half4& texel : read_back<passes::Half4>(image))
      out.emplace_back(passes::from_half(texel));
    return out;
  }
  /// A scenario at a time, and a renderer for it.
  class Studio {
   public:
    explicit Studio(const scenario::Scenario& scenario, double seconds = 2)
        : simulation_(scenario::Simulation::create(scenario).value_or_throw()),
          renderer_(context(), runner(), scenario.scene,
                    {.size_px = kSize, .smoke = {.masks = &scenario.masks}}) {
      simulation_->advance_to(seconds);
      input = frame_input(scenario, *simulation_, seconds, holes);
    }
    /// What `input` shows.
    Drawn draw() {
      renderer_.draw(input);
      Drawn drawn{texels(renderer_.media()), {}, {}};
      for (const glm::dvec4& texel : texels(renderer_.targets().radiance)) drawn.image.emplace_back(texel);
      const gpu::Image& medium = renderer_.smoke().resources().density_displacement;
      drawn.displacement.size = glm::ivec3(medium.info().size);
      for (const glm::dvec4& texel : texels(medium))
        drawn.displacement.texels.emplace_back(texel.y, texel.z, texel.w);
      return drawn;
    }
    std::vector<shared::Hole> holes;
    FrameInput input;

   private:
    std::unique_ptr<scenario::Simulation> simulation_;
    Renderer renderer_;
  };
  struct Noise {
    reference::NoiseTile tile, detail;
  };
  static Noise smoke_noise() {
    const passes::NoisePass pass(context());
    const gpu::Image tile = passes::make_noise_tile(context(), smoke::kSmokeNoise.size);
    const gpu::Image detail = passes::make_detail_tile(context());
    runner().run([&](gpu::Recorder& recorder) {
      pass.record(recorder, tile, smoke::kSmokeNoise);
      pass.record_detail(recorder, tile, detail);
    });
    Noise noise{{smoke::kSmokeNoise.size, read_back<glm::u8vec4>(tile)}, {shared::kDetailTexels, {}}};
    for (const glm::u8vec2& texel : read_back<glm::u8vec2>(detail))
      noise.detail.texels.emplace_back(texel.x, texel.y, 0, 0);
    return noise;
  }
};

/// Khronos PBR Neutral (shaders/lib/tone.glsl).
glm::dvec3 tone(glm::dvec3 c) {
  const double x = std::min({c.r, c.g, c.b});
  c -= x < 0.08 ? x - 6.25 * x * x : 0.04;
  const double peak = std::max({c.r, c.g, c.b}), start = 0.76, d = 1 - start;
  if (peak < start) return c;
  const double new_peak = 1 - d * d / (peak + d - start), bleach = 1 - 1 / (0.15 * (peak - new_peak) + 1);
  return glm::mix(c * (new_peak / peak), glm::dvec3(new_peak), bleach);
}

/// Tone curve and sRGB, 8 bits, without dither.
image::Image8 shown(const std::vector<glm::dvec3>& image, double exposure) {
  image::Image8 out{kSize.x, kSize.y, {}};
  for (const glm::dvec3& radiance : image) {
    const glm::dvec3 c = glm::clamp(tone(exposure * radiance), 0.0, 1.0);
    for (int i = 0; i < 3; ++i) {
      const double v = c[i] <= 0.0031308 ? 12.92 * c[i] : 1.055 * std::pow(c[i], 1 / 2.4) - 0.055;
      out.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * v)));
    }
    out.rgba.push_back(255);
  }
  return out;
}

double psnr_of(const image::Image8& a, const image::Image8& b) {
  return image::psnr(image::difference(image::encoded_colours(a), image::encoded_colours(b)).rmse, 1);
}

/// Of radiance after exposure; 1 is white.
double psnr_of(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b, double exposure) {
  std::vector<float> x, y;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      x.push_back(static_cast<float>(std::min(exposure * a[i][c], 1.0)));
      y.push_back(static_cast<float>(std::min(exposure * b[i][c], 1.0)));
    }
  return image::psnr(image::difference(x, y).rmse, 1);
}

/// Images go there, if it is named: the truth, what was drawn, where one would notice.
void keep(const std::string& name, const image::Image8& truth, const image::Image8& drawn) {
  const char* folder = std::getenv("BRUME_TRUTH");
  if (folder == nullptr) return;
  std::string file = name;
  std::replace(file.begin(), file.end(), ' ', '_');
  const std::string base = std::string(folder) + "/" + file;
  image::save_png(base + "_truth.png", truth).value_or_throw();
  image::save_png(base + "_drawn.png", drawn).value_or_throw();
  image::save_png(base + "_flip.png", image::heat_map(image::flip(truth, drawn))).value_or_throw();
}

TEST_F(TruthTest, SingleScatteringIsWhatItShouldBe) {
  const Noise noise = smoke_noise();
  for (const TruthCase& one : truth_cases()) {
    SCOPED_TRACE(one.name);
    Studio studio(one.scenario, one.seconds);
    FrameInput& input = studio.input;
    input.smoke.look.multiple_scattering = 0;
    if (!one.noisy) input.smoke.look.hole_rim = 0;
    input.smoke.look.detail = 0;  // It is finer than the pixels of this size.
    const Drawn drawn = studio.draw();

    reference::TruthScene truth;
    truth.camera = planning::device_camera(input.view.camera, kSize);
    truth.size_px = kSize;
    truth.look = input.smoke.look;
    truth.time = one.seconds;
    truth.volume = input.smoke.volume;
    truth.holes = studio.holes;
    const auto lights = planning::device_lights(one.scenario.scene.lights, 64);
    truth.lights = lights;
    const auto triangles = reference::truth_triangles(one.scenario.scene);
    truth.triangles = triangles;
    if (one.noisy) {
      truth.noise = &noise.tile;
      truth.displacement = &drawn.displacement;
    }
    const auto pixels = reference::trace_truth(truth);

    std::vector<glm::dvec3> expected, over_truth;
    double transmittance = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      expected.push_back(pixels[i].radiance());
      // The drawn smoke over the true surface.
      over_truth.push_back(glm::dvec3(drawn.smoke[i]) + drawn.smoke[i].w * pixels[i].surface);
      transmittance += std::abs(drawn.smoke[i].w - pixels[i].transmittance) / double(pixels.size());
    }
    const double exposure = double{input.view.exposure};
    const auto truth_shown = shown(expected, exposure);
    const auto smoke_shown = shown(over_truth, exposure), image_shown = shown(drawn.image, exposure);
    const double linear = psnr_of(expected, over_truth, exposure), toned = psnr_of(truth_shown, smoke_shown);
    std::printf(
        "%-20s smoke %.1f dB linear, %.1f dB shown; whole image %.1f, %.1f; transmittance off by %.4f\n",
        one.name.c_str(), linear, toned, psnr_of(expected, drawn.image, exposure),
        psnr_of(truth_shown, image_shown), transmittance);
    keep(one.name + " smoke", truth_shown, smoke_shown);
    keep(one.name + " image", truth_shown, image_shown);
    EXPECT_GE(toned, one.least_psnr);
    // A ray with less transmittance than look.opaque_transmittance counts as opaque: its mean is off by less.
    EXPECT_LT(transmittance, double{input.smoke.look.opaque_transmittance});
  }
}

/// Through the centre of a pixel.
glm::vec3 direction_of(const shared::Camera& camera, std::size_t pixel) {
  const glm::vec2 px(static_cast<float>(pixel % kSize.x), static_cast<float>(pixel / kSize.x));
  const glm::vec2 at = (px + 0.5f) / glm::vec2(kSize) * 2.0f - 1.0f;
  return glm::normalize(camera.forward + at.x * camera.right - at.y * camera.up);
}

// Close enough that its octaves are wider than pixels, and in steps that are shorter than their cells.
TEST_F(TruthTest, DetailDimsAsItShould) {
  const Noise noise = smoke_noise();
  for (const TruthCase& one : truth_cases()) {
    if (!one.noisy) continue;
    Studio studio(one.scenario, one.seconds);
    FrameInput& input = studio.input;
    input.view.camera.vertical_fov = 0.05f;
    input.quality.step_scale = 0.1f;
    input.smoke.look.detail = 1;
    const smoke::DrawnSmoke queried(input.smoke, smoke::smoke_noise, nullptr);
    double between = 0, off = 0, off_without = 0, off_queried = 0;
    for (const float x : {-1.6f, -1.2f, 1.2f, 1.6f}) {
      input.view.camera.target_world = {x, 1.2f, 0};
      const Drawn drawn = studio.draw();
      reference::TruthScene truth;
      truth.camera = planning::device_camera(input.view.camera, kSize);
      truth.size_px = kSize;
      truth.look = input.smoke.look;
      truth.time = one.seconds;
      truth.volume = input.smoke.volume;
      truth.holes = studio.holes;
      truth.noise = &noise.tile;
      truth.detail = &noise.detail;
      truth.displacement = &drawn.displacement;
      truth.view_step = 0.04;
      const auto pixels = reference::trace_truth(truth);
      input.quality.detail = false;
      const Drawn without = studio.draw();
      input.quality.detail = true;
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        between += pixels[i].transmittance > 0.05 && pixels[i].transmittance < 0.95;
        off += std::abs(drawn.smoke[i].w - pixels[i].transmittance) / double(4 * pixels.size());
        off_without += std::abs(without.smoke[i].w - pixels[i].transmittance) / double(4 * pixels.size());
        const glm::dvec3 eye(truth.camera.eye_world), along(direction_of(truth.camera, i));
        const float depth =
            input.smoke.look.extinction * queried.integral(eye, eye + 100.0 * along, HUGE_VALF);
        off_queried += std::abs(std::exp(-depth) - pixels[i].transmittance) / double(4 * pixels.size());
      }
    }
    std::printf(
        "detail: transmittance off by %.4f, without it by %.4f, of queries by %.4f; %.0f in between\n", off,
        off_without, off_queried, between);
    EXPECT_GT(between, 500);
    // As in the other cases: what is as good as opaque, and ends a ray.
    EXPECT_LT(off, double{input.smoke.look.opaque_transmittance});
    EXPECT_GT(off_without, 4 * off);
    // Queries see the same smoke, in steps that are off by 2 mm of it in root mean square (DrawnSmokeTest).
    EXPECT_LT(off_queried, 0.002 * double{input.smoke.look.extinction} * std::exp(-1.0));
  }
}

TEST_F(TruthTest, InEvenLightSmokeWithoutAbsorptionIsNotSeen) {
  // No walls but a pebble out of view, and a sky of radiance 1 all around.
  scene::Scene scene;
  scene.meshes.resize(1);
  add_box(scene.meshes[0], {-0.1f, 0, 5.6f}, {0.1f, 0.2f, 5.8f});
  scene.materials.push_back({});
  scene.objects.push_back({"pebble", 0, 0, glm::mat4(1)});
  scene.grenade = {"grenade", 0, 0, glm::mat4(1), Role::ghost};
  scene.camera = scene::Camera{{0, 1.5f, 5.5f}, {0, 1, 0}, 0.9f};
  scene::Timeline timeline;
  timeline.sky = {glm::vec3(1), glm::vec3(1), glm::vec3(1), 0};
  timeline.smoke.voxels = 2000;
  timeline.smoke.albedo = glm::vec3(1);
  timeline.smokes = {{0.0, {0, 1.5f, 0}, {0, 1, 0}}};
  const scenario::Scenario scenario = scenario_of(scene, timeline, {{52, 24, 40}, 0.25f, {-6.5f, -2, -4.5f}});
  Studio studio(scenario);
  const voxel::BitGrid level = closed_level(scenario.voxels.grid.layout());
  light_evenly(studio.input, level, 1);
  for (const float noise : {0.0f, 0.5f}) {
    for (const float extinction : {0.1f, 1.0f, 10.0f}) {
      double darkest = 2, brightest = 0, least_left = 1;
      studio.input.smoke.look.extinction = extinction;
      studio.input.smoke.look.erosion = noise;
      const Drawn drawn = studio.draw();
      for (const glm::dvec3& radiance : drawn.image) {
        darkest = std::min(darkest, radiance.g);
        brightest = std::max(brightest, radiance.g);
      }
      for (const glm::dvec4& smoke : drawn.smoke) least_left = std::min(least_left, smoke.w);
      std::printf("furnace: noise %.1f extinction %4.1f: %.4f to %.4f, transmittance down to %.3f\n",
                  double{noise}, double{extinction}, darkest, brightest, least_left);
      EXPECT_NEAR(darkest, 1, 0.02) << noise << ' ' << extinction;
      EXPECT_NEAR(brightest, 1, 0.02) << noise << ' ' << extinction;
      EXPECT_LT(least_left, 1 - 0.5 * std::min(1.0, double{extinction})) << "there is smoke";
    }
  }
}

// What is scattered once is proportional to the albedo, the light of the sky as well.
TEST_F(TruthTest, WithoutMultipleScatteringLightIsProportionalToTheAlbedo) {
  TruthCase one = std::move(truth_cases().front());
  one.scenario.timeline.sky.ambient = glm::vec3(0.5f);
  Studio studio(one.scenario);
  studio.input.smoke.look.multiple_scattering = 0;
  std::vector<glm::dvec4> smoke[3];
  for (int i = 0; i < 3; ++i) {
    studio.input.smoke.look.albedo = glm::vec3(0.5f * static_cast<float>(i));
    smoke[i] = studio.draw().smoke;
  }
  int compared = 0;
  for (std::size_t i = 0; i < smoke[0].size(); ++i) {
    EXPECT_EQ(smoke[0][i].g, 0) << "smoke that absorbs all";
    // Halves of radiance and of light in the smoke.
    EXPECT_NEAR(smoke[2][i].g, 2 * smoke[1][i].g, 0.002 * smoke[2][i].g + 1e-6);
    compared += smoke[2][i].g > 0.05;
  }
  EXPECT_GT(compared, 200);
}

TEST_F(TruthTest, ALightBehindASlabIsDimmedAsBeerAndLambertSay) {
  // A closed room full of smoke that only absorbs; its far wall glows.
  scene::Scene scene;
  scene.meshes.resize(2);
  add_box(scene.meshes[0], {-2, -0.25f, -3}, {2, 0, 3});
  add_box(scene.meshes[0], {-2, 3, -3}, {2, 3.25f, 3});
  add_box(scene.meshes[0], {-2.25f, -0.25f, -3}, {-2, 3.25f, 3});
  add_box(scene.meshes[0], {2, -0.25f, -3}, {2.25f, 3.25f, 3});
  add_box(scene.meshes[0], {-2.25f, -0.25f, 3}, {2.25f, 3.25f, 3.25f});
  add_box(scene.meshes[1], {-2.25f, -0.25f, -3.25f}, {2.25f, 3.25f, -3});
  scene.materials.resize(2);
  scene.materials[0].base_color = scene.materials[1].base_color = glm::vec3(0);
  scene.materials[1].emission = glm::vec3(1);
  scene.objects = {{"room", 0, 0, glm::mat4(1)}, {"light", 1, 1, glm::mat4(1)}};
  scene.grenade = {"grenade", 0, 0, glm::mat4(1), Role::ghost};
  scene.camera = scene::Camera{{0.3f, 1.4f, 2}, {0.1f, 1.5f, -3}, 0.5f};
  scene::Timeline timeline;
  timeline.sky = {glm::vec3(0), glm::vec3(0), glm::vec3(0), 0};
  timeline.smoke.voxels = 20000;  // more than there is room for
  timeline.smoke.erosion = 0;
  timeline.smoke.albedo = glm::vec3(0);
  timeline.smokes = {{0.0, {0, 1.5f, 0}, {0, 1, 0}}};
  const scenario::Scenario scenario = scenario_of(scene, timeline, {{24, 20, 32}, 0.25f, {-3, -1, -4}});
  Studio studio(scenario);
  const smoke::SmokeVolume* const volume = std::exchange(studio.input.smoke.volume, nullptr);
  const auto clear = studio.draw().image;
  studio.input.smoke.volume = volume;
  const shared::Camera camera = planning::device_camera(*scene.camera, kSize);
  for (const float extinction : {0.05f, 0.3f, 0.7f}) {
    studio.input.smoke.look.extinction = extinction;
    const auto image = studio.draw().image;
    int visible = 0;
    for (std::uint32_t i = 0; i < image.size(); ++i) {
      if (clear[i].g < 0.999) continue;
      const glm::dvec2 ndc = (glm::dvec2(i % kSize.x, i / kSize.x) + 0.5) / glm::dvec2(kSize) * 2.0 - 1.0;
      const glm::dvec3 ray =
          glm::dvec3(camera.forward) + ndc.x * glm::dvec3(camera.right) - ndc.y * glm::dvec3(camera.up);
      const double expected = std::exp(-double{extinction} * glm::length(ray) * (-3.0 - 2.0) / ray.z);
      EXPECT_NEAR(image[i].g, expected, 0.01 * expected) << i % kSize.x << ' ' << i / kSize.x;
      ++visible;
    }
    EXPECT_GT(visible, 1000);
  }
}

TEST_F(TruthTest, StepsOfTheMarchDoNotShow) {
  for (const TruthCase& one : truth_cases()) {
    if (one.name != "hole" && one.name != "noise and holes") continue;
    Studio studio(one.scenario);
    const float length = studio.input.smoke.look.step_length;
    const auto at = [&](float share) {
      studio.input.smoke.look.step_length = share * length;
      return shown(studio.draw().image, 1);
    };
    const image::Image8 plain = at(1);
    for (const float share : {0.5f, 1.5f}) {
      const image::Difference d =
          image::difference(image::encoded_colours(plain), image::encoded_colours(at(share)));
      std::printf("steps: %s, %.2f times as long: mean %.3f, most %.0f of 255\n", one.name.c_str(),
                  double{share}, 255 * d.mean, 255 * d.max);
      EXPECT_LT(d.mean, 1.0 / 255);
    }
  }
}

}  // namespace
}  // namespace brume::render
