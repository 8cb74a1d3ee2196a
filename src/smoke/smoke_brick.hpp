// Bits, blocks and texels of one brick of the smoke volume.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "shared/smoke_volume.h"

namespace brume::smoke {

/// One texel of the density channel.
struct Texel {
  std::uint8_t density = 0;  ///< R
  std::uint8_t free = 0;     ///< G: 255 in a free voxel, 0 in a solid one.
  bool operator==(const Texel&) const = default;
};

/// A bit for each voxel or cell of a brick, as in voxel::BitGrid: word z, bit x + 8 y.
using BrickBits = std::array<std::uint64_t, 8>;

/// Index of a voxel in its brick.
constexpr std::uint32_t local_voxel(glm::ivec3 v) {
  return static_cast<std::uint32_t>((v.x & 7) + 8 * (v.y & 7) + 64 * (v.z & 7));
}
constexpr std::uint32_t kVoxelsPerBrick = 512;

/// The densities of a brick's voxels, by local_voxel.
using BrickDensities = std::array<std::uint8_t, kVoxelsPerBrick>;

/// Which of a set's blocks are the eight of a brick, x + 2 y + 4 z; kNoBlock where it has none.
using BrickBlocks = std::array<std::uint32_t, 8>;
constexpr std::uint32_t kNoBlock = ~std::uint32_t{0};

/// Place of a block in its brick, as BrickBlocks counts.
constexpr std::size_t block_in_brick(glm::ivec3 block) {
  return static_cast<std::size_t>((block.x & 1) + 2 * (block.y & 1) + 4 * (block.z & 1));
}
/// Sets the voxels of one of the eight blocks: rows of four bits become parts of rows of eight.
constexpr void set_block(BrickBits& bits, std::size_t block, std::uint64_t mask) {
  const std::size_t shift = 4 * (block & 1) + 32 * (block >> 1 & 1);
  for (std::size_t z = 0; z < 4; ++z) {
    const std::uint64_t layer = mask >> (16 * z) & 0xffff;
    bits[4 * (block >> 2) + z] |=
        ((layer & 0xf) | (layer & 0xf0) << 4 | (layer & 0xf00) << 8 | (layer & 0xf000) << 12) << shift;
  }
}

}  // namespace brume::smoke
