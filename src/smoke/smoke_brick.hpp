// One brick of the smoke volume: what it shows, and what that is made from.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "shared/smoke_volume.h"
#include "volume/range_arena.hpp"
#include "sim/state.hpp"

namespace brume::smoke {

/// One texel of the density texture.
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

/// Ticks from `first` to `last`; none when first > last.
struct TickSpan {
  std::uint32_t first = 1, last = 0;
};

/// A cloud as the volume last saw it.
struct SmokeSource {
  std::uint32_t id = 0;
  std::shared_ptr<const sim::Cloud> cloud;
  sim::CloudPhase phase;
  std::vector<std::uint8_t> densities;       ///< By rank, at that phase; empty before the first.
  std::vector<std::uint32_t> slot_of_block;  ///< For each block of its voxels.
  std::vector<std::uint32_t> slots;          ///< Every slot that it needs, each once.
  TickSpan steady;                           ///< When its phase is known not to change.
};

/// A blast as the volume last saw it.
struct SmokeSink {
  std::uint32_t id = 0;
  std::shared_ptr<const sim::BlastField> field;
  sim::BlastProfile profile{};
  std::vector<glm::ivec3> bricks;  ///< Where it reaches, each once.
};

struct CloudPart {
  const SmokeSource* source;
  BrickBlocks blocks;
};
struct BlastPart {
  const SmokeSink* sink;
  BrickBlocks blocks;
};

/// Where a boundary corner takes its density from: a voxel of the volume, slot * kVoxelsPerBrick +
/// local_voxel, or with this bit a mean of its brick.
constexpr std::uint32_t kMeanBit = 1u << 31;

/// A mean of voxels: the sum of weight * density, divided by total, rounded; voxels
/// that smoke never reaches count in the total only.
struct SmokeMean {
  std::uint32_t first;  ///< Of its voxels and weights.
  std::uint16_t count, total;
  std::uint16_t cell;  ///< The first cell, by local index, that has it: all it takes from is around that.
};
/// A corner set that smoke can reach.
struct CornerSource {
  std::array<std::uint32_t, 8> corners;
  std::uint32_t first_set;  ///< Of its cell, in the brick.
  std::uint16_t cell;       ///< Local index of its cell.
  std::uint8_t sides;       ///< Bit q: the cell's set q has these corners.
};

/// The boundary cells of a brick, by rising local index.
struct BrickCells {
  std::vector<std::uint16_t> cells;           ///< Local index of each: x + 8 y + 64 z.
  std::vector<shared::BoundaryCell> records;  ///< first_set counted within the brick
  std::vector<SmokeMean> means;
  std::vector<std::uint32_t> mean_voxels;  ///< What the means take from, as of a corner,
  std::vector<std::uint8_t> mean_weights;  ///< and how much.
  std::vector<CornerSource> sources;
  std::uint32_t set_count = 0;

  std::vector<std::uint8_t> mean_values{0};  ///< Of means[i] at i + 1; 0 at 0: no smoke.
  volume::IndexRange cell_range, set_range;          ///< In the volume's boundary cells and corner sets.
};

struct SmokeBrick {
  bool live = false;
  glm::ivec3 at{0};          ///< voxel / 8
  std::uint32_t needed = 0;  ///< Clouds that have a voxel within two of the brick.
  std::vector<CloudPart> clouds;
  std::vector<BlastPart> blasts;  ///< By id.
  BrickBits smoke{};              ///< Voxels that a cloud has at some tick.
  std::array<Texel, shared::kTexelsPerBrick> texels{};
  std::unique_ptr<std::array<std::uint32_t, shared::kCellsPerBrick>> cells;  ///< null: all 0
  std::unique_ptr<BrickCells> home;                                          ///< null: no boundary cell

  // What the update going on has to do, and did.
  bool touched = false, fresh = false;
  bool masks_stale = false, walls_stale = false, cells_stale = false, densities_stale = false;
  bool texels_changed = false, cells_changed = false, home_changed = false;
  volume::IndexRange sets_changed;  ///< Of home->set_range, counted in the brick.
  BrickBits changed{};      ///< Voxels whose density the update changed.
  BrickBits stale_cells{};  ///< Boundary cells around them.
};

}  // namespace brume::smoke
