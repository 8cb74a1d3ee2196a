// The fraction of the smoke that holes leave along a ray (shared/hole.h, without the noise of their rims).
//
// Along a ray the strength of a hole is smooth but for a few points: where the ray enters its edge or its
// middle, where it passes from one texel of a mask to the next, and where the hole begins to open or to close
// at that depth. All of them are roots of polynomials of degree one or two. Between them, quadrature of a
// fixed order is accurate. Masks are walked cell by cell; one step crosses all cells around that are as black
// or as white.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/float4.hpp"
#include "shared/hole.h"
#include "smoke/mask_atlas.hpp"

namespace brume::smoke {

/// One hole along a ray: everything that varies is linear in the ray's t.
struct RayHole {
  float begin, end;            ///< Where it can remove anything.
  float nearest;               ///< t at which the ray is nearest to its axis.
  float x, x_step, y, y_step;  ///< Place across the axis: x + x_step (t - nearest).
  float age, age_step;         ///< How long it has been opening: age + age_step t [s].
  float radius, expand, stay_end, fade;
  MaskView mask;  ///< Cross-section of a box whose shape is an image.
  bool box;
  bool steady;  ///< Wide open and not yet closing, from begin to end.

  float radius_at(float t) const;
  bool closing_at(float t) const { return !steady && age + age_step * t > stay_end; }
};

/// A part of a ray in which one hole removes something, and along which its strength has no kink.
struct HoleSegment {
  float begin, end;
  std::uint32_t hole;  ///< In HolesOnRay::holes.
  bool all;            ///< It removes all of the smoke.
  glm::ivec2 cell{0};  ///< Where in its mask it lies.
};

/// A part of the ray along which no hole's strength has a kink.
struct HolePiece {
  float begin, end;
  bool gone;                   ///< A hole removes all of the smoke.
  std::uint32_t first, count;  ///< Range in HolesOnRay::members: the holes that remove a part.
};

/// The holes that a ray passes through. Reused from ray to ray only for its memory.
struct HolesOnRay {
  std::vector<RayHole> holes;
  std::vector<HoleSegment> segments;   ///< Hole by hole, each in order of t.
  std::vector<HolePiece> pieces;       ///< In order of t; there is no hole between them.
  std::vector<std::uint32_t> members;  ///< Numbers of segments.
  /// Allocates memory for what a ray usually meets.
  void reserve();
  /// Fraction of the smoke that remains at four t of a piece.
  Float4 remaining(const HolePiece& piece, Float4 t) const;

  // Used while the pieces are made.
  struct Cursor {
    float change;                 ///< Where its segment begins, or ends when inside.
    std::uint32_t segment, last;  ///< The current segment of a hole; one past its last.
    bool inside, all;             ///< In the segment, which removes all.
    void advance(const HoleSegment* of_rays);
  };
  std::vector<Cursor> cursors;                 // one for each hole that has segments
  std::vector<std::uint32_t> waiting, active;  // cursors: all by their first begin; those that have begun
  std::vector<float> breaks;
};

/// The holes that are open anywhere at one time.
class HoleSet {
 public:
  /// `masks` must outlive it and hold the rectangles of all holes that are masks.
  HoleSet(std::span<const shared::Hole> holes, float time, const MaskAtlas* masks);
  bool empty() const { return holes_.empty(); }
  /// Finds the holes that the points origin_world + t step_world enter for t in [0, t_end].
  void find(glm::vec3 origin_world, glm::vec3 step_world, float t_end, HolesOnRay& out) const;

 private:
  struct ActiveHole {
    shared::Hole hole;
    float age, age_per_metre;  // how long it has been opening at depth z: age - age_per_metre z
    float near, far;           // depths between which it is open [m]
    MaskView mask;
  };
  // Four holes' axes as lines, lane by lane: directions, and their moments about reference_.
  struct Group {
    Float4 forward_x, forward_y, forward_z, moment_x, moment_y, moment_z, reach_squared;
  };
  void add(const ActiveHole& open, glm::vec3 origin_world, glm::vec3 step_world, float t_end,
           HolesOnRay& out) const;

  std::vector<ActiveHole> holes_;
  std::vector<Group> groups_;
  glm::vec3 reference_{0};
  float farthest_ = 0;  // largest coordinate of a hole from reference_ [m]
};

}  // namespace brume::smoke
