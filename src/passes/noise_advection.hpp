// Advection of the smoke's noise, and the atlases that rays from the eye and to lights read.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "planning/noise_updates.hpp"
#include "passes/smoke_upload.hpp"
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
  /// Parts added since the last forget_new.
  std::span<const std::uint32_t> new_parts() const { return new_parts_; }
  void forget_new() { new_parts_.clear(); }

 private:
  struct Share {
    glm::ivec3 brick;
    std::uint32_t part;
  };
  std::vector<Share> make_shares(const sim::Cloud& cloud, float voxel_size);
  std::uint32_t take_part();

  void list_parts(const smoke::SmokeVolume& volume);

  std::vector<std::shared_ptr<const sim::Cloud>> clouds_;  // of the last state
  std::map<const sim::Cloud*, std::vector<Share>> shares_;
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
    const sim::State& state;  ///< Whose clouds, shots, bodies and blasts; as reserve saw it.
    double seconds = 0;       ///< On the clock of the state.
    double swirl_period = 1;  ///< That a roll takes.
  };
  /// Makes room for the clouds. As SmokeUpload::reserve, and after it.
  void reserve(const sim::State& state, const smoke::SmokeVolume& volume);
  /// Chooses the bricks of the next record by turns; every record in a row must have its own. After
  /// `reserve`, outside of a recording. False: none has a turn.
  bool schedule(const sim::State& state, const smoke::SmokeVolume& volume, const planning::SmokeVisibility& needs,
                 const shared::SmokeLook& look, double seconds, double swirl_period);
  /// Fills smoke.density_displacement (shaders/shared/smoke_volume.h; the noise at a point is that of point + GBA) and
  /// smoke.filtered_density for the needed slots. Depends on the inputs alone; after `schedule`, which fills only those
  /// that have a turn, on the frames before.
  void record(gpu::Recorder& recorder, const Inputs& inputs);

 private:
  void upload(gpu::Recorder& recorder, const Inputs& inputs, std::span<const shared::Impulse> impulses);

  gpu::Context& context_;
  gpu::ComputePipeline pipeline_;
  gpu::Sampler linear_, repeat_;
  CloudGrowth growth_;
  planning::NoiseUpdates turns_;
  std::optional<std::span<const std::uint32_t>> due_;  // of the next record
  gpu::Buffer due_slots_;
  gpu::Buffer parts_, displacements_, motions_, impulses_;
  bool parts_stale_ = true, displacements_stale_ = true;
};

}  // namespace brume::passes
