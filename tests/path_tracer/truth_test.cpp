// Light that is scattered or reflected once, against the brute force that the shaders are compared with.
#include "tests/reference/truth.hpp"
#include "planning/device_camera.hpp"
#include "planning/device_lights.hpp"
#include "reference/path_tracer.hpp"
#include "scenario/frame.hpp"
#include "smoke/noise_tile.hpp"
#include "tests/path_tracer/statistics.hpp"
#include "tests/render/truth_scenes.hpp"
#include "tests/smoke/displacements.hpp"

namespace brume::reference {
namespace {

constexpr glm::uvec2 kSize{24, 16};
constexpr std::uint32_t kSamples = 2048;

/// The displacement by slots as the texels of an atlas.
NoiseAdvectionField in_atlas(const planning::SmokeInput& smoke) {
  const std::vector<glm::vec3> slots = smoke::displacements_of(
      {*smoke.volume, *smoke.state, smoke.look, double{smoke.time}, smoke.swirl_period}, *smoke.volume);
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

Ray ray_of(const shared::Camera& camera, glm::uvec2 px) {
  const glm::vec2 at = (glm::vec2(px) + 0.5f) / glm::vec2(kSize) * 2.0f - 1.0f;
  return {camera.eye_world, glm::normalize(camera.forward + at.x * camera.right - at.y * camera.up)};
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

/// A case as the path tracer and the brute force read it.
struct Studio {
  explicit Studio(const render::TruthCase& one)
      : simulation(scenario::Simulation::create(one.scenario).value_or_throw()),
        lights(without_range(planning::device_lights(one.scenario.scene.lights, 64))),
        triangles(truth_triangles(one.scenario.scene)) {
    simulation->advance_to(one.seconds);
    frame = scenario::frame_input(one.scenario, *simulation, one.seconds, holes);
    if (!one.noisy) frame.smoke.look.hole_rim = 0;
    scene = make_scene(one.scenario.scene, frame, &one.scenario.masks);

    truth.camera = planning::device_camera(frame.view.camera, kSize);
    truth.size_px = kSize;
    truth.look = frame.smoke.look;
    truth.time = one.seconds;
    truth.volume = frame.smoke.volume;
    truth.holes = holes;
    truth.lights = lights;
    truth.triangles = triangles;
    truth.view_step = 0.1;
    truth.light_step = 0.2;
    if (!one.noisy) return;
    const smoke::NoiseTile tile = smoke::make_noise_tile(smoke::kSmokeNoise);
    noise = {tile.size, tile.texels};
    const smoke::NoiseTile fine = smoke::make_detail_tile(tile);
    detail = {fine.size, fine.texels};
    displacement = in_atlas(frame.smoke);
    truth.noise = &noise;
    truth.detail = &detail;
    truth.displacement = &displacement;
  }
  Studio(const Studio&) = delete;

  std::unique_ptr<scenario::Simulation> simulation;
  std::vector<shared::Hole> holes;
  planning::FrameInput frame;
  std::unique_ptr<Scene> scene;
  std::vector<shared::Light> lights;
  std::vector<TruthTriangle> triangles;
  NoiseTile noise, detail;
  NoiseAdvectionField displacement;
  TruthScene truth;
};

TEST(TruthTest, SingleScatteringIsThatOfTheBruteForce) {
  for (const render::TruthCase& one : render::truth_cases()) {
    SCOPED_TRACE(one.name);
    const Studio studio(one);
    compare(*studio.scene, studio.truth.camera, trace_truth(studio.truth), one.name);
  }
}

/// The smoke by code of its own in double precision, within the bounds of the medium that it replaces.
class DoubleMedium final : public Medium {
 public:
  DoubleMedium(const TruthScene& truth, const Medium& bounds) : Medium(truth.look.phase), truth_(truth) {
    majorants_ = bounds.majorants();
  }
  float extinction(const glm::vec3& p) const override {
    return static_cast<float>(double{truth_.look.extinction} * truth_density(truth_, glm::dvec3(p)));
  }
  glm::vec3 albedo(const glm::vec3&) const override { return truth_.look.albedo; }
  glm::vec3 emission(const glm::vec3&) const override { return glm::vec3(0); }

 private:
  const TruthScene& truth_;
};

// A fault in what shaders and path tracer share cannot hide: with all bounces and a sky, too, pictures of
// both media are the same.
TEST(TruthTest, FullTransportIsThatOfDensitiesInDoublePrecision) {
  const std::vector<render::TruthCase> cases = render::truth_cases();
  for (const render::TruthCase& one : cases) {
    if (!one.noisy && one.name != "two holes") continue;
    SCOPED_TRACE(one.name);
    const Studio studio(one);
    studio.scene->environment.sky.ambient = glm::vec3(0.3f);
    const auto sum = [&] {
      double mean = 0, variance = 0;
      for (std::uint32_t i = 0; i < kSize.x * kSize.y; ++i) {
        const glm::uvec2 px(i % kSize.x, i / kSize.x);
        const Ray ray = ray_of(studio.truth.camera, px);
        Mean pixel;
        for (std::uint32_t s = 0; s < 256; ++s) {
          Sampler sampler(px, s);
          const PathSample found = trace_path(*studio.scene, ray, {}, sampler);
          pixel.add(double{found.seen.g} + double{found.single.g} + double{found.multiple.g});
        }
        mean += pixel.value();
        variance += pixel.error() * pixel.error();
      }
      return std::pair(mean, variance);
    };
    const auto [shared_mean, shared_variance] = sum();
    std::vector<std::unique_ptr<Medium>> media;
    media.push_back(std::make_unique<DoubleMedium>(studio.truth, *studio.scene->media.all()[0]));
    const Media before = std::exchange(studio.scene->media, Media(std::move(media)));
    const auto [mean, variance] = sum();
    const double error = std::sqrt(variance + shared_variance);
    EXPECT_NEAR(mean, shared_mean, 4 * error);
    EXPECT_LT(error, 0.01 * mean);
  }
}

}  // namespace
}  // namespace brume::reference
