#include <array>
#include <filesystem>
#include <span>

#include "bench/frames.hpp"
#include "core/platform/process.hpp"
#include "core/utf8.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/generate.hpp"

namespace brume::bench {
namespace {

/// A voxel on its own, `away` voxels from the origin along each axis.
void add_far_voxel(grids::Grid& grid, int away) {
  grids::Brick& brick = grid.bricks.emplace_back();
  brick.origin = glm::ivec3(away / 8 * 8);
  brick.active[0] = 1;
  std::array<float, grids::kBrickVoxels> values{};
  values[0] = 1e-3f;
  const auto bytes = std::as_bytes(std::span(values));
  grid.values.insert(grid.values.end(), bytes.begin(), bytes.end());
}

/// What is drawn.
struct CloudScene {
  float extinction = 1, albedo = 0;
  scene::Camera camera;
  int copies = 1;  ///< All in the same place.
  int away = 0;    ///< As add_far_voxel; 0: there is none.
};

/// A volume in an empty world under one sun, from a file that is removed again.
Result<scenario::Scenario> volume_scenario(const grids::CloudSettings& settings, const CloudScene& drawn) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() /
      to_path("brume_bench_" + std::to_string(platform::process_id()) + ".brv");
  grids::GridFile grids;
  grids.grids.push_back(grids::generate_cloud(settings));
  if (drawn.away > 0) add_far_voxel(grids.grids[0], drawn.away);
  if (auto saved = grids::save_grid_file(file, grids); !saved) return saved.failure();
  scene::Timeline timeline;
  timeline.scene = file;
  timeline.sun.emplace();
  scene::VolumeOptions volume;
  volume.file = file;
  volume.extinction = drawn.extinction / static_cast<float>(drawn.copies);
  volume.albedo = glm::vec3(drawn.albedo);
  timeline.volumes.assign(static_cast<std::size_t>(drawn.copies), volume);
  timeline.camera = {{0, drawn.camera}};
  auto scenario = scenario::make_scenario(std::move(timeline), {});
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  return scenario;
}

/// The march at 1080p, with the light and the memory as details.
Result<std::vector<Measurement>> measure(Bench& bench, const std::string& name,
                                         const scenario::Scenario& scenario, float step_scale) {
  render::RendererOptions options;
  options.size_px = bench.is_slow() ? glm::uvec2(480, 270) : glm::uvec2(1920, 1080);
  const FrameTimes times =
      time_frames(bench, name, scenario, options, 0,
                  [step_scale](planning::Quality& quality) { quality.step_scale = step_scale; });
  Measurement m = times.march;
  m.details = {{"volume_light_ms", times.all.details.at("volume_light_ms")},
               {"frame_ms", times.all.median},
               {"device_mb", times.all.details.at("device_mb")}};
  return std::vector{m};
}

/// NanoVDB's example ex_raytrace_fog_volume: a sphere of 100 voxels' radius that only absorbs, seen from
/// twice its diameter at 45 degrees, in steps of half a voxel.
Result<std::vector<Measurement>> fog_sphere(Bench& bench, const std::string& name, float albedo) {
  grids::CloudSettings settings;
  settings.kind = grids::CloudKind::sphere;
  settings.edge = 208;
  settings.voxel_size = 1;
  settings.radius = 100;
  settings.edge_width = 3;
  const auto scenario = volume_scenario(settings, {0.01f, albedo, {{0, 0, 400}, glm::vec3(0), 0.785398f}});
  if (!scenario) return scenario.failure();
  return measure(bench, name, *scenario, 0.5f);
}

/// A pyroclastic cloud with the optical depth of 0.05 per voxel of 256 across.
Result<std::vector<Measurement>> cloud(Bench& bench, const std::string& name, std::uint32_t edge,
                                       int copies = 1, int away = 0) {
  grids::CloudSettings settings;
  settings.edge = edge;
  settings.voxel_size = 1;
  settings.radius = 0.25 * edge;
  settings.edge_width = 2;
  settings.amplitude = 0.75;
  const glm::vec3 eye = glm::normalize(glm::vec3(0.4f, 0.3f, 1)) * 1.4f * static_cast<float>(edge);
  const auto scenario = volume_scenario(
      settings, {0.05f * 256 / static_cast<float>(edge), 0.99f, {eye, glm::vec3(0), 0.8f}, copies, away});
  if (!scenario) return scenario.failure();
  return measure(bench, name, *scenario, 1);
}

}  // namespace

std::vector<Case> cloud_cases() {
  return {
      {"volumes/fog_sphere", "a sphere of fog of 100 voxels' radius that absorbs, in steps of half a voxel",
       [](Bench& b) { return fog_sphere(b, "volumes/fog_sphere", 0); }},
      {"volumes/fog_sphere_lit", "the same, lit by a sun",
       [](Bench& b) { return fog_sphere(b, "volumes/fog_sphere_lit", 0.9f); }},
      {"volumes/cloud256", "a pyroclastic cloud of 256^3 voxels, lit; 480x270 without a GPU, as all of these",
       [](Bench& b) { return cloud(b, "volumes/cloud256", 256); }},
      {"volumes/cloud512", "the same of 512^3 voxels",
       [](Bench& b) { return cloud(b, "volumes/cloud512", 512); }},
      {"volumes/cloud1024", "the same of 1,024^3 voxels",
       [](Bench& b) { return cloud(b, "volumes/cloud1024", 1024); }},
      {"volumes/copies4", "four clouds of 256^3 voxels in one place, each a quarter as dense",
       [](Bench& b) { return cloud(b, "volumes/copies4", 256, 4); }},
      {"volumes/copies16", "sixteen clouds of 256^3 voxels in one place",
       [](Bench& b) { return cloud(b, "volumes/copies16", 256, 16); }},
      {"volumes/empty8", "a cloud of 256^3 voxels, and a voxel 8 times as far as its edge",
       [](Bench& b) { return cloud(b, "volumes/empty8", 256, 1, 8 * 256); }},
      {"volumes/empty64", "the same 64 times as far",
       [](Bench& b) { return cloud(b, "volumes/empty64", 256, 1, 64 * 256); }},
  };
}

}  // namespace brume::bench
