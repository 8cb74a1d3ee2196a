#include "voxel/level_hash.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "core/hash.hpp"

namespace brume::voxel {
namespace {

/// One brick as it is hashed: its coordinates, then the words of the three grids.
using BrickWords = std::array<std::uint64_t, 1 + 3 * kBrickSize>;

std::uint64_t hash_layout(const GridLayout& layout) {
  std::array<std::uint32_t, 7> words{};
  for (int axis = 0; axis < 3; ++axis) {
    words[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(layout.size[axis]);
    words[static_cast<std::size_t>(3 + axis)] = std::bit_cast<std::uint32_t>(layout.origin_world[axis]);
  }
  words[6] = std::bit_cast<std::uint32_t>(layout.voxel_size);
  return hash_values(std::span<const std::uint32_t>(words));
}

std::uint64_t hash_voxels(const Solids& level, std::uint64_t hash) {
  // Every solid voxel stops bodies. A brick that has become empty stays allocated, and does not count.
  level.bodies.for_each_brick([&](glm::ivec3 at, const BitGrid::Brick& bodies) {
    if (bodies == BitGrid::Brick{}) return;
    BrickWords words{};
    const glm::u64vec3 place(at);
    words[0] = place.x | place.y << 16 | place.z << 32;
    auto next = words.begin() + 1;
    for (const BitGrid* grid : {&level.smoke, &level.sight, &level.bodies}) {
      const BitGrid::Brick* brick = grid == &level.bodies ? &bodies : grid->find_brick(at);
      if (brick) std::copy(brick->begin(), brick->end(), next);
      next += kBrickSize;
    }
    hash = hash_values(std::span<const std::uint64_t>(words), hash);
  });
  return hash;
}

std::uint64_t hash_planes(const SurfacePlanes& planes, std::uint64_t hash) {
  hash = hash_values(planes.keys(), hash);
  std::array<std::uint8_t, 4096> counts{};
  for (std::size_t first = 0; first < planes.keys().size(); first += counts.size()) {
    const std::size_t size = std::min(counts.size(), planes.keys().size() - first);
    for (std::size_t i = 0; i < size; ++i) counts[i] = static_cast<std::uint8_t>(planes.count(first + i));
    hash = hash_values(std::span<const std::uint8_t>(counts).first(size), hash);
  }
  static_assert(sizeof(Plane) == 4 * sizeof(float), "no padding");
  return hash_bytes(std::as_bytes(planes.planes()), hash);
}

}  // namespace

std::uint64_t level_hash(const Solids& level, const SurfacePlanes& planes) {
  const std::uint64_t hash = hash_planes(planes, hash_voxels(level, hash_layout(level.smoke.layout())));
  return hash == 0 ? 1 : hash;
}

}  // namespace brume::voxel
