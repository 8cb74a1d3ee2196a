// The smoke along a straight line, integrated cell by cell.
//
// Between the centres of eight voxels density is trilinear, so that along a line it is a polynomial of degree
// three: two points of Gauss and Legendre integrate it exactly. Where planes run through a cell, the line is
// cut at them, and each part takes the corner set of its side (docs/how/smoke.md).
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "core/float4.hpp"
#include "smoke/sight_holes.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::smoke {

/// The part of a line in which there can be smoke. Its points are cell + at + t direction for t in [0,
/// length], in voxels, counted so that the cell between the centres of voxels v - 1 and v is v.
struct SmokeRay {
  glm::ivec3 cell{0};
  Float4 at{};         ///< In [0, 1); lane 3: 0.
  Float4 direction{};  ///< Unit length; lane 3: 0.
  float length = 0;
  double skipped = 0;  ///< How far from the line's first point it begins [voxels].
};

/// None when the line from `a` to `b` (voxel space, finite) passes no smoke.
std::optional<SmokeRay> clip_to_smoke(const shared::VolumeLayout& layout, glm::dvec3 a, glm::dvec3 b);

/// Integral over the ray of density [0, 1] times the fraction that the holes leave [voxels]. `holes` in the
/// ray's t, null for none. Once the integral is above `enough` it may stop: the result is then only known to
/// be above `enough`.
float smoke_on_ray(const SmokeVolume& volume, const SmokeRay& ray, const HolesOnRay* holes, float enough);

}  // namespace brume::smoke
