#include <unistd.h>

#include <filesystem>

#include "bench/frames.hpp"
#include "grids/files.hpp"
#include "grids/generate.hpp"

namespace brume::bench {
namespace {

/// A volume in an empty world under one sun, from a file that is removed again.
Result<scenario::Scenario> volume_scenario(const grids::CloudSettings& settings, float extinction,
                                           glm::vec3 eye_world) {
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
  timeline.volumes = {volume};
  timeline.camera = {{0, {eye_world, glm::vec3(0), 0.8f}}};
  auto scenario = scenario::make_scenario(std::move(timeline), {});
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  return scenario;
}

/// The march, with the light and the memory as details.
Result<std::vector<Measurement>> measure(Bench& bench, const std::string& name,
                                         const grids::CloudSettings& settings, float extinction,
                                         double distance, double steps_per_voxel, glm::uvec2 size_px) {
  const auto eye = glm::vec3(glm::normalize(glm::dvec3(0.4, 0.3, 1)) * distance);
  const auto scenario = volume_scenario(settings, extinction, eye);
  if (!scenario) return scenario.failure();
  render::RendererOptions options;
  options.size_px = size_px;
  const FrameTimes times =
      time_frames(bench, name, *scenario, options, 0, static_cast<float>(1 / steps_per_voxel));
  Measurement m = times.march;
  m.details = {{"volume_light_ms", times.all.details.at("volume_light_ms")},
               {"frame_ms", times.all.median},
               {"device_mb", times.all.details.at("device_mb")}};
  return std::vector{m};
}

/// NanoVDB's example of a fog volume: a sphere of 100 voxels' radius, steps of half a voxel. It fills the
/// height.
Result<std::vector<Measurement>> fog_sphere(Bench& bench) {
  grids::CloudSettings settings;
  settings.kind = grids::CloudKind::sphere;
  settings.edge = 208;
  settings.voxel_size = 1;
  settings.radius = 100;
  settings.edge_width = 3;
  const bool slow = bench.context().info().kind == "cpu";
  return measure(bench, "volumes/fog_sphere", settings, 0.02f, 260, 2,
                 slow ? glm::uvec2(480, 270) : glm::uvec2(1920, 1080));
}

Result<std::vector<Measurement>> cloud(Bench& bench, std::uint32_t edge) {
  grids::CloudSettings settings;
  settings.edge = edge;
  settings.voxel_size = 1;
  settings.radius = 0.25 * edge;
  settings.edge_width = 2;
  settings.amplitude = 0.75;
  const bool slow = bench.context().info().kind == "cpu";
  return measure(bench, "volumes/cloud" + std::to_string(edge), settings,
                 0.05f * 256 / static_cast<float>(edge), 1.4 * edge, 1,
                 slow ? glm::uvec2(512, 512) : glm::uvec2(1920, 1080));
}

}  // namespace

std::vector<Case> cloud_cases() {
  return {
      {"volumes/fog_sphere",
       "the march through a sphere of fog of 100 voxels' radius at 1080p, in steps of half a voxel",
       fog_sphere},
      {"volumes/cloud256", "the march through a pyroclastic cloud at 1080p; 512x512 without a GPU",
       [](Bench& b) { return cloud(b, 256); }},
      {"volumes/cloud512", "the same of 512^3 voxels", [](Bench& b) { return cloud(b, 512); }},
      {"volumes/cloud1024", "the same of 1,024^3 voxels", [](Bench& b) { return cloud(b, 1024); }},
  };
}

}  // namespace brume::bench
