// Growth of the clouds of a state in the bricks of a volume: what the advection of the noise reads.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "shared/noise_advection.h"
#include "sim/state.hpp"
#include "smoke/smoke_bricks.hpp"

namespace brume::smoke {

/// The points of one part.
using PartDisplacements = std::span<const glm::uvec2, shared::kDisplacementsPerBrick>;

/// Growth of each cloud, brick by brick, in the layout of shared/noise_advection.h. Computed when a cloud
/// gets its first brick in the volume, dropped when it disappears. Coarse bricks have none.
class CloudGrowth {
 public:
  /// Follows the clouds of a state and the slots of a volume; true when the list of parts changed.
  bool update(const sim::State& state, const SmokeBricks& volume);

  /// Per slot (first, count), then the list.
  std::span<const glm::uvec2> parts() const { return parts_; }
  /// kDisplacementsPerBrick entries per part.
  std::span<const glm::uvec2> displacements() const { return displacements_; }
  PartDisplacements displacements(std::uint32_t part) const {
    return displacements()
        .subspan(std::size_t{part} * shared::kDisplacementsPerBrick)
        .first<shared::kDisplacementsPerBrick>();
  }
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

  static bool touches(const SmokeBricks& volume, const sim::Cloud& cloud);
  void list_parts(const SmokeBricks& volume);

  std::vector<std::shared_ptr<const sim::Cloud>> clouds_;  // in the last state
  std::map<const sim::Cloud*, std::vector<BrickPart>> parts_of_cloud_;
  std::vector<glm::uvec2> parts_, displacements_;
  std::vector<std::uint32_t> free_parts_, new_parts_;
  std::uint64_t volume_ = 0, generation_ = 0;
};

}  // namespace brume::smoke
