// Grids for tests, of every type, with all that a file may hold.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grids/grid.hpp"

namespace brume::grids {

inline constexpr ValueType kAllTypes[] = {ValueType::float32, ValueType::float64, ValueType::int32,
                                          ValueType::int64,   ValueType::boolean, ValueType::mask,
                                          ValueType::vec3f,   ValueType::vec3d,   ValueType::vec3i};

/// A grid of random bricks and tiles of every edge, around the origin and far from it, with inactive voxels
/// and tiles whose values differ from the background. Floats are any bits, NaN included.
Grid random_grid(ValueType type, std::uint32_t seed, std::size_t bricks = 12);

/// A ball of smoke, as simulations save it: half precision, a fog volume.
Grid smoke_grid(const std::string& name, int radius);

/// The bricks of a grid with indices from 0 on: near the origin, they share the nodes of a tree.
Grid octant(const Grid& grid);

/// One tile of 4096^3 active voxels: a .vdb file of some hundred bytes.
Grid huge_tile();

/// Metadata of every type that OpenVDB has a name for here, and of one that it has not.
std::vector<Metadata> sample_metadata();

/// Fails the test unless all is the same, bit for bit, other than metadata that writers of .vdb files derive
/// ("file_...").
void expect_same(const Grid& a, const Grid& b);
void expect_same(const GridFile& a, const GridFile& b);

}  // namespace brume::grids
