// Holes of all shapes, points and times to test them at, and the strengths that floats may give.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "tests/reference/hole.hpp"

namespace brume::smoke {

/// One question; as the shader of the passes' tests reads it.
/// With gaps as hole_probe.comp has them.
struct alignas(16) HolePair {
  shared::Hole hole;
  glm::vec3 p_world;
  float time;
  float rim;
};

struct HolePairs {
  std::vector<Mask> masks;
  MaskAtlas atlas;
  std::vector<HolePair> pairs;
  std::vector<std::uint32_t> mask_of;  // of each pair; 0 where its hole is none

  /// What a computation in floats may answer to pair i.
  reference::StrengthRange allowed(std::size_t i) const {
    const HolePair& q = pairs[i];
    constexpr double kUlp = 0x1p-23;  // of 1; what a GPU's own additions and products may be off by
    // Positions: the point itself, the difference, three products and two sums of a dot product, the rim.
    const double metres = kUlp * (double{glm::length(q.p_world)} +
                                  4 * double{glm::length(q.p_world - q.hole.origin_world)} + 3);
    // Times: two differences, the share of the depth and its product, the sum of the times it stays open.
    const double seconds = kUlp * (4 * std::abs(double{q.time}) + 4);
    reference::StrengthRange range = reference::strengths_within(q.hole, glm::dvec3(q.p_world), q.time, q.rim,
                                                                 &masks[mask_of[i]], metres, seconds);
    // Where in the atlas: three roundings of 1, in texels; neighbours differ by 1 at most, along both axes.
    // Then some ten roundings of numbers up to 1 / kHoleSoftFraction, by a slope of 1.5.
    const double slack = 2 * 3 * kUlp * std::max(atlas.width(), atlas.height()) + 10 * 2.5 * 1.5 * kUlp;
    return {range.low - slack, range.high + slack};
  }
};

inline shared::Hole random_hole(std::mt19937& random) {
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> share(0, 1);
  const auto vector = [&] {
    const float x = normal(random), y = normal(random), z = normal(random);
    return glm::vec3(x, y, z);
  };
  shared::Hole h{};
  h.origin_world = vector() * 5.0f;
  h.forward = glm::normalize(vector());
  h.right = glm::normalize(glm::cross(h.forward, vector()));  // any roll
  h.up = glm::cross(h.right, h.forward);
  h.radius = 0.1f + share(random);
  h.distance_to_far = 1 + 20 * share(random);
  h.time_start = 3 * share(random);
  h.time_to_reach_far = 0.25f;
  h.time_to_expand = 0.05f;
  h.time_to_stay_open = share(random);
  h.time_to_fade = 0.35f;
  return h;
}

inline HolePairs make_hole_pairs(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0, 1);
  HolePairs result;
  for (const auto& [width, height] : {std::pair{9u, 9u}, {64u, 64u}, {33u, 17u}, {1u, 7u}}) {
    Mask mask{width, height, {}};
    for (std::uint32_t i = 0; i < width * height; ++i)
      mask.texels.push_back(static_cast<std::uint8_t>(random() & 255));
    result.masks.push_back(std::move(mask));
  }
  result.atlas = MaskAtlas::pack(result.masks).value_or_throw();
  for (std::size_t i = 0; i < count; ++i) {
    HolePair q{random_hole(random), {}, 0, 0};
    q.hole.shape = static_cast<shared::uint>(i % 3);
    const auto mask = static_cast<std::uint32_t>(i / 3 % result.masks.size());
    q.hole.uv_min = result.atlas.rectangle(mask).uv_min;
    q.hole.uv_max = result.atlas.rectangle(mask).uv_max;
    float x = 2 * share(random) - 1, y = 2 * share(random) - 1, z = 1.1f * share(random) - 0.05f;
    if (i % 10 == 7) x = y = 0;  // on the axis
    q.p_world = q.hole.origin_world + q.hole.forward * (q.hole.distance_to_far * z) +
                q.hole.radius * (x * q.hole.right + y * q.hole.up);
    // Every fifth while the hole opens or closes there.
    q.time = q.hole.time_start + 1.6f * share(random);
    const float front = q.hole.time_start + z * q.hole.time_to_reach_far;
    if (i % 5 == 0) q.time = front + q.hole.time_to_expand * share(random);
    if (i % 5 == 1)
      q.time = front + q.hole.time_to_expand + q.hole.time_to_stay_open + q.hole.time_to_fade * share(random);
    q.rim = 0.1f * q.hole.radius * (2 * share(random) - 1);
    result.pairs.push_back(q);
    result.mask_of.push_back(mask);
  }
  return result;
}

}  // namespace brume::smoke
