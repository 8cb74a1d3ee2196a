// From metres to voxels in integers: where rays of the simulation go. No rounding decides anything here that
// another machine could round otherwise.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>

#include "voxel/bit_grid.hpp"

namespace brume::sim {

/// Positions of the simulation: 1/1024 m, in world axes.
using Position = glm::ivec3;
constexpr int kUnitsPerMetre = 1024;

/// Largest coordinate of a Position that the simulation takes, about 16 km.
constexpr int kMaxCoordinate = 1 << 24;

/// The nearest Position to a point. Coordinates that are out of the world become kMaxCoordinate + 1, or minus
/// that, those that are no number kMaxCoordinate + 1: no event takes such a position.
Position position_from_metres(glm::dvec3 metres);
glm::dvec3 metres_from_position(Position position);

/// A whole number at or above the square root: the length of a vector, rounded up.
std::uint64_t ceil_sqrt(std::uint64_t square);
/// |to - from| in units of 1/1024 m, rounded up.
std::uint64_t ceil_distance(Position from, Position to);

/// The voxels of a grid as the simulation measures them: 1/1024 of a voxel edge.
class VoxelRuler {
 public:
  /// Throws Error(bad_input) when the layout's voxel is not in [1/64, 64] m or its origin not within
  /// kMaxCoordinate.
  explicit VoxelRuler(const voxel::GridLayout& layout);
  /// The position in 1/1024 voxel, rounded down, for |position| <= kMaxCoordinate + 1.
  glm::i64vec3 subvoxel(Position position) const;
  /// A length of 1/1024 m in 1/1024 voxel, rounded down; at most 2^32 units long.
  std::int64_t subvoxels(std::int64_t length) const;
  /// The centre of a voxel, rounded down.
  Position centre(glm::ivec3 voxel) const;

 private:
  glm::i64vec3 origin_;  // 2^-30 m: exact for every float that a grid uses
  std::int64_t voxel_size_;
};

/// Fraction of the way along a ray, num / den, den > 0.
struct Fraction {
  std::int64_t num = 0, den = 1;
};

/// A voxel on a ray, and where the ray leaves it (at or beyond 1: past the second point).
struct WalkStep {
  glm::ivec3 voxel;
  Fraction exit;
};

/// Visits each voxel of the grid that the ray from `from` through `to` and on beyond it passes, in order,
/// until `visit` returns false or the ray is out of the grid. Where it runs exactly along an edge, x steps
/// before y, y before z. Nothing is visited when from = to lies outside; only its voxel when it lies inside.
void walk_ray(const voxel::BitGrid& grid, const VoxelRuler& ruler, Position from, Position to,
              const std::function<bool(const WalkStep&)>& visit);

/// Where a grenade thrown from `from` towards `at` goes off. The ray runs on beyond `at` to the first solid
/// voxel and the free voxel before it is taken; where nothing solid lies on the way, the voxel of `at`, or
/// the last one on the ray when `at` is outside the grid. A ray that starts in a solid voxel lands in the
/// free voxel nearest to it on the ray's side (not behind `from`), and only when there is none in the nearest
/// free one on any side. Nothing only when there is no free voxel within kLandingSearch voxels, or the ray
/// misses the grid.
constexpr int kLandingSearch = 64;
std::optional<glm::ivec3> landing_voxel(const voxel::BitGrid& grid, const VoxelRuler& ruler, Position from,
                                        Position at);
/// The same for metres, which are rounded to Positions first.
std::optional<glm::ivec3> landing_voxel(const voxel::BitGrid& grid, glm::vec3 from_world, glm::vec3 at_world);

/// The free voxel nearest to one, itself included, within kLandingSearch voxels; of equals the one with the
/// lowest index.
std::optional<glm::ivec3> nearest_free_voxel(const voxel::BitGrid& grid, glm::ivec3 voxel);

}  // namespace brume::sim
