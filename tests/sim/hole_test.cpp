#include "shared/hole.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace brume::shared {
namespace {

/// The life of a hole told in words of its own, in double: where the front is, how wide the hole is at the
/// depth of the point, how much it has faded.
double reference_strength(const Hole& h, glm::dvec3 p, double time, double rim) {
  const glm::dvec3 d = p - glm::dvec3(h.origin_world);
  const double z = glm::dot(d, glm::dvec3(h.forward));
  if (z < 0 || z > h.distance_to_far) return 0;
  const double since_shot = time - h.time_start;
  const double front_metres = since_shot / h.time_to_reach_far * h.distance_to_far;
  if (front_metres <= z) return 0;

  const double opens_at = z / h.distance_to_far * h.time_to_reach_far;
  const double wide_at = opens_at + h.time_to_expand;
  const double closes_at = wide_at + h.time_to_stay_open;
  const double closed_at = closes_at + h.time_to_fade;
  double width = 1, fade = 1;
  if (since_shot < wide_at) width = (since_shot - opens_at) / h.time_to_expand;
  if (since_shot > closes_at) width = fade = (closed_at - since_shot) / h.time_to_fade;
  if (since_shot >= closed_at) return 0;

  const double radius = (h.radius + rim) * width;
  const double x = glm::dot(d, glm::dvec3(h.right)), y = glm::dot(d, glm::dvec3(h.up));
  const double r = h.shape == kHoleBox ? std::fmax(std::abs(x), std::abs(y)) : std::hypot(x, y);
  if (r >= radius) return 0;
  const double t = std::fmin(1, (radius - r) / (radius * double{kHoleSoftShare}));
  return t * t * (3 - 2 * t) * fade;
}

Hole random_hole(std::mt19937& random) {
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> share(0, 1);
  Hole h{};
  h.origin_world = vec3(normal(random), normal(random), normal(random)) * 5.0f;
  h.forward = normalize(vec3(normal(random), normal(random), normal(random)));
  h.right = normalize(cross(h.forward, std::abs(h.forward.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  h.up = cross(h.right, h.forward);
  h.radius = 0.1f + share(random);
  h.distance_to_far = 1 + 20 * share(random);
  h.time_start = 3 * share(random);
  h.time_to_reach_far = 0.25f;
  h.time_to_expand = 0.05f;
  h.time_to_stay_open = share(random);
  h.time_to_fade = 0.35f;
  h.shape = random() % 2;
  return h;
}

TEST(Hole, EqualsTheModelInDoubleAt1000PointsAndTimes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> share(0, 1);
  int removed = 0, partly = 0;
  for (int i = 0; i < 1000; ++i) {
    const Hole h = random_hole(random);
    const float reach = h.radius;
    const vec3 p = h.origin_world + h.forward * (h.distance_to_far * (1.1f * share(random) - 0.05f)) +
                   h.right * (reach * (2 * share(random) - 1)) + h.up * (reach * (2 * share(random) - 1));
    const float time = h.time_start + 1.6f * share(random);
    const float rim = 0.1f * h.radius * (2 * share(random) - 1);
    const float strength = hole_strength(h, p, time, rim);
    const double expected = reference_strength(h, glm::dvec3(p), time, rim);
    // Positions carry 2^-24 of about 40 m, times of 5 s: 1e-5 of the smallest soft edge (0.04 m) and of the
    // smallest time (0.05 s), and the steepest part of both.
    EXPECT_NEAR(strength, expected, 1e-3) << "pair " << i;
    removed += strength > 0;
    partly += strength > 0 && strength < 1;
  }
  // The pairs do meet the hole, and its changes.
  EXPECT_GT(removed, 200);
  EXPECT_GT(partly, 100);
}

Hole plain_hole() {
  Hole h{};
  h.forward = vec3(0, 0, 1);
  h.right = vec3(1, 0, 0);
  h.up = vec3(0, 1, 0);
  h.radius = 0.5f;
  h.distance_to_far = 10;
  h.time_to_reach_far = 0.25f;
  h.time_to_expand = 0.05f;
  h.time_to_stay_open = 1;
  h.time_to_fade = 0.35f;
  return h;
}

TEST(Hole, DoesNothingBeforeTheMuzzleOrBeyondFar) {
  const Hole h = plain_hole();
  EXPECT_EQ(hole_strength(h, vec3(0, 0, -0.01f), 0.6f, 0), 0);
  EXPECT_EQ(hole_strength(h, vec3(0, 0, 10.01f), 0.6f, 0), 0);
  EXPECT_EQ(hole_strength(h, vec3(0, 0, 0), 0.6f, 0), 1);
  EXPECT_EQ(hole_strength(h, vec3(0, 0, 10), 0.6f, 0), 1);
}

TEST(Hole, OpensWithTheFrontStaysAndCloses) {
  const Hole h = plain_hole();
  const vec3 middle(0, 0, 5);
  EXPECT_EQ(hole_strength(h, middle, 0.124f, 0), 0);  // the front is there at 0.125
  EXPECT_EQ(hole_strength(h, middle, 0.18f, 0), 1);
  EXPECT_EQ(hole_strength(h, middle, 1.17f, 0), 1);
  const float closing = hole_strength(h, middle, 1.35f, 0);
  EXPECT_NEAR(closing, 0.5f, 1e-3f);
  EXPECT_EQ(hole_strength(h, middle, 1.53f, 0), 0);
}

TEST(Hole, WithNoLengthOrTimesIsNotANumberNowhere) {
  Hole h = plain_hole();
  h.distance_to_far = h.time_to_reach_far = h.time_to_expand = h.time_to_stay_open = h.time_to_fade = 0;
  for (const float time : {-1.0f, 0.0f, 1e-7f, 1.0f}) {
    const float strength = hole_strength(h, vec3(0), time, 0);
    EXPECT_GE(strength, 0);
    EXPECT_LE(strength, 1);
  }
}

}  // namespace
}  // namespace brume::shared
