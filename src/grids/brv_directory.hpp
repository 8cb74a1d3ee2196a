// The directory of a .brv file: everything but the values and active masks of its bricks
// (docs/reference/formats.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "grids/limits.hpp"

namespace brume::grids {

inline constexpr std::uint32_t kMaxBricksPerChunk = 4096;

/// A run of bricks that is compressed and checked as one.
struct BrvChunk {
  std::uint64_t offset = 0;        ///< In the file.
  std::uint32_t stored_bytes = 0;  ///< There.
  std::uint64_t checksum = 0;      ///< XXH3-64 of the stored bytes.
};

/// A grid of a file whose chunks are not read.
struct BrvGrid {
  Grid grid;  ///< Its bricks have their origins only, and no values.
  std::uint32_t bricks_per_chunk = 1;
  std::vector<BrvChunk> chunks;  ///< Number i holds bricks from i bricks_per_chunk on.

  std::size_t first_brick(std::size_t chunk) const { return chunk * bricks_per_chunk; }
  std::size_t brick_count(std::size_t chunk) const {
    return std::min<std::size_t>(bricks_per_chunk, grid.bricks.size() - first_brick(chunk));
  }
};

struct BrvDirectory {
  std::vector<BrvGrid> grids;
  std::vector<Metadata> metadata;  ///< What belongs to the file, not to a grid.
};

/// Bytes of a brick before compression: its mask and its values.
std::size_t raw_brick_bytes(ValueType type);

/// The failure of a file that is damaged.
Failure damaged_brv(const std::string& what);

std::vector<std::byte> encode_brv_directory(const BrvDirectory& directory);

/// Reads a directory whose chunks fill the file from `chunks_begin` to `chunks_end`. Every count is checked
/// against the bytes that remain and the limits before memory is allocated for it, every grid as check_grid
/// does.
Result<BrvDirectory> decode_brv_directory(std::span<const std::byte> bytes, std::uint64_t chunks_begin,
                                          std::uint64_t chunks_end, const GridLimits& limits);

}  // namespace brume::grids
