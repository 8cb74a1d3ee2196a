// What reading and writing .nvdb files have in common: the nodes of a tree, and what else we store with a
// grid.
#pragma once

#include <nanovdb/NanoVDB.h>

#include <cstdint>

#include "core/error.hpp"
#include "grids/grid.hpp"

namespace brume::vdb {

/// The plain data of the nodes of a tree of one type, from the root to the leaves of 8^3 voxels.
template <typename Build>
struct Nodes {
  using Root = typename nanovdb::NanoRoot<Build>::DataType;
  using RootTile = typename Root::Tile;
  using Upper = typename nanovdb::NanoUpper<Build>::DataType;
  using Lower = typename nanovdb::NanoLower<Build>::DataType;
  using Leaf = typename nanovdb::NanoLeaf<Build>::DataType;
};

/// Entries along an edge of a node, as a power of two; and voxels along the edge of its children.
inline constexpr int kUpperBits = 5, kLowerBits = 4, kLeafBits = 3;
inline constexpr int kUpperEdge = 4096, kLowerEdge = 128, kLeafEdge = 8;

/// The grid types of OpenVDB hold more than NanoVDB's. The rest goes into blind data of this name, which
/// other programs skip:
///
///   class                 u8, of grids::GridClass
///   saved as half         u8, 0 or 1
///   metadata of the grid  as grids::write_metadata
///   metadata of the file  the same; in its first grid
inline constexpr const char* kExtraName = "brume metadata";

/// Index of the first voxel of entry n of a node: entries and voxels are numbered from z to x.
inline glm::ivec3 entry_of(std::uint32_t n, int bits) {
  const auto mask = (1u << bits) - 1;
  return {static_cast<int>(n >> (2 * bits)), static_cast<int>(n >> bits & mask), static_cast<int>(n & mask)};
}

inline std::uint32_t entry_number(glm::ivec3 entry, int bits) {
  return static_cast<std::uint32_t>((entry.x << (2 * bits)) | (entry.y << bits) | entry.z);
}

}  // namespace brume::vdb
