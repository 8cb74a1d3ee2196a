#include <algorithm>
#include <cmath>
#include <random>

#include "bench/frames.hpp"
#include "scene/files/timeline_reader.hpp"

namespace brume::bench {
namespace {

constexpr double kGrown = 4;  // [s]: the smoke has bloomed and the holes are open

/// Variants of the yard scenario.
struct Yard {
  bool from_all_around = false;  ///< Shots come from all directions; else from near the camera.
  std::uint32_t lights = 0;      ///< In addition to those of the demo scene.
  std::uint32_t holes = 0;       ///< Half round, half square.
};

/// Shots of about 0.1 m diameter through the smoke, half of them square: all open when it has grown.
std::vector<scene::ShotEvent> shots_through_smoke(std::uint32_t count, bool from_all_around) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> one(-1, 1);
  std::vector<scene::ShotEvent> shots(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    scene::ShotEvent& shot = shots[i];
    const float angle = 3.14159265f * one(random);
    shot.time = kGrown - 1;
    shot.from_world = {9 * std::cos(angle), 1.5f + 1.2f * one(random), 6 + 9 * std::sin(angle)};
    if (!from_all_around) shot.from_world = {2 * one(random), 1.6f + 0.3f * one(random), 13 + one(random)};
    shot.toward_world = {3.5f * one(random), 1.6f + 1.4f * one(random), 6 + 3.5f * one(random)};
    shot.radius = 0.05f + 0.02f * one(random);
    shot.shape = i % 2 == 0 ? scene::ShotShape::cylinder : scene::ShotShape::box;
    shot.times.stay = 100;
    shot.flash = 0;
  }
  return shots;
}

/// One smoke of 1,800 half-metre voxels in the yard of the demo scene, 6 m from the camera: it fills the
/// view.
Result<scenario::Scenario> smoke_in_the_yard(const Yard& yard) {
  auto timeline = scene::load_timeline(scene_file("demo.toml"));
  if (!timeline) return timeline.failure();
  timeline->grid = {0.5f, glm::ivec3(57, 19, 57), glm::vec3(-14.1f, -0.35f, -12.1f)};
  timeline->smoke.voxels = 1800;
  timeline->smoke.extinction = 1.3f;  // fixed, so that results stay comparable when the demo changes
  timeline->smoke.bloom = 1;
  timeline->smokes = {{0, {0, 3, 7}, {0, 0.3f, 6}}};
  timeline->shots = shots_through_smoke(yard.holes, yard.from_all_around);
  timeline->camera = {{0, {{0, 1.8f, 12}, {0, 2.2f, 6}, 1.0472f}}};
  auto scenario = scenario::make_scenario(std::move(*timeline), {});
  if (!scenario) return scenario.failure();
  for (std::uint32_t i = 0; i < yard.lights; ++i) {
    scene::Light light;
    const float angle = 2.39996f * static_cast<float>(i),
                far = 1.6f * std::sqrt(static_cast<float>(i) + 0.5f);
    light.position_world = {far * std::cos(angle), 0.6f + 0.35f * static_cast<float>(i % 9),
                            5 + far * std::sin(angle)};
    light.intensity = 0.5f + 0.5f * glm::vec3(std::cos(angle), std::cos(angle + 2), std::cos(angle + 4));
    scenario->scene.lights.push_back(light);
  }
  return scenario;
}

/// Number of texture samples that the march takes per frame.
double count_texture_samples(gpu::Context& context, const scenario::Scenario& scenario,
                             render::RendererOptions options) {
  options.smoke.count_samples = true;
  RepeatedFrame frame(context, scenario, options, kGrown);
  frame.draw();
  return frame.texture_samples();
}

Result<std::vector<Measurement>> march(Bench& bench) {
  const auto scenario = smoke_in_the_yard({});
  if (!scenario) return scenario.failure();
  render::RendererOptions options;
  options.size_px = {1920, 1080};
  Measurement m = time_frames(bench, "march/1080p", *scenario, options, kGrown).march;
  const double samples = count_texture_samples(bench.context(), *scenario, options);
  m.details = {{"texture_samples", samples}, {"gsamples_per_second", samples / m.median * 1e-6}};
  const Measurement soft = time_frames(bench, "march/1080p_without_fine_shadows", *scenario, options, kGrown,
                                       [](planning::Quality& quality) { quality.fine_shadows = false; })
                               .march;
  const Measurement coarse = time_frames(bench, "march/1080p_without_detail", *scenario, options, kGrown,
                                         [](planning::Quality& quality) { quality.detail = false; })
                                 .march;
  return std::vector{m, soft, coarse};
}

/// All bounces of the indirect light of the demo scene and of a smoke in it.
Result<std::vector<Measurement>> indirect_light(Bench& bench) {
  auto scenario = smoke_in_the_yard({});
  if (!scenario) return scenario.failure();
  scenario->timeline.bounces = 8;
  render::RendererOptions options;
  options.size_px = {64, 36};
  RepeatedFrame frame(bench.context(), *scenario, options, kGrown);
  frame.input().quality.indirect_update_fraction = 1;
  const bool slow = bench.is_slow();
  for (unsigned i = 0; i < (slow ? 1u : 50u); ++i) frame.draw();
  std::vector<double> milliseconds;
  for (unsigned i = 0; i < bench.repetitions(slow ? 3 : 200); ++i)
    milliseconds.push_back(frame.draw().passes.at("indirect_light"));
  return std::vector{summarize("indirect_light", "ms", "gpu", milliseconds)};
}

/// 51 lights and 64 open holes. `is_film`: smoothed over frames.
Result<std::vector<Measurement>> frames(Bench& bench, const std::string& name, glm::uvec2 size_px,
                                        std::uint32_t march_scale, bool is_film = false) {
  Yard yard;
  yard.lights = 42;
  yard.holes = 64;
  const auto scenario = smoke_in_the_yard(yard);
  if (!scenario) return scenario.failure();
  render::RendererOptions options;
  options.size_px = size_px;
  options.smoke.march_scale = march_scale;
  options.smoke.temporal = options.antialias = is_film;
  options.smoke.masks = &scenario->masks;
  return std::vector{time_frames(bench, name, *scenario, options, kGrown).all};
}

/// The motel at half resolution: 51 lights, one grown smoke of 1,800 voxels 6 m ahead, without and with shots
/// through it.
Result<std::vector<Measurement>> motel_frames(Bench& bench) {
  const auto path = motel_scene();
  if (!path) return path.failure();
  std::vector<Measurement> results;
  for (const std::uint32_t holes : {0u, 30u}) {
    scene::Timeline timeline;
    timeline.scene = *path;
    timeline.duration = 6;
    timeline.grid = {0.5f, glm::ivec3(120, 20, 120), glm::vec3(-30, 0, -30)};
    timeline.smoke.voxels = 1800;
    timeline.smokes = {{0, {0, 3.5f, -5}, {0, 1.2f, -6}}};
    timeline.camera = {{0, {{0, 2.36f, 0}, {0, 2.36f, -10}, 1.0472f}}};
    for (std::uint32_t i = 0; i < holes; ++i) {
      scene::ShotEvent shot;
      shot.time = kGrown - 1;
      shot.from_world = {0, 2.36f, -0.5f};
      shot.toward_world = {0.4f * static_cast<float>(i % 6) - 1, 1.2f + 0.4f * static_cast<float>(i / 6), -6};
      shot.times.stay = 100;
      shot.flash = 0;
      timeline.shots.push_back(shot);
    }
    const auto scenario = scenario::make_scenario(std::move(timeline), {});
    if (!scenario) return scenario.failure();
    render::RendererOptions options;
    options.size_px = {1920, 1080};
    options.smoke.march_scale = bench.is_slow() ? 4 : 2;
    options.smoke.masks = &scenario->masks;
    const std::string name = holes > 0 ? "frame/motel_holes" : "frame/motel";
    results.push_back(time_frames(bench, name, *scenario, options, kGrown).all);
  }
  return results;
}

/// The frame with increasing numbers of holes, with clustered culling and with a plain loop over all of them.
Result<std::vector<Measurement>> holes(Bench& bench, const std::string& base, bool from_all_around) {
  const bool slow = bench.is_slow();
  std::vector<Measurement> results;
  for (const bool plain : {false, true}) {
    double none = 0;
    for (const std::uint32_t count : {0u, 16u, 64u, 256u, 1024u, 4096u}) {
      // The trend is clear by then, and on a software device the loop would take minutes.
      if (plain && (count == 0 || count > (slow ? 64u : 1024u))) continue;
      Yard yard;
      yard.holes = count;
      yard.from_all_around = from_all_around;
      const auto scenario = smoke_in_the_yard(yard);
      if (!scenario) return scenario.failure();
      render::RendererOptions options;
      options.size_px = slow ? glm::uvec2(480, 270) : glm::uvec2(1920, 1080);
      options.smoke.brute_force_holes = plain;
      options.smoke.masks = &scenario->masks;
      const std::string name = (plain ? base + "/plain/" : base + "/") + std::to_string(count);
      Measurement m = time_frames(bench, name, *scenario, options, kGrown).all;
      if (count == 0) none = m.median;
      if (plain) none = results.front().median;
      m.details["times_none"] = m.median / none;
      results.push_back(m);
    }
  }
  return results;
}

/// A flash next to the smoke of the yard.
shared::Light flash_beside(float intensity) {
  shared::Light light{};
  light.kind = shared::kLightPoint;
  light.position_world = {3.5f, 1.5f, 9};
  light.intensity = glm::vec3(intensity);
  light.range = shared::light_range(intensity);
  light.shadow_layer = shared::kShadowByVoxels;
  return light;
}

/// Light in a smoke without noise motion: all of it, and what the cache updates when one thing changes.
Result<std::vector<Measurement>> light_cache(Bench& bench) {
  Yard yard;
  yard.lights = 42;
  yard.holes = 16;
  auto scenario = smoke_in_the_yard(yard);
  if (!scenario) return scenario.failure();
  scenario->timeline.smoke.erosion = 0;
  const bool slow = bench.is_slow();
  render::RendererOptions options;
  options.size_px = slow ? glm::uvec2(96, 54) : glm::uvec2(1920, 1080);
  RepeatedFrame frame(bench.context(), *scenario, options, kGrown);
  const std::vector<shared::Hole> holes(frame.input().smoke.holes.begin(), frame.input().smoke.holes.end());
  std::vector<shared::Hole> changing = holes;
  std::vector<Measurement> results;
  const auto time = [&](const std::string& name, auto change) {
    std::vector<double> milliseconds;
    const unsigned count = bench.repetitions(slow ? 3 : 200);
    std::size_t rays = 0, bricks = 0;
    for (unsigned i = 0; i < count + 2; ++i) {
      change(i);
      const FrameCost cost = frame.draw();
      if (i < 2) continue;
      milliseconds.push_back(cost.passes.at("light"));
      rays += frame.renderer().light_plan().shadow_rays.size();
      bricks += frame.renderer().light_plan().gathers.size();
    }
    results.push_back(summarize("light_cache/" + name, "ms", "gpu", milliseconds));
    results.back().details = {{"blocks_of_rays", static_cast<double>(rays) / count},
                              {"bricks", static_cast<double>(bricks) / count}};
  };
  time("all", [](unsigned) {});
  frame.input().quality.rebuild_light = false;
  time("nothing", [](unsigned) {});
  time("eye",
       [&](unsigned i) { frame.input().view.camera.position_world.x = 0.01f * static_cast<float>(i); });
  time("hole", [&](unsigned i) {
    changing.back().radius = holes.back().radius * (i % 2 == 0 ? 1 : 0.9f);
    frame.input().smoke.holes = changing;
  });
  // A light that changes its intensity, and one that appears.
  time("flicker",
       [&](unsigned i) { frame.input().environment.flashes = {flash_beside(i % 2 == 0 ? 1 : 2)}; });
  time("flash", [&](unsigned i) {
    frame.input().environment.flashes = {flash_beside(2)};
    frame.input().environment.flashes[0].position_world.y += 0.01f * static_cast<float>(i);
  });
  return results;
}

}  // namespace

std::vector<Case> gpu_cases() {
  return {
      {"march/1080p", "the march through one grown smoke that fills the view", march},
      {"frame/1080p", "all passes except rasterization: that smoke with 51 lights and 64 holes",
       [](Bench& b) {
         return frames(b, "frame/1080p", {1920, 1080}, 1);
       }},
      {"frame/1080p_half", "the same, marched at half resolution",
       [](Bench& b) {
         return frames(b, "frame/1080p_half", {1920, 1080}, 2);
       }},
      {"frame/1080p_film", "at full resolution, smoke and edges smoothed over frames",
       [](Bench& b) {
         return frames(b, "frame/1080p_film", {1920, 1080}, 1, true);
       }},
      {"frame/4k", "the same at 3840x2160, marched at full resolution",
       [](Bench& b) {
         return frames(b, "frame/4k", {3840, 2160}, 1);
       }},
      {"indirect_light", "8 bounces of indirect light in the demo scene and a smoke in it", indirect_light},
      {"frame/motel",
       "the motel with smoke, without and with 30 holes, at half resolution; at a quarter without a GPU",
       motel_frames},
      {"light_cache", "light in static smoke when everything, nothing or one thing changes", light_cache},
      {"holes",
       "that frame with 0 to 4,096 open holes, and with a plain loop over them; 480x270 without a GPU",
       [](Bench& b) { return holes(b, "holes", false); }},
      {"holes_around", "the same, with shots from all directions",
       [](Bench& b) { return holes(b, "holes_around", true); }},
  };
}

}  // namespace brume::bench
