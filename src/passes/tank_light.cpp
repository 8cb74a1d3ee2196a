#include "passes/tank_light.hpp"

#include "brume_shaders.hpp"
#include "planning/tank_light_plan.hpp"

namespace brume::passes {
namespace {

/// Layers that a voxel walks by itself: the bilinear map behind them mixes rays past its own sphere's rim.
constexpr std::uint32_t kNearLayers = 2;

gpu::Image image_3d(gpu::Context& context, const glm::uvec3& size, VkFormat format) {
  return gpu::Image(context, gpu::storage_image_3d(size, format));
}

}  // namespace

gpu::Image make_voxel_light(gpu::Context& context, const glm::uvec3& size) {
  return image_3d(context, size, VK_FORMAT_R32_UINT);
}

TankLightPass::TankLightPass(gpu::Context& context)
    : context_(context),
      map_pipeline_(context, shaders::tank_light_map_comp),
      light_pipeline_(context, shaders::tank_light_comp),
      nearest_(context, {VK_FILTER_NEAREST}),
      linear_(context, {VK_FILTER_LINEAR}),
      map_(image_3d(context, glm::uvec3(1), VK_FORMAT_R16_SFLOAT)) {}

void TankLightPass::reserve(const TankVolume& volume, std::span<const shared::TankLight> lights,
                            scene::TankLighting lighting) {
  const bool exact = lighting == scene::TankLighting::exact;
  steps_.clear();
  for (const shared::TankLight& light : lights) {
    // An exact light has no map: one that stands for all voxels.
    std::vector<shared::LightMap> maps = planning::light_maps(light.position, volume.size);
    if (exact) {
      shared::LightMap all{};
      all.origin = light.position;
      all.axis = 2;
      all.whole = 1;
      maps = {all};
    }
    for (const shared::LightMap& map : maps)
      steps_.push_back({map, volume.size, exact ? 0u : kNearLayers, light.intensity, 1u, glm::vec3(0)});
  }
  if (steps_.empty()) steps_.push_back({{}, volume.size, 0, glm::vec3(0), 1, glm::vec3(0)});
  steps_.front().adds = 0;

  glm::uvec3 room(1);
  if (!exact)
    for (const shared::TankLightParams& step : steps_)
      room = glm::max(room, {step.map.rays, step.map.layers});
  if (room != map_.info().size) {
    map_ = gpu::Image();
    map_ = image_3d(context_, room, VK_FORMAT_R16_SFLOAT);
  }
}

void TankLightPass::record(gpu::Recorder& recorder, const TankVolume& volume, const gpu::Image& light,
                           const glm::vec3& ambient) {
  for (shared::TankLightParams step : steps_) {
    step.ambient = ambient;
    if (step.near_layers > 0) {
      const gpu::Scope scope(recorder, "tank_light_map");
      recorder.bind(map_pipeline_,
                    {{shared::kBindVoxelColors, gpu::sampled(volume.colors, nearest_)},
                     {shared::kBindLightMap, gpu::stored(map_)}},
                    step);
      recorder.dispatch_threads(map_pipeline_, step.map.rays.x, step.map.rays.y);
    }
    const gpu::Scope scope(recorder, "tank_light");
    recorder.bind(light_pipeline_,
                  {{shared::kBindVoxelColors, gpu::sampled(volume.colors, nearest_)},
                   {shared::kBindLightMap, gpu::sampled(map_, linear_)},
                   {shared::kBindVoxelLight, gpu::read_write_stored(light)}},
                  step);
    recorder.dispatch_threads(light_pipeline_, glm::uint(volume.size.x), glm::uint(volume.size.y),
                              glm::uint(volume.size.z));
  }
}

}  // namespace brume::passes
