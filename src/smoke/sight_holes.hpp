// The fraction of the smoke that holes leave along a ray (shared/hole.h, without the noise of their rims).
//
// Along a ray the strength of a hole is smooth but for a few points: where the ray enters its edge or its
// middle, where it passes from one texel of a mask to the next, and where the hole begins to open or to close
// at that depth. All of them are roots of polynomials of degree one or two. Between them, quadrature of a
// fixed order is accurate.
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
  float nearest;               ///< t at which the ray is nearest to its axis;
  float x, x_step, y, y_step;  ///< across it: x + x_step (t - nearest).
  float age, age_step;         ///< How long it has been opening: age + age_step t [s].
  float radius, expand, stay_end, fade;
  MaskView mask;  ///< Of a box whose cross-section is an image.
  bool box;
  bool steady;  ///< Wide open and not yet closing, from begin to end.
  float radius_at(float t) const;
  enum class Takes { nothing, part, all };
  /// What it removes around t, where no texel begins: nothing where its mask is black or ends, all where it
  /// is wide open and its mask white, or within its core.
  Takes takes(float t) const;
  /// Strength of the hole at four t between begin and end.
  Float4 strength(Float4 t) const;

 private:
  Float4 mask_strength(Float4 px, Float4 py, Float4 wide, Float4 open) const;
};

/// A part of the ray along which no hole's strength has a kink.
struct HolePiece {
  float begin, end;
  bool gone;  ///< A hole removes all of the smoke.
};

/// The holes that a ray passes through. Reused from ray to ray only for its memory.
struct HolesOnRay {
  std::vector<RayHole> holes;
  std::vector<HolePiece> pieces;  ///< In order of t; between them no hole is.
  std::vector<float> breaks;
  /// Fraction of the smoke that remains at four t of a piece.
  Float4 remaining(const HolePiece& piece, Float4 t) const;
};

/// The holes that are open anywhere at one time.
class HoleSet {
 public:
  /// `masks` must outlive it and hold the rectangles of all holes that are masks.
  HoleSet(std::span<const shared::Hole> holes, float time, const MaskAtlas* masks);
  bool empty() const { return holes_.empty(); }
  /// Finds those that the points origin_world + t step_world enter for t in [0, t_end].
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
  float farthest_ = 0;  // of the holes from reference_ [m]
};

}  // namespace brume::smoke
