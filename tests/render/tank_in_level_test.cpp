// A tank as a volume of a level: lit by its lights, dimmed by its smoke, before and behind it, and dark
// below; against the path tracer and what spheres let through.
#include <algorithm>
#include <cmath>
#include <memory>

#include "film/playback.hpp"
#include "planning/device_camera.hpp"
#include "reference/path_tracer.hpp"
#include "spheres/file.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/path_tracer/statistics.hpp"
#include "tests/render/studio.hpp"
#include "tests/render/truth_scenes.hpp"
#include "tests/work_folder.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kSize{64, 48};
constexpr float kVoxel = 0.05f, kRadius = 11;
constexpr glm::vec3 kMiddle{0, 1, 0};
constexpr double kSeconds = 2;

const scene::Light kWarm = scene_light({-3, 2.5f, 2}, {40, 20, 5}),
                   kCold = scene_light({3, 2, 2.5f}, {4, 16, 30});

/// A ball of 32^3 voxels.
spheres::Tank ball(spheres::Color color) {
  return {glm::uvec3(32), kVoxel, {{glm::vec3(16), kRadius}}, {color}};
}
constexpr spheres::Color kOpaque = 0xff90b4e0, kHaze = 0x18000000;  // the haze passes 90.6 % a voxel

/// What stands in the level.
struct Stage {
  std::vector<scene::Light> lights = {kWarm, kCold};
  spheres::Color color = kOpaque;
  float floor = 0;  ///< Its albedo.
  float multiple_scattering = 1;
  std::optional<glm::vec3> smoke = {};
};

class TankInLevelTest : public gpu::GpuTest {
 protected:
  std::unique_ptr<Studio> studio(const Stage& stage) const {
    spheres::save_tank(folder_.path() / "ball.spheres", ball(stage.color)).value_or_throw();
    scene::Scene scene;
    add_box(scene.meshes.emplace_back(), {-6, -0.2f, -4}, {6, 0, 6});
    add_box(scene.meshes.emplace_back(), glm::vec3(-0.01f), glm::vec3(0.01f));
    scene.materials.resize(1);
    scene.materials[0].base_color = glm::vec3(stage.floor);
    scene.objects = {{"floor", 0, 0, glm::mat4(1)}};
    scene.grenade = {"grenade", 1, 0, glm::mat4(1), Role::ghost};
    scene.lights = stage.lights;
    scene.camera = scene::Camera{{0, 1.4f, 6}, kMiddle, 0.4f};
    scene::Timeline timeline;
    timeline.sky = {glm::vec3(0), glm::vec3(0), glm::vec3(0), 0};
    scene::VolumeOptions& tank = timeline.volumes.emplace_back();
    tank.file = folder_.path() / "ball.spheres";
    tank.position_world = kMiddle;
    tank.albedo = glm::vec3(1);
    tank.anisotropy = 0;
    tank.multiple_scattering = stage.multiple_scattering;
    timeline.smoke.voxels = 400;
    timeline.smoke.extinction = 1;
    timeline.smoke.erosion = 0;
    timeline.smoke.albedo = glm::vec3(0);
    if (stage.smoke) timeline.smokes = {{0.0, *stage.smoke + glm::vec3(0, 0.1f, 0), *stage.smoke}};

    scenario::Scenario scenario =
        scenario_of(std::move(scene), std::move(timeline), {{52, 20, 44}, 0.25f, {-6.5f, -0.6f, -4.6f}});
    scenario.volumes = volumes::Volumes::load(scenario.timeline.volumes).value_or_throw();
    auto made = make_studio(context(), runner(), std::move(scenario), kSeconds, kSize);
    made->renderer->set_march_scale(1);
    return made;
  }

  static std::vector<glm::dvec4> texels(const gpu::Image& image) {
    std::vector<glm::dvec4> out;
    for (const passes::Half4& texel : read_back<passes::Half4>(image))
      out.emplace_back(passes::from_half(texel));
    return out;
  }
  /// Premultiplied radiance of the media and their transmittance.
  static std::vector<glm::dvec4> media(Studio& studio) {
    studio.renderer->draw(studio.input);
    return texels(studio.renderer->media());
  }
  std::vector<glm::dvec4> media_of(const Stage& stage) const { return media(*studio(stage)); }

  /// The mean over the pixels that another picture shows as opaque.
  static glm::dvec3 mean_where_opaque(const std::vector<glm::dvec4>& pixels,
                                      const std::vector<glm::dvec4>& mask) {
    glm::dvec3 sum(0);
    int count = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
      if (mask[i].w == 0) sum += glm::dvec3(pixels[i]), ++count;
    EXPECT_GT(count, 150);
    return sum / double(count);
  }

  static reference::Ray ray_of(const shared::Camera& camera, std::uint32_t i) {
    const glm::vec2 px(i % kSize.x, i / kSize.x), at = (px + 0.5f) / glm::vec2(kSize) * 2.0f - 1.0f;
    return {camera.eye_world, glm::normalize(camera.forward + at.x * camera.right - at.y * camera.up)};
  }

  /// The same mean by the path tracer, and its standard error.
  static reference::Mean traced_mean(const Studio& studio, const std::vector<glm::dvec4>& mask,
                                     std::uint32_t bounces) {
    const auto scene = reference::make_scene(studio.scenario.scene, studio.input, nullptr);
    const shared::Camera camera = planning::device_camera(studio.input.view.camera, kSize);
    reference::Mean mean;
    constexpr std::uint32_t kSamples = 64;
    for (std::uint32_t s = 0; s < kSamples; ++s) {
      double sum = 0;
      int count = 0;
      for (std::uint32_t i = 0; i < mask.size(); ++i) {
        if (mask[i].w != 0) continue;
        reference::Sampler sampler(glm::uvec2(i % kSize.x, i / kSize.x), s);
        const reference::PathSample found =
            reference::trace_path(*scene, ray_of(camera, i), {.max_bounces = bounces}, sampler);
        sum += double{found.single.g} + double{found.multiple.g};
        ++count;
      }
      mean.add(sum / count);
    }
    return mean;
  }

  const cli::WorkFolder folder_{};
};

/// How the light that the surface of an opaque ball scatters once is rounded: cells of light at most a voxel
/// long, linear in between, and a march of half a voxel.
class Discretised {
 public:
  /// By the cosines of the eye and of the light at a flat surface whose extinction grows along a voxel.
  /// Exact is mu0 / (mu + mu0) (Lommel and Seeliger), whatever the extinction.
  static double ratio(double mu, double mu0) {
    constexpr int kPhases = 6;
    double sum = 0;
    for (int i = 0; i < kPhases; ++i)
      for (int j = 0; j < kPhases; ++j) sum += seen(mu, mu0, (i + 0.5) / kPhases, (j + 0.5) / kPhases);
    return sum / (kPhases * kPhases) / (mu0 / (mu + mu0));
  }
  /// The mean deviation from 1 over the visible half of a ball, weighted by what is seen: light from `angle`
  /// beside the eye.
  static double of_ball(double angle) {
    double off = 0, all = 0;
    constexpr int kSteps = 24;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const double x = (i + 0.5) / kSteps * 2 - 1, y = (j + 0.5) / kSteps * 2 - 1;
        if (x * x + y * y >= 1) continue;
        const double mu = std::sqrt(1 - x * x - y * y), mu0 = std::sin(angle) * x + std::cos(angle) * mu;
        if (mu0 <= 0.02) continue;
        off += mu0 / (mu + mu0) * std::abs(ratio(mu, mu0) - 1);
        all += mu0 / (mu + mu0);
      }
    return off / all;
  }

 private:
  static constexpr double kCell = 1, kStep = 0.5;
  static double extinction(double x) { return 6.93 * std::clamp(x, 0.0, 1.0); }
  /// Of the light that arrives at a depth, by the steps of the shader.
  static double arrives(double x, double mu0) {
    double depth = 0, t = 0;
    for (int i = 0; x - mu0 * t > 0 && depth < 16; ++i) {
      const double ds = i < 8 ? 0.5 : 1;
      depth += ds * extinction(x - mu0 * (t + ds / 2));
      t += ds;
    }
    return std::exp(-depth);
  }
  static double light(double x, double mu0, double phase) {
    const double cell = std::floor(x / kCell - phase), part = x / kCell - phase - cell;
    return (1 - part) * arrives((cell + phase) * kCell, mu0) +
           part * arrives((cell + 1 + phase) * kCell, mu0);
  }
  static double seen(double mu, double mu0, double phase, double jitter) {
    double transmittance = 1, sum = 0;
    for (double x = (jitter - 1) * kStep * mu; transmittance > 1e-3 && x < 6; x += kStep * mu) {
      const double passed = std::exp(-kStep * extinction(x));
      sum += transmittance * (1 - passed) * light(x, mu0, phase);
      transmittance *= passed;
    }
    return sum;
  }
};

/// By how much the lights of a level, scattered once, may be off in the mean.
double bound_of(const scenario::Scenario& scenario) {
  double most = 0;
  for (const scene::Light& light : scenario.scene.lights) {
    const glm::vec3 to_light = glm::normalize(light.position_world - kMiddle),
                    to_eye = glm::normalize(scenario.camera.position_world - kMiddle);
    most = std::max(most, Discretised::of_ball(std::acos(double{glm::dot(to_light, to_eye)})));
  }
  return most;
}

TEST_F(TankInLevelTest, IsLitByTheLightsOfTheLevel) {
  const auto both = media_of({}), warm = media_of({.lights = {kWarm}}), cold = media_of({.lights = {kCold}});
  const auto dark = media_of({.lights = {}});
  const glm::dvec3 all = mean_where_opaque(both, both), of_warm = mean_where_opaque(warm, both),
                   of_cold = mean_where_opaque(cold, both);
  // Light adds up; two halves are rounded where one is.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(all[c], of_warm[c] + of_cold[c], 3.0 / 2048 * all[c]) << c;
  EXPECT_EQ(mean_where_opaque(dark, both), glm::dvec3(0));
  // The colour is that of the light times that of the ball, more saturated by what is scattered often.
  const glm::dvec3 albedo(0.745, 0.456, 0.279);
  EXPECT_GT(of_warm.r / of_warm.b, 40.0 / 5 * albedo.r / albedo.b);
  EXPECT_GT(of_cold.b / of_cold.r, 0.5 * 30.0 / 4 * albedo.b / albedo.r);
  EXPECT_LT(of_cold.r, of_cold.g);
}

TEST_F(TankInLevelTest, ScattersOnceAsThePathTracer) {
  for (const scene::Light& light : {kWarm, kCold}) {
    const auto one = studio({.lights = {light}, .multiple_scattering = 0});
    const auto drawn = media(*one);
    const reference::Mean traced = traced_mean(*one, drawn, 1);
    const double most = bound_of(one->scenario);
    const double mean = mean_where_opaque(drawn, drawn).g;
    std::printf("scattered once: drawn %.5f, traced %.5f +- %.5f; may be off by %.1f %%\n", mean,
                traced.value(), traced.error(), 100 * most);
    EXPECT_LT(most, 0.15) << "the bound says something";
    EXPECT_NEAR(mean, traced.value(), most * traced.value() + 4 * traced.error());
  }
}

// The fit of multiple scattering is known to a factor of exp(0.26) (docs/how/light.md).
TEST_F(TankInLevelTest, ScattersOftenAsThePathTracer) {
  const auto all = studio({}), once = studio({.multiple_scattering = 0});
  const auto drawn = media(*all);
  const reference::Mean traced = traced_mean(*all, drawn, 1000), single = traced_mean(*once, drawn, 1);
  const double mean = mean_where_opaque(drawn, drawn).g, many = traced.value() - single.value();
  const double most = bound_of(all->scenario) * single.value() + (std::exp(0.26) - 1) * many;
  std::printf("scattered often: drawn %.5f, traced %.5f, of which once %.5f\n", mean, traced.value(),
              single.value());
  EXPECT_GT(many, 0.1 * single.value());
  EXPECT_NEAR(mean, traced.value(), most + 4 * traced.error());
}

/// Voxels of a ray from a point to a light that are in the ball; negative: by how many it misses it.
double chord(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 along = glm::normalize(to - from), middle = glm::dvec3(kMiddle) - from;
  const double aside = glm::length(middle - glm::dot(middle, along) * along) / double{kVoxel},
               r = double{kRadius};
  return aside < r ? 2 * std::sqrt(r * r - aside * aside) : r - aside;
}

/// How much of a light is left on the floor, where the camera sees it beside the tank.
struct ShadowPixel {
  double chord = 0, left = 0;
};

class TankShadowTest : public TankInLevelTest {
 protected:
  static constexpr glm::vec3 kLight{-2, 4, 0};

  std::vector<ShadowPixel> shadow_of(spheres::Color color) const {
    const auto one = studio({.lights = {scene_light(kLight, glm::vec3(60))}, .color = color, .floor = 0.5f});
    one->input.view.camera = {{1.5f, 3, 4}, {0.7f, 0, 0}, 0.6f};
    const std::vector<glm::dvec4> tank = media(*one), with = texels(one->renderer->targets().radiance);
    one->input.volumes.clear();
    one->renderer->draw(one->input);
    const std::vector<glm::dvec4> without = texels(one->renderer->targets().radiance);
    const shared::Camera camera = planning::device_camera(one->input.view.camera, kSize);
    std::vector<ShadowPixel> pixels;
    for (std::uint32_t i = 0; i < tank.size(); ++i) {
      const reference::Ray ray = ray_of(camera, i);
      if (tank[i].w < 1 || ray.direction.y >= 0) continue;
      const glm::dvec3 at(ray.origin - ray.direction * (ray.origin.y / ray.direction.y));
      if (at.z < -3.9 || std::abs(at.x) > 5.9) continue;
      pixels.push_back({chord(at, glm::dvec3(kLight)), with[i].g / without[i].g});
    }
    return pixels;
  }
};

TEST_F(TankShadowTest, HazeDimsTheFloorByTheLengthInIt) {
  const double per_voxel = 1 - (kHaze >> 24) / 255.0;
  double sum = 0, expected_sum = 0;
  int inside = 0, beside = 0;
  for (const ShadowPixel& pixel : shadow_of(kHaze)) {
    if (pixel.chord > 1.2 * double{kRadius}) {
      // Painted voxels and their filter end within 1.4 voxels of the ball on either side.
      const double expected = std::pow(per_voxel, pixel.chord), most = std::pow(per_voxel, -2.8);
      EXPECT_LT(pixel.left, expected * most) << pixel.chord;
      EXPECT_GT(pixel.left, expected / most) << pixel.chord;
      sum += pixel.left;
      expected_sum += expected;
      ++inside;
    } else if (pixel.chord < -4) {
      EXPECT_NEAR(pixel.left, 1, 3.0 / 1024) << pixel.chord;
      ++beside;
    }
  }
  std::printf("shadow: %d pixels, mean %.4f, expected %.4f; %d beside it\n", inside, sum / inside,
              expected_sum / inside, beside);
  EXPECT_GT(inside, 100);
  EXPECT_GT(beside, 100);
  // All in all they end at the ball: half a voxel of its two sides.
  EXPECT_NEAR(sum / expected_sum, 1, 1 - std::pow(per_voxel, 0.5));
}

TEST_F(TankShadowTest, AnOpaqueBallLeavesTheFloorDark) {
  int inside = 0;
  for (const ShadowPixel& pixel : shadow_of(kOpaque)) {
    if (pixel.chord < 1.2 * double{kRadius}) continue;
    EXPECT_LT(pixel.left, 1e-3) << pixel.chord;
    ++inside;
  }
  EXPECT_GT(inside, 100);
}

/// Black smoke in the way of the eye or of the light.
class TankInSmokeTest : public TankInLevelTest {
 protected:
  /// Of the same media, hence in the same steps: what has no extinction shows nothing.
  std::vector<glm::dvec4> draw(Studio& studio, bool smoke, bool tank) const {
    const float extinction = studio.input.volumes[0].look.extinction;
    studio.input.smoke.look.extinction = smoke ? 1.0f : 0.0f;
    if (!tank) studio.input.volumes[0].look.extinction = 0;
    const std::vector<glm::dvec4> drawn = media(studio);
    studio.input.volumes[0].look.extinction = extinction;
    return drawn;
  }
  static scene::Light side_light() { return scene_light({-3, 3, 0}, glm::vec3(40)); }
};

TEST_F(TankInSmokeTest, SmokeBeforeItHidesItAndThatBehindDoesNot) {
  for (const bool before : {true, false}) {
    const auto one = studio({.lights = {side_light()}, .smoke = glm::vec3(0, 0.9f, before ? 3.2f : -2.6f)});
    const auto tank = draw(*one, false, true), smoke = draw(*one, true, false), both = draw(*one, true, true);
    int hidden = 0, clear = 0;
    for (std::size_t i = 0; i < both.size(); ++i) {
      // A ray ends where next to nothing is left; and each of three pictures is rounded to halves.
      const double rest = double{one->input.smoke.look.opaque_transmittance} + 3.0 / 2048;
      if (tank[i].w == 0) {
        const double passed = before ? smoke[i].w : 1;
        EXPECT_NEAR(both[i].g, passed * tank[i].g, rest * tank[i].g + 1e-5) << i << ' ' << before;
        hidden += smoke[i].w < 0.5 && tank[i].g > 0.01;
      } else if (tank[i].w == 1) {
        EXPECT_NEAR(both[i].w, smoke[i].w, rest) << i;
        clear += smoke[i].w < 0.8;
      }
    }
    EXPECT_GT(hidden, 50) << before;
    EXPECT_GT(clear, 50) << before;
  }
}

TEST_F(TankInSmokeTest, SmokeBeforeALightDimsItAsInThePathTracer) {
  const auto one = studio({.lights = {scene_light({-4, 1.2f, 1.5f}, glm::vec3(40))},
                           .multiple_scattering = 0,
                           .smoke = glm::vec3(-2.2f, 0.9f, 0.8f)});
  const auto clear = draw(*one, false, true);
  const reference::Mean traced_clear = traced_mean(*one, clear, 1);
  const auto dimmed = draw(*one, true, true);
  const reference::Mean traced_dimmed = traced_mean(*one, clear, 1);
  const double left = mean_where_opaque(dimmed, clear).g / mean_where_opaque(clear, clear).g;
  const double expected = traced_dimmed.value() / traced_clear.value();
  const double error = expected * std::hypot(traced_dimmed.error() / traced_dimmed.value(),
                                             traced_clear.error() / traced_clear.value());
  std::printf("behind smoke: %.4f of the light, traced %.4f +- %.4f\n", left, expected, error);
  EXPECT_LT(expected, 0.6);
  // Light rays step by a voxel of 0.25 m, in which the smoke begins and ends: half of one on each side.
  EXPECT_NEAR(std::log(left / expected), 0, 0.25 + 4 * error / expected);
}

}  // namespace
}  // namespace brume::render
