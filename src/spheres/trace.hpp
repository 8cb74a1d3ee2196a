// Rays through the exact spheres of a tank, on the CPU.
//
// A ray visits the voxels that it crosses (shared/dda.h, in floats; bricks without spheres in one step) and
// intersects the spheres of their ids in double precision. Where the DDA might take two planes in the wrong
// order by rounding, it visits the voxels of both orders, so that no sphere is missed
// (docs/how/path-tracer.md derives the bound): a loop over all spheres has the same result.
//
// Rays: points are origin_voxel + t * direction, in voxels of the tank, |coordinates| at most 2^20, any
// direction but 0. One that is not finite meets nothing.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "spheres/brick_lists.hpp"
#include "spheres/ids.hpp"
#include "spheres/tank.hpp"

namespace brume::spheres {

/// A tank and what rays read of it, made of the same tank; all must outlive the view.
struct TankView {
  const Tank& tank;
  const BrickLists& bricks;
  const VoxelIds& ids;
};

/// Where a ray is in a sphere.
struct Chord {
  double enter = 0, leave = 0;  ///< t, enter < leave.
  std::uint32_t id = 0;
};

/// t at which a line enters and leaves a sphere, also below 0 (the stable form of shared::sphere_chord, in
/// double); nullopt: it misses, or touches in one point.
std::optional<glm::dvec2> chord_of(const Sphere& sphere, const glm::dvec3& origin,
                                   const glm::dvec3& direction);

struct SphereHit {
  double t = 0;
  std::uint32_t id = 0;
  glm::dvec3 normal{0};  ///< Outwards, of length 1.
};

inline constexpr float kNoEnd = std::numeric_limits<float>::infinity();

/// The sphere that the ray enters first, at t in [0, t_max], opaque or not; of two at one t the lower id. A
/// sphere that contains the origin is not entered. nullopt: none.
std::optional<SphereHit> first_hit(const TankView& view, const glm::vec3& origin_voxel,
                                   const glm::vec3& direction, float t_max = kNoEnd);

/// Calls visit(chord) for each sphere that the ray crosses in [0, t_max], in the order of entering, until it
/// returns false. The chord's ends are clamped to [0, t_max]: a ray that begins inside of a sphere enters it
/// at 0.
void visit_chords(const TankView& view, const glm::vec3& origin_voxel, const glm::vec3& direction,
                  float t_max, const std::function<bool(const Chord&)>& visit);

/// The fraction of light that passes from the ray's origin to t_max: 0 where an opaque sphere is in between
/// or around the origin, else exp(-extinction * length) of each sphere.
double transmittance(const TankView& view, const glm::vec3& origin_voxel, const glm::vec3& direction,
                     float t_max);

}  // namespace brume::spheres
