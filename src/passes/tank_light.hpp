// Light in the voxels of a painted tank.
#pragma once

#include <optional>
#include <span>

#include "gpu/recorder.hpp"
#include "passes/sphere_voxels.hpp"
#include "scene/tank_scene.hpp"
#include "shared/tank_light.h"

namespace brume::passes {

class TankLightPass {
 public:
  explicit TankLightPass(gpu::Context& context);

  /// Makes room for the maps of lights. Call outside of a recording. Throws resource_limit.
  void reserve(const TankVolume& volume, std::span<const shared::TankLight> lights,
               scene::TankLighting lighting);
  /// Finds the light of all voxels with a colour: `ambient`, and what each light brings that reaches them; in
  /// `light`, a word per voxel (shared::pack_rgb9e5). reserve() was given the lights.
  void record(gpu::Recorder& recorder, const TankVolume& volume, const gpu::Image& light,
              const glm::vec3& ambient);

 private:
  gpu::Context& context_;
  gpu::ComputePipeline map_pipeline_, light_pipeline_;
  gpu::Sampler nearest_, linear_;
  gpu::Image map_;
  std::vector<shared::TankLightParams> steps_;  ///< A map each.
};

/// An image for the light of a tank's voxels. Throws resource_limit.
gpu::Image make_voxel_light(gpu::Context& context, const glm::uvec3& size);

}  // namespace brume::passes
