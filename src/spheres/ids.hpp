// Which spheres touch each voxel of a tank: up to four ids, nearest first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "shared/spheres.h"
#include "spheres/brick_lists.hpp"
#include "spheres/tank.hpp"

namespace brume::spheres {

/// Ids of the spheres that touch each voxel's cube (shared::sphere_touches), nearest first by
/// shared::sphere_power of the voxel's middle, at equal power the lower id first; 0 behind the last. Where
/// more than shared::kVoxelIds touch it: {0, 1, 0, 0}, and all spheres of the voxel's brick are candidates.
class VoxelIds {
 public:
  VoxelIds() = default;
  /// Room for the ids of a tank of `size` with `spheres` spheres, not initialized.
  VoxelIds(const glm::uvec3& size, std::size_t spheres);

  const glm::uvec3& size() const { return size_; }
  /// Two for at most shared::kMostShortIds spheres (shared::pack_short_ids), else four.
  std::size_t words_per_voxel() const { return words_per_voxel_; }
  /// The ids as a device reads them: voxel (0, 0, 0) first, x fastest.
  std::span<const std::uint32_t> words() const { return {words_.get(), count_}; }
  std::span<std::uint32_t> words() { return {words_.get(), count_}; }
  /// The ids at a voxel inside of the tank.
  glm::uvec4 at(const glm::ivec3& voxel) const;
  void set(const glm::ivec3& voxel, const glm::uvec4& ids);

 private:
  std::size_t first_word(const glm::ivec3& voxel) const {
    return ((std::size_t(voxel.z) * size_.y + std::size_t(voxel.y)) * size_.x + std::size_t(voxel.x)) *
           words_per_voxel_;
  }

  glm::uvec3 size_{0};
  std::size_t words_per_voxel_ = 2;
  std::size_t count_ = 0;  // number of words
  // An array, since a vector would write all of it twice, at first on one core.
  std::unique_ptr<std::uint32_t[]> words_;
};

/// On all cores; the same for any number of threads. `lists` belong to the tank.
VoxelIds make_ids(const Tank& tank, const BrickLists& lists);

inline glm::uvec4 VoxelIds::at(const glm::ivec3& voxel) const {
  const std::uint32_t* w = words_.get() + first_word(voxel);
  return words_per_voxel_ == 2 ? shared::unpack_short_ids({w[0], w[1]}) : glm::uvec4(w[0], w[1], w[2], w[3]);
}

inline void VoxelIds::set(const glm::ivec3& voxel, const glm::uvec4& ids) {
  std::uint32_t* w = words_.get() + first_word(voxel);
  if (words_per_voxel_ == 2) {
    const glm::uvec2 packed_ids = shared::pack_short_ids(ids);
    w[0] = packed_ids.x;
    w[1] = packed_ids.y;
  } else {
    for (int i = 0; i < 4; ++i) w[i] = ids[i];
  }
}

}  // namespace brume::spheres
