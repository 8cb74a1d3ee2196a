// Light that is scattered or reflected once, against the brute force that the shaders are compared with.
#include "tests/reference/truth.hpp"
#include "planning/device_camera.hpp"
#include "planning/device_lights.hpp"
#include "planning/noise_displacement.hpp"
#include "planning/scenario_frame.hpp"
#include "reference/path_tracer.hpp"
#include "smoke/noise_tile.hpp"
#include "tests/path_tracer/statistics.hpp"
#include "tests/render/truth_scenes.hpp"

namespace brume::reference {
namespace {

constexpr glm::uvec2 kSize{24, 16};
constexpr std::uint32_t kSamples = 4096;

/// The displacement by slots as the texels of an atlas.
NoiseAdvectionField in_atlas(const planning::SmokeInput& smoke) {
  const std::vector<glm::vec3> slots = planning::noise_displacement(*smoke.volume, *smoke.state, smoke.look,
                                                                    double{smoke.time}, smoke.swirl_period);
  const shared::BrickLayout& bricks = smoke.volume->layout().bricks;
  NoiseAdvectionField field{bricks.atlas_bricks * shared::kBrickTexels, {}};
  field.texels.resize(static_cast<std::size_t>(field.size.x) * static_cast<std::size_t>(field.size.y) *
                      static_cast<std::size_t>(field.size.z));
  for (std::uint32_t i = 0; i < slots.size(); ++i) {
    const std::uint32_t local = i % shared::kTexelsPerBrick;
    const glm::ivec3 at = glm::ivec3(shared::atlas_first_texel(bricks, i / shared::kTexelsPerBrick)) +
                          glm::ivec3(local % 10, local / 10 % 10, local / 100);
    field.texels[static_cast<std::size_t>(at.x + field.size.x * (at.y + field.size.y * at.z))] = slots[i];
  }
  return field;
}

/// Irradiances of the brute force fall to 0 at a light's range; far away, its window is 1.
std::vector<shared::Light> without_range(std::vector<shared::Light> lights) {
  for (shared::Light& light : lights) light.range = 1e5f;
  return lights;
}

/// Each pixel, and all together, which are far better known.
void compare(const Scene& scene, const shared::Camera& camera, const std::vector<TruthPixel>& pixels,
             const std::string& name) {
  // Where so little of the rays is scattered that perhaps none is, the error says nothing: those pixels are
  // half a percent of the mean at most.
  double sum = 0, expected_sum = 0, variance = 0, brightness = 0;
  for (const TruthPixel& pixel : pixels)
    brightness += pixel.radiance().g / static_cast<double>(pixels.size());
  int outliers = 0;
  for (std::uint32_t i = 0; i < pixels.size(); ++i) {
    const glm::uvec2 px(i % kSize.x, i / kSize.x);
    const glm::vec2 at = (glm::vec2(px) + 0.5f) / glm::vec2(kSize) * 2.0f - 1.0f;
    const Ray ray{camera.eye_world, glm::normalize(camera.forward + at.x * camera.right - at.y * camera.up)};
    Mean mean;
    for (std::uint32_t s = 0; s < kSamples; ++s) {
      Sampler sampler(px, s);
      const PathSample found = trace_path(scene, ray, {.max_bounces = 1}, sampler);
      mean.add(double{found.seen.g} + double{found.single.g});
    }
    const double expected = pixels[i].radiance().g;
    // The brute force is off by its steps: a thousandth; and where edges of walls cut them.
    outliers += std::abs(mean.value() - expected) > 4.5 * mean.error() + 0.01 * expected + 0.005 * brightness;
    sum += mean.value();
    expected_sum += expected;
    variance += mean.error() * mean.error();
  }
  std::printf("%-20s mean %.5f, expected %.5f, error %.5f; %d pixels off\n", name.c_str(), sum, expected_sum,
              std::sqrt(variance), outliers);
  EXPECT_NEAR(sum, expected_sum, 4 * std::sqrt(variance) + 0.004 * expected_sum);
  EXPECT_LE(outliers, static_cast<int>(pixels.size() / 100));
}

TEST(TruthTest, SingleScatteringIsThatOfTheBruteForce) {
  for (const render::TruthCase& one : render::truth_cases()) {
    SCOPED_TRACE(one.name);
    auto simulation = scenario::Simulation::create(one.scenario).value_or_throw();
    simulation->advance_to(one.seconds);
    std::vector<shared::Hole> holes;
    planning::FrameInput frame = planning::frame_input(one.scenario, *simulation, one.seconds, holes);
    if (!one.noisy) frame.smoke.look.hole_rim = 0;
    const auto scene = make_scene(one.scenario.scene, frame, &one.scenario.masks);

    TruthScene truth;
    truth.camera = planning::device_camera(frame.view.camera, kSize);
    truth.size_px = kSize;
    truth.look = frame.smoke.look;
    truth.time = one.seconds;
    truth.volume = frame.smoke.volume;
    truth.holes = holes;
    const auto lights = without_range(planning::device_lights(one.scenario.scene.lights, 64));
    truth.lights = lights;
    const auto triangles = truth_triangles(one.scenario.scene);
    truth.triangles = triangles;
    truth.view_step = 0.1;
    truth.light_step = 0.2;
    const smoke::NoiseTile tile = smoke::make_noise_tile(smoke::kSmokeNoise);
    const NoiseTile noise{tile.size, tile.texels};
    const NoiseAdvectionField displacement = in_atlas(frame.smoke);
    if (one.noisy) {
      truth.noise = &noise;
      truth.displacement = &displacement;
    }
    const auto pixels = trace_truth(truth);

    compare(*scene, truth.camera, pixels, one.name);
  }
}

}  // namespace
}  // namespace brume::reference
