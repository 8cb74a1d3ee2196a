// Holes for tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "shared/hole.h"

namespace brume::planning {

/// Shots of all kinds through a box around the origin, from anywhere.
inline std::vector<shared::Hole> random_holes(std::size_t count, std::uint32_t seed, float reach) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> one(-1, 1);
  const auto point = [&] { return reach * glm::vec3(one(random), one(random), one(random)); };
  std::vector<shared::Hole> holes(count);
  for (shared::Hole& hole : holes) {
    hole.origin_world = point();
    hole.forward = glm::normalize(point() - hole.origin_world + glm::vec3(0, 0, 1e-3f));
    const glm::vec3 helper = std::abs(hole.forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    hole.right = glm::normalize(glm::cross(hole.forward, helper));
    hole.up = glm::cross(hole.right, hole.forward);
    hole.radius = 0.02f + 0.3f * std::abs(one(random));
    hole.distance_to_far = 0.1f + 2 * reach * std::abs(one(random));
    hole.time_start = std::abs(one(random));
    hole.time_to_reach_far = one(random) > 0 ? 0.5f * std::abs(one(random)) : 0.0f;
    hole.time_to_expand = 0.1f * std::abs(one(random));
    hole.time_to_stay_open = std::abs(one(random));
    hole.time_to_fade = 0.5f * std::abs(one(random));
    hole.shape = one(random) > 0 ? shared::kHoleBox : shared::kHoleCylinder;
  }
  return holes;
}

}  // namespace brume::planning
