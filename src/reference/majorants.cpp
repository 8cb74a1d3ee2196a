#include "reference/majorants.hpp"

#include <algorithm>

namespace brume::reference {

Majorants::Majorants(const glm::mat4& world_from_voxel, const Box<int>& voxels, int cell)
    : voxel_from_world_(glm::inverse(world_from_voxel)), low_voxel_(voxels.low), cell_(cell) {
  const glm::i64vec3 width = glm::i64vec3(voxels.high) - glm::i64vec3(voxels.low);
  const auto cells = [&] { return (width + std::int64_t{cell_ - 1}) / std::int64_t{cell_}; };
  const auto count = [&] { return cells().x * cells().y * cells().z; };
  // Products of 32-bit widths at cells of 2^11 and more fit into 64 bits.
  while (glm::any(glm::greaterThan(cells(), glm::i64vec3(std::int64_t{1} << 20))) ||
         count() > static_cast<std::int64_t>(kMostCells))
    cell_ *= 2;
  size_ = glm::ivec3(cells());
  bounds_.assign(static_cast<std::size_t>(count()), 0.0f);
}

Box<int> Majorants::voxels_of(const glm::ivec3& cell) const {
  const glm::ivec3 low = low_voxel_ + cell * cell_;
  return {low, low + cell_};
}

float Majorants::largest() const {
  return bounds_.empty() ? 0 : *std::ranges::max_element(bounds_);
}

}  // namespace brume::reference
