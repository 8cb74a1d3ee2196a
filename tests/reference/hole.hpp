// The density that a hole removes, in double precision by definition: the local frame of the shot, the life
// of the hole at a depth, the image of its cross-section texel by texel.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "shared/hole.h"
#include "smoke/mask_atlas.hpp"

namespace brume::reference {

/// An image at u to the right and v down, each from 0 to 1: linear between the centres of its texels, and
/// beyond the outermost what they are. [0, 1].
inline double mask_at(const smoke::Mask& mask, double u, double v) {
  double sum = 0;
  for (std::uint32_t y = 0; y < mask.height; ++y)
    for (std::uint32_t x = 0; x < mask.width; ++x) {
      const double right = std::clamp(u * mask.width - 0.5, 0.0, mask.width - 1.0);
      const double down = std::clamp(v * mask.height - 0.5, 0.0, mask.height - 1.0);
      const double weight = std::fmax(0, 1 - std::abs(right - x)) * std::fmax(0, 1 - std::abs(down - y));
      sum += weight * mask.texels[std::size_t{y} * mask.width + x] / 255;
    }
  return sum;
}

/// `mask`: the image of a mask hole.
inline double hole_strength(const shared::Hole& h, glm::dvec3 p, double time, double rim,
                            const smoke::Mask* mask = nullptr) {
  const glm::dmat3 world_from_hole(glm::dvec3(h.right), glm::dvec3(h.up), glm::dvec3(h.forward));
  const glm::dvec3 local = glm::transpose(world_from_hole) * (p - glm::dvec3(h.origin_world));
  if (local.z < 0 || local.z > h.distance_to_far) return 0;

  // The front comes by, the hole grows, stays, closes.
  const double since_shot = time - h.time_start;
  const double opens_at = local.z / h.distance_to_far * h.time_to_reach_far;
  const double wide_at = opens_at + h.time_to_expand;
  const double closes_at = wide_at + h.time_to_stay_open;
  const double closed_at = closes_at + h.time_to_fade;
  if (since_shot <= opens_at || since_shot >= closed_at) return 0;
  double width = 1, fade = 1;
  if (since_shot < wide_at) width = (since_shot - opens_at) / h.time_to_expand;
  if (since_shot > closes_at) width = fade = (closed_at - since_shot) / h.time_to_fade;

  const double radius = (h.radius + rim) * width;
  if (h.shape == shared::kHoleMask) {
    if (std::fmax(std::abs(local.x), std::abs(local.y)) >= radius) return 0;
    // -1..1 across becomes 0..1; the image's first row is on top.
    return mask_at(*mask, 0.5 + 0.5 * local.x / radius, 1 - (0.5 + 0.5 * local.y / radius)) * fade;
  }
  const double from_axis = h.shape == shared::kHoleBox ? std::fmax(std::abs(local.x), std::abs(local.y))
                                                       : std::hypot(local.x, local.y);
  if (from_axis >= radius) return 0;
  const double t = std::fmin(1, (radius - from_axis) / (radius * double{shared::kHoleSoftFraction}));
  return t * t * (3 - 2 * t) * fade;
}

struct StrengthRange {
  double low = 1, high = 0;
};

/// The strengths at the point and at those up to `metres` away along each axis of the hole, at times up to
/// `seconds` apart: the possible results of a computation with that error in point and time.
inline StrengthRange strengths_within(const shared::Hole& h, glm::dvec3 p, double time, double rim,
                                      const smoke::Mask* mask, double metres, double seconds) {
  StrengthRange range;
  for (int i = 0; i < 81; ++i) {
    const glm::dvec3 off(i % 3 - 1, i / 3 % 3 - 1, i / 9 % 3 - 1);
    const glm::dvec3 aside =
        metres * (off.x * glm::dvec3(h.right) + off.y * glm::dvec3(h.up) + off.z * glm::dvec3(h.forward));
    const double strength = hole_strength(h, p + aside, time + (i / 27 - 1) * seconds, rim, mask);
    range.low = std::fmin(range.low, strength);
    range.high = std::fmax(range.high, strength);
  }
  return range;
}

}  // namespace brume::reference
