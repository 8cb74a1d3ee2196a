#include "reference/majorants.hpp"

#include <cmath>

namespace brume::reference {

Majorants::Majorants(const glm::mat4& world_from_voxel, const Box<int>& voxels, int cell)
    : voxel_from_world_(glm::inverse(world_from_voxel)),
      world_from_voxel_(world_from_voxel),
      low_voxel_(voxels.low),
      cell_(cell) {
  const glm::i64vec3 width = glm::i64vec3(voxels.high) - glm::i64vec3(voxels.low);
  const auto cells = [&] { return (width + std::int64_t{cell_ - 1}) / std::int64_t{cell_}; };
  const auto count = [&] { return cells().x * cells().y * cells().z; };
  // Products of 32-bit widths at cells of 2^11 and more fit into 64 bits.
  while (glm::any(glm::greaterThan(cells(), glm::i64vec3(std::int64_t{1} << 20))) ||
         count() > static_cast<std::int64_t>(kMostCells))
    cell_ *= 2;
  size_ = glm::ivec3(cells());
  const float edge = static_cast<float>(cell_);
  cell_volume_ = edge * edge * edge * std::abs(glm::determinant(glm::mat3(world_from_voxel)));
  bounds_.assign(static_cast<std::size_t>(count()), 0.0f);
}

std::optional<std::uint32_t> Majorants::cell_at(const glm::vec3& p_world) const {
  const glm::vec3 at = (voxel_from_world(p_world) - glm::vec3(low_voxel_)) / static_cast<float>(cell_);
  if (glm::any(glm::lessThan(at, glm::vec3(0))) || glm::any(glm::greaterThanEqual(at, glm::vec3(size_))))
    return std::nullopt;
  return static_cast<std::uint32_t>(index(glm::min(glm::ivec3(at), size_ - 1)));
}

glm::vec3 Majorants::world_point(std::uint32_t cell, const glm::vec3& at) const {
  const glm::vec3 voxel = glm::vec3(low_voxel_) + static_cast<float>(cell_) * (glm::vec3(place(cell)) + at);
  return glm::vec3(world_from_voxel_ * glm::vec4(voxel, 1));
}

}  // namespace brume::reference
