#include <unistd.h>

#include <filesystem>

#include "bench/frames.hpp"
#include "grids/files.hpp"
#include "grids/generate.hpp"

namespace brume::bench {
namespace {

/// A volume in an empty world under one sun, from a file that is removed again.
Result<scenario::Scenario> volume_scenario(const grids::CloudSettings& settings, float extinction,
                                           float albedo, const scene::Camera& camera) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("brume_bench_" + std::to_string(::getpid()) + ".brv");
  grids::GridFile grids;
  grids.grids.push_back(grids::generate_cloud(settings));
  if (auto saved = grids::save_grid_file(file, grids); !saved) return saved.failure();
  scene::Timeline timeline;
  timeline.scene = file;
  timeline.sun.emplace();
  scene::VolumeOptions volume;
  volume.file = file;
  volume.extinction = extinction;
  volume.albedo = glm::vec3(albedo);
  timeline.volumes = {volume};
  timeline.camera = {{0, camera}};
  auto scenario = scenario::make_scenario(std::move(timeline), {});
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  return scenario;
}

/// The march at 1080p, with the light and the memory as details.
Result<std::vector<Measurement>> measure(Bench& bench, const std::string& name,
                                         const scenario::Scenario& scenario, float step_scale) {
  render::RendererOptions options;
  options.size_px = bench.context().info().kind == "cpu" ? glm::uvec2(480, 270) : glm::uvec2(1920, 1080);
  const FrameTimes times = time_frames(bench, name, scenario, options, 0, step_scale);
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
  const auto scenario = volume_scenario(settings, 0.01f, albedo, {{0, 0, 400}, glm::vec3(0), 0.785398f});
  if (!scenario) return scenario.failure();
  return measure(bench, name, *scenario, 0.5f);
}

/// A pyroclastic cloud with the optical depth of 0.05 per voxel of 256 across.
Result<std::vector<Measurement>> cloud(Bench& bench, std::uint32_t edge) {
  grids::CloudSettings settings;
  settings.edge = edge;
  settings.voxel_size = 1;
  settings.radius = 0.25 * edge;
  settings.edge_width = 2;
  settings.amplitude = 0.75;
  const glm::vec3 eye = glm::normalize(glm::vec3(0.4f, 0.3f, 1)) * 1.4f * static_cast<float>(edge);
  const auto scenario =
      volume_scenario(settings, 0.05f * 256 / static_cast<float>(edge), 0.99f, {eye, glm::vec3(0), 0.8f});
  if (!scenario) return scenario.failure();
  return measure(bench, "volumes/cloud" + std::to_string(edge), *scenario, 1);
}

}  // namespace

std::vector<Case> cloud_cases() {
  return {
      {"volumes/fog_sphere", "a sphere of fog of 100 voxels' radius that absorbs, in steps of half a voxel",
       [](Bench& b) { return fog_sphere(b, "volumes/fog_sphere", 0); }},
      {"volumes/fog_sphere_lit", "the same, lit by a sun",
       [](Bench& b) { return fog_sphere(b, "volumes/fog_sphere_lit", 0.9f); }},
      {"volumes/cloud256", "a pyroclastic cloud of 256^3 voxels, lit; 480x270 without a GPU, as all of these",
       [](Bench& b) { return cloud(b, 256); }},
      {"volumes/cloud512", "the same of 512^3 voxels", [](Bench& b) { return cloud(b, 512); }},
      {"volumes/cloud1024", "the same of 1,024^3 voxels", [](Bench& b) { return cloud(b, 1024); }},
  };
}

}  // namespace brume::bench
