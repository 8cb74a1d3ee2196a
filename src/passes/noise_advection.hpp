// Advection of the smoke's noise, and the atlases that rays from the eye and to lights read.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "passes/smoke_upload.hpp"
#include "planning/noise_motion.hpp"
#include "shared/noise_advection.h"
#include "sim/state.hpp"

namespace brume::passes {

/// Growth of each cloud, brick by brick, in the layout of shared/noise_advection.h. Computed when a cloud
/// appears, dropped when it disappears.
class CloudGrowth {
 public:
  /// Follows the clouds of a state and the slots of a volume; true when the list of parts changed.
  bool update(const sim::State& state, const smoke::SmokeVolume& volume);

  /// Per slot (first, count), then the list.
  std::span<const glm::uvec2> parts() const { return parts_; }
  /// kDisplacementsPerBrick entries per part.
  std::span<const glm::uvec2> displacements() const { return displacements_; }
  /// Parts added since the last clear_new_parts.
  std::span<const std::uint32_t> new_parts() const { return new_parts_; }
  void clear_new_parts() { new_parts_.clear(); }

 private:
  struct BrickPart {
    glm::ivec3 brick;
    std::uint32_t part;
  };
  std::vector<BrickPart> make_parts(const sim::Cloud& cloud, float voxel_size);
  std::uint32_t allocate_part();

  void list_parts(const smoke::SmokeVolume& volume);

  std::vector<std::shared_ptr<const sim::Cloud>> clouds_;  // of the last state
  std::map<const sim::Cloud*, std::vector<BrickPart>> parts_of_cloud_;
  std::vector<glm::uvec2> parts_, displacements_;
  std::vector<std::uint32_t> free_parts_, new_parts_;
  std::uint64_t generation_ = 0;
};

class NoiseAdvectionPass {
 public:
  explicit NoiseAdvectionPass(gpu::Context& context);

  struct Inputs {
    const gpu::Buffer& frame;
    const SmokeResources& smoke;
    const gpu::Image& noise;
  };
  /// Makes room for the clouds of a state, whose noise is planned. When SmokeUpload::reserve may be called,
  /// with the same volume.
  void reserve(const sim::State& state, const smoke::SmokeVolume& volume, const planning::NoisePlan& plan);
  /// Uploads the reserved plan.
  void upload(gpu::Recorder& recorder, const planning::NoisePlan& plan);
  /// Fills smoke.density_displacement (shaders/shared/smoke_volume.h; the noise at a point is that of point +
  /// GBA) and smoke.filtered_density for the slots of the reserved plan.
  void record(gpu::Recorder& recorder, const planning::NoisePlan& plan, const Inputs& inputs);

 private:
  gpu::Context& context_;
  gpu::ComputePipeline pipeline_;
  gpu::Sampler linear_, repeat_;
  CloudGrowth growth_;
  gpu::Buffer slots_due_;
  gpu::Buffer parts_, displacements_, motions_, impulses_;
  bool parts_stale_ = true, displacements_stale_ = true;
};

}  // namespace brume::passes
