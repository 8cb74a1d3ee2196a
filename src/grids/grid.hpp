// Volume grids as files hold them: sparse values with a transform and metadata. Nothing is resampled or
// rounded, so that a file that is read and written again holds the same voxels.
//
// Index space is OpenVDB's: voxel (i, j, k) is centred at (i, j, k) and reaches half a voxel to each side.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/box.hpp"
#include "core/error.hpp"

namespace brume::grids {

/// The numbers are the file format's (docs/reference/formats.md).
enum class ValueType : std::uint8_t {
  float32 = 1,
  float64 = 2,
  int32 = 3,
  int64 = 4,
  boolean = 5,  ///< One byte, 0 or 1.
  mask = 6,     ///< No value: a voxel is active or not.
  vec3f = 7,
  vec3d = 8,
  vec3i = 9,
};

/// Bytes of one value: 0 (mask) to kMaxValueBytes.
std::size_t bytes_of(ValueType type);
inline constexpr std::size_t kMaxValueBytes = 24;
/// "float32".
const char* name_of(ValueType type);

/// What a grid's values mean, as OpenVDB names it.
enum class GridClass : std::uint8_t { unknown = 0, level_set = 1, fog_volume = 2, staggered = 3 };
/// "fog volume".
const char* name_of(GridClass grid_class);

/// One value in the machine's byte order; bytes beyond its type's are 0.
using Value = std::array<std::byte, kMaxValueBytes>;

inline constexpr int kBrickEdge = 8;
inline constexpr std::size_t kBrickVoxels = 512;

/// 8^3 voxels at indices aligned to 8. Voxel (x, y, z) of it has the number x + 8 (y + 8 z).
struct Brick {
  glm::ivec3 origin{0};                   ///< Index of voxel 0.
  std::array<std::uint64_t, 8> active{};  ///< Bit x + 8 y of word z.
  bool is_active(std::size_t voxel) const { return (active[voxel / 64] >> (voxel % 64) & 1) != 0; }
};

/// A cube of one value: voxels of a region that a file does not store one by one.
struct Tile {
  glm::ivec3 origin{0};    ///< Index of its first voxel, aligned to its edge.
  std::uint32_t edge = 8;  ///< [voxels]: 8, 128 or 4096, OpenVDB's.
  bool active = false;
  Value value{};
};

/// A named value of a file or grid, typed as OpenVDB types it: "string", "float", "vec3i".
struct Metadata {
  std::string name, type;
  std::vector<std::byte>
      bytes;  ///< As OpenVDB stores the value: text without a terminator, numbers little-endian.
  bool operator==(const Metadata&) const = default;
};

struct Grid {
  std::string name;
  ValueType type = ValueType::float32;
  GridClass grid_class = GridClass::unknown;
  bool saved_as_half = false;  ///< Its file stores floats in half precision.
  /// Affine: from index space to the file's world.
  glm::dmat4 world_from_index{1};
  Value background{};  ///< Value of voxels outside of bricks and tiles, all inactive.
  std::vector<Metadata> metadata;
  std::vector<Brick> bricks;      ///< Rising by z, then y, then x of the origin; none twice.
  std::vector<std::byte> values;  ///< kBrickVoxels values per brick, also of inactive voxels.
  std::vector<Tile> tiles;        ///< In the same order; none overlaps another or a brick.

  /// The values of a brick.
  std::span<const std::byte> values_of(std::size_t brick) const {
    const std::size_t bytes = kBrickVoxels * bytes_of(type);
    return std::span(values).subspan(brick * bytes, bytes);
  }
};

/// The grids of a file and its own metadata.
struct GridFile {
  std::vector<Grid> grids;
  std::vector<Metadata> metadata;
};

/// Which grids of a file to read, by position. The grids that are given have only the origins of their
/// bricks, and their tiles.
using GridChoice = std::function<Result<std::vector<std::size_t>>(std::span<const Grid* const> grids)>;

/// A value as a number: vectors by their length, masks as 1.
double to_number(ValueType type, const std::byte* value);

/// Voxels that are active, tiles included.
std::uint64_t count_active(const Grid& grid);

/// Whether the number of an active voxel or tile is finite and above `value`.
bool any_above(const Grid& grid, double value);

/// Whether its values are distances to a surface, negative inside: by its class, or, where a program lost
/// that, by its values: both signs, none beyond the background, which is above 0.
bool is_level_set(const Grid& grid);

/// Around all active voxels, in index space: whole voxels, so that one voxel at 0 gives [-0.5, 0.5]. Empty
/// (low > high) without any.
Box<double> active_bounds(const Grid& grid);

/// Whether a voxel around a point of index space may be in a grid: its index fits 32 bits, with room to add.
inline bool may_hold(const glm::dvec3& p_index) {
  return glm::all(glm::lessThan(glm::abs(p_index), glm::dvec3(1 << 30)));
}

/// Bytes that its bricks, values and tiles take.
std::uint64_t memory_of(const Grid& grid);

/// Whether `a` goes before `b` in Grid::bricks and Grid::tiles.
bool goes_before(glm::ivec3 a, glm::ivec3 b);

/// The brick of an origin; nullopt: none.
std::optional<std::size_t> find_brick(const Grid& grid, glm::ivec3 origin);

/// A cube of active voxels that have one value.
struct ActiveValue {
  const std::byte* value;  ///< A value of the grid's type.
  glm::ivec3 low;          ///< Its voxel of the least coordinates.
  std::uint32_t edge;      ///< [voxels]: 1, or a tile's edge.
  std::uint64_t count() const { return std::uint64_t{edge} * edge * edge; }
};

/// Calls use(active value) for the active voxels of bricks, then for active tiles, in the order of the grid.
/// Where it returns a bool, false ends the walk. True if nothing ended it.
template <typename Use>
bool for_each_active(const Grid& grid, const Use& use) {
  const auto goes_on = [&](const ActiveValue& value) {
    if constexpr (std::same_as<decltype(use(value)), bool>) {
      return use(value);
    } else {
      use(value);
      return true;
    }
  };
  const std::size_t bytes = bytes_of(grid.type);
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    const Brick& brick = grid.bricks[i];
    const std::byte* const values = grid.values_of(i).data();
    for (std::size_t z = 0; z < brick.active.size(); ++z)
      for (std::uint64_t word = brick.active[z]; word != 0; word &= word - 1) {
        const int in_layer = std::countr_zero(word);
        const std::size_t voxel = z * 64 + static_cast<std::size_t>(in_layer);
        const glm::ivec3 local(in_layer & 7, in_layer >> 3, static_cast<int>(z));
        if (!goes_on({values + voxel * bytes, brick.origin + local, 1})) return false;
      }
  }
  for (const Tile& tile : grid.tiles)
    if (tile.active && !goes_on({tile.value.data(), tile.origin, tile.edge})) return false;
  return true;
}

}  // namespace brume::grids
