// Line of sight: how much smoke is between two points at a tick, with its holes, and whether a wall is.
//
// The optical depth of a segment is the integral of extinction * density * (1 - strength of hole 1) * (1 -
// strength of hole 2)... along it, matching the rendered image without its noise. Density is read as the
// shaders read it (docs/how/smoke.md) and integrated exactly; along holes by quadrature, with an error of
// at most 0.3 %.
//
// Results are the same bits for the same volume, holes and points: on every machine, for any number of
// threads, and for one segment alone or among many. Points may lie outside of the grid, where there is air.
// Points that are not finite, or farther than kMaxSightMetres from the origin of the world, are failures
// (bad_input), and no result is written.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "core/error.hpp"
#include "shared/hole.h"
#include "smoke/sight_holes.hpp"
#include "smoke/smoke_volume.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::smoke {

class DrawnSmoke;
struct SmokeRay;

/// Largest coordinate of a point [m], as in a Position.
constexpr float kMaxSightMetres = 16384;

struct SightSettings {
  float extinction = 3;           ///< Where density is 1 (255 steps) [1/m], [0, 10^6].
  glm::vec3 smoke_albedo{0.92f};  ///< What sensors report of the smoke.
  /// The masks that make_holes was given; must outlive the Sight. Required where a hole is a mask.
  const MaskAtlas* masks = nullptr;
  /// The smoke as it is drawn, whose optical depths take a hundred times as long. Must outlive the Sight and
  /// have the same volume; brings holes and time of its own. Null: smoke without its noise.
  const DrawnSmoke* drawn = nullptr;
};

struct Segment {
  glm::vec3 a_world{0}, b_world{0};
};

/// A solid voxel along a segment.
struct SightWall {
  glm::ivec3 voxel{0};
  glm::ivec3 normal{0};  ///< Outward normal of the face that the ray enters; 0 where it starts inside.
  float distance = 0;    ///< From the first point to that face [m].
};

/// A ray of an RGB-D camera.
struct SensorRay {
  glm::vec3 origin_world{0};
  glm::vec3 direction_world{0, 0, -1};  ///< Any length but 0.
  float max_distance = 100;             ///< [m], (0, 2 kMaxSightMetres].
};

struct SensorSample {
  float distance = 0;                ///< To the first solid voxel, else max_distance [m].
  std::optional<SightWall> surface;  ///< Where the ray ends; none up to max_distance.
  float optical_depth = 0;           ///< Depth of the smoke up to there, which transmits exp(-optical_depth).
  glm::vec3 surface_albedo{0};       ///< Black where there is no surface.
  glm::vec3 smoke_albedo{0};
};

/// Colour of a surface as a sensor reports it. Called from several threads at once.
using SurfaceAlbedo = std::function<glm::vec3(const SightWall&)>;

class Sight {
 public:
  /// The smoke of `volume` with `holes` at a time on their clock (State::seconds, make_holes), the walls of
  /// `level`: what stops sight, voxel::Solids::sight. Volume and level must be of the same tick, and
  /// stay as they are while the Sight is used. Throws Error (bad_input) for an extinction out of range, a
  /// time that is not finite, or a hole that is a mask where there are none.
  Sight(const SmokeVolume& volume, const voxel::BitGrid& level, std::span<const shared::Hole> holes,
        float time, const SightSettings& settings = {});

  /// Optical depth between two points, whatever walls are between them. 0 where both are the same.
  Result<float> optical_depth(glm::vec3 a_world, glm::vec3 b_world) const;
  /// The same for many, over all threads. `out` is as long as `segments`.
  Result<void> optical_depths(std::span<const Segment> segments, std::span<float> out) const;

  /// Whether b is visible from a: no solid voxel between them, and an optical depth of at most `threshold`
  /// (at least 0; infinity: walls only). The solid voxels that a and b lie in do not hide them: a
  /// player who leans against a wall is in its voxel. Faster than the depth: it ends at the first obstacle.
  Result<bool> visible(glm::vec3 a_world, glm::vec3 b_world, float threshold) const;
  /// The same for many: 1 where visible, else 0.
  Result<void> visible(std::span<const Segment> segments, float threshold, std::span<std::uint8_t> out) const;

  /// The first solid voxel between a and b, other than those in which a and b lie.
  Result<std::optional<SightWall>> first_wall(glm::vec3 a_world, glm::vec3 b_world) const;

  /// What a depth camera with colour measures. The voxel in which the ray starts does not count as a surface.
  Result<SensorSample> sense(const SensorRay& ray, const SurfaceAlbedo& albedo) const;
  Result<void> sense(std::span<const SensorRay> rays, const SurfaceAlbedo& albedo,
                     std::span<SensorSample> out) const;

 private:
  std::size_t grain() const;
  std::optional<SmokeRay> smoke_ray(glm::dvec3 a_world, glm::dvec3 b_world, HolesOnRay& holes) const;
  float depth(glm::dvec3 a_world, glm::dvec3 b_world, float enough, HolesOnRay& scratch) const;
  /// depth() of many lines into `out`, in packets. `line(i)` returns the ends of line i, or nothing for a
  /// depth of 0.
  template <typename Line>
  void depths(const Line& line, float enough, std::span<float> out) const;
  bool is_visible(const Segment& segment, float threshold, HolesOnRay& scratch) const;
  /// All but the optical depth.
  SensorSample surface_sample(const SensorRay& ray, const SurfaceAlbedo& albedo) const;
  std::optional<SightWall> wall(glm::dvec3 a_world, glm::dvec3 b_world, bool b_hides) const;

  const SmokeVolume& volume_;
  const voxel::BitGrid& level_;
  HoleSet holes_;
  SightSettings settings_;
};

}  // namespace brume::smoke
