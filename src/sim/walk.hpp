// From metres to voxels in integers: the ray walk of the simulation. Nothing here depends on rounding that
// could differ between machines.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>

#include "voxel/bit_grid.hpp"

namespace brume::sim {

/// A position of the simulation: 1/1024 m, in world axes.
using Position = glm::ivec3;
constexpr int kUnitsPerMetre = 1024;

/// Largest absolute coordinate of a Position that the simulation accepts: 16384 m.
constexpr int kMaxCoordinate = 1 << 24;

/// The nearest Position to a point. Coordinates outside the world become +-(kMaxCoordinate + 1), NaN becomes
/// kMaxCoordinate + 1; events reject such positions.
Position position_from_metres(glm::dvec3 metres);
glm::dvec3 metres_from_position(Position position);

/// The square root, rounded up.
std::uint64_t ceil_sqrt(std::uint64_t square);
/// |to - from| in units of 1/1024 m, rounded up.
std::uint64_t ceil_distance(Position from, Position to);

/// Converts between positions and the voxels of a grid, in subvoxels of 1/1024 voxel edge.
class VoxelRuler {
 public:
  /// Throws Error(bad_input) when the layout's voxel size is outside [1/64, 64] m or its origin beyond
  /// kMaxCoordinate.
  explicit VoxelRuler(const voxel::GridLayout& layout);
  /// The position in 1/1024 voxel, rounded down, for |position| <= kMaxCoordinate + 1.
  glm::i64vec3 subvoxel(Position position) const;
  /// Converts a length in 1/1024 m, at most 2^32 units, to 1/1024 voxel, rounded down.
  std::int64_t subvoxels(std::int64_t length) const;
  /// The centre of a voxel, rounded down.
  Position centre(glm::ivec3 voxel) const;

 private:
  glm::i64vec3 origin_;  // 2^-30 m: exact for every float a grid uses
  std::int64_t voxel_size_;
};

/// Fraction num / den of a ray from its first point to its second, den > 0.
struct Fraction {
  std::int64_t num = 0, den = 1;
};

/// A voxel on a ray, and where the ray exits it (1 or more: at or beyond the second point).
struct WalkStep {
  glm::ivec3 voxel;
  Fraction exit;
};

/// Visits in order each voxel of the grid on the ray from `from` through `to` and beyond, until `visit`
/// returns false or the ray leaves the grid. Where the ray runs exactly along an edge, x steps before y, y
/// before z. When from = to, visits only its voxel, or nothing if that is outside the grid.
void walk_ray(const voxel::BitGrid& grid, const VoxelRuler& ruler, Position from, Position to,
              const std::function<bool(const WalkStep&)>& visit);

/// The voxel where a grenade thrown from `from` towards `at` detonates. The ray continues beyond `at` to the
/// first solid voxel; the result is the free voxel before it. Without a solid voxel on the ray: the voxel of
/// `at`, or the last one on the ray when `at` is outside the grid. A ray that starts in a solid voxel lands
/// in the nearest free voxel on the ray's side (not behind `from`), or failing that in the nearest on any
/// side. Nothing only when there is no free voxel within kLandingSearch voxels, or the ray misses the grid.
constexpr int kLandingSearch = 64;
std::optional<glm::ivec3> landing_voxel(const voxel::BitGrid& grid, const VoxelRuler& ruler, Position from,
                                        Position at);
/// The same in metres, rounded to Positions first.
std::optional<glm::ivec3> landing_voxel(const voxel::BitGrid& grid, glm::vec3 from_world, glm::vec3 at_world);

/// The nearest free voxel, possibly the voxel itself, within kLandingSearch voxels; ties go to the lowest
/// index.
std::optional<glm::ivec3> nearest_free_voxel(const voxel::BitGrid& grid, glm::ivec3 voxel);

}  // namespace brume::sim
