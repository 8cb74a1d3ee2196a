#include "shared/hole.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/state.hpp"
#include "smoke/holes.hpp"
#include "tests/smoke/hole_pairs.hpp"

namespace brume::smoke {
namespace {

using glm::vec2, glm::vec3;
using shared::Hole, shared::hole_strength;

TEST(Hole, EqualsTheModelInDoubleAt1000PointsAndTimes) {
  const HolePairs questions = make_hole_pairs(1000, 5);
  int removed[3] = {}, partly[3] = {};
  int sharp = 0;
  for (std::size_t i = 0; i < questions.pairs.size(); ++i) {
    const HolePair& q = questions.pairs[i];
    const float strength = hole_strength_masked(q.hole, q.p_world, q.time, q.rim, questions.atlas);
    const reference::StrengthRange allowed = questions.allowed(i);
    EXPECT_GE(strength, allowed.low) << "pair " << i;
    EXPECT_LE(strength, allowed.high) << "pair " << i;
    sharp += allowed.high - allowed.low < 0.004;
    removed[q.hole.shape] += strength > 0;
    partly[q.hole.shape] += strength > 0 && strength < 1;
  }
  // The pairs do meet the holes, and their changes.
  for (int shape = 0; shape < 3; ++shape) {
    EXPECT_GT(removed[shape], 80);
    EXPECT_GT(partly[shape], 40);
  }
  // All but a few, at the ends of a hole or at the edge of a mask, allow next to nothing.
  EXPECT_GE(sharp, 995);
}

Hole plain_hole() {
  Hole h{};
  h.forward = vec3(0, 0, 1);
  h.right = vec3(-1, 0, 0);
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
  Hole h = plain_hole();
  for (const shared::uint shape : {shared::kHoleCylinder, shared::kHoleBox, shared::kHoleMask}) {
    h.shape = shape;
    EXPECT_EQ(hole_strength(h, vec3(0, 0, -0.01f), 0.6f, 0), 0);
    EXPECT_EQ(hole_strength(h, vec3(0, 0, 10.01f), 0.6f, 0), 0);
    EXPECT_EQ(hole_strength(h, vec3(0, 0, 0), 0.6f, 0), 1);
    EXPECT_EQ(hole_strength(h, vec3(0, 0, 10), 0.6f, 0), 1);
  }
}

TEST(Hole, OpensWithTheFrontStaysAndCloses) {
  Hole h = plain_hole();
  const vec3 middle(0, 0, 5);
  for (const shared::uint shape : {shared::kHoleCylinder, shared::kHoleBox, shared::kHoleMask}) {
    h.shape = shape;
    EXPECT_EQ(hole_strength(h, middle, 0.124f, 0), 0);  // the front is there at 0.125
    EXPECT_EQ(hole_strength(h, middle, 0.18f, 0), 1);
    EXPECT_EQ(hole_strength(h, middle, 1.17f, 0), 1);
    const float closing = hole_strength(h, middle, 1.35f, 0);
    EXPECT_NEAR(closing, 0.5f, 1e-3f);
    EXPECT_EQ(hole_strength(h, middle, 1.53f, 0), 0);
  }
}

TEST(Hole, WithNoLengthOrTimesIsNotANumberNowhere) {
  Hole h = plain_hole();
  h.distance_to_far = h.time_to_reach_far = h.time_to_expand = h.time_to_stay_open = h.time_to_fade = 0;
  for (const shared::uint shape : {shared::kHoleCylinder, shared::kHoleBox, shared::kHoleMask}) {
    h.shape = shape;
    for (const float time : {-1.0f, 0.0f, 1e-7f, 1.0f}) {
      const float strength = hole_strength(h, vec3(0), time, 0);
      EXPECT_GE(strength, 0);
      EXPECT_LE(strength, 1);
    }
  }
}

TEST(Hole, IsAsWideInTheNoiseOfItsRim) {
  Hole h = plain_hole();
  for (const shared::uint shape : {shared::kHoleCylinder, shared::kHoleBox, shared::kHoleMask}) {
    h.shape = shape;
    EXPECT_EQ(hole_strength(h, vec3(0.55f, 0, 5), 0.5f, 0), 0);
    EXPECT_GT(hole_strength(h, vec3(0.55f, 0, 5), 0.5f, 0.1f), 0);
    EXPECT_EQ(hole_strength(h, vec3(0.45f, 0, 5), 0.5f, -0.1f), 0);
    EXPECT_EQ(hole_strength(h, vec3(0), 0.5f, -0.6f), 0) << "no radius remains";
  }
}

// Black but for its top left quarter.
Mask quarter() {
  Mask mask{16, 16, std::vector<std::uint8_t>(256, 0)};
  for (std::uint32_t y = 0; y < 8; ++y)
    for (std::uint32_t x = 0; x < 8; ++x) mask.texels[y * 16 + x] = 255;
  return mask;
}

sim::BulletHole mask_shot(glm::ivec3 from, glm::ivec3 toward, std::uint32_t roll) {
  sim::BulletHole open;
  open.shot.origin = from;
  open.shot.toward = toward;
  open.shot.radius = 1024;
  open.shot.shape = sim::HoleShape::mask;
  open.shot.roll = roll;
  open.distance = 10 * 1024;
  return open;
}

TEST(Hole, ShowsItsMaskUprightFromTheShooterMirroredFromBehind) {
  const MaskAtlas atlas =
      MaskAtlas::pack(std::vector<Mask>{{3, 3, std::vector<std::uint8_t>(9)}, quarter()}).value_or_throw();
  sim::State state;
  state.masks = atlas.key();
  // From every side, level, up and down: the smoke to the shooter's left and above is gone.
  for (const glm::ivec3 way : {glm::ivec3(0, 0, -1),
                               {0, 0, 1},
                               {1, 0, 0},
                               {-3, 0, 2},
                               {2, 1, 2},
                               {1, -4, 1},
                               {0, 1, 0},
                               {0, -1, 0}}) {
    sim::BulletHole open =
        mask_shot(glm::ivec3(700, 5000, -300), glm::ivec3(700, 5000, -300) + 2000 * way, 0);
    open.shot.mask = 1;
    state.holes = {open};
    const Hole hole = make_holes(state, &atlas)[0];
    const vec3 forward = glm::normalize(vec3(way));
    const vec3 up_world = std::abs(forward.y) < 0.999f ? vec3(0, 1, 0) : vec3(0, 0, 1);
    const vec3 right = glm::normalize(glm::cross(forward, up_world)), up = glm::cross(right, forward);
    const auto at = [&](float x, float y) {
      return hole_strength_masked(hole, hole.origin_world + 5.0f * forward + x * right + y * up, 0.7f, 0,
                                  atlas);
    };
    EXPECT_EQ(at(-0.5f, 0.5f), 1);
    EXPECT_EQ(at(0.5f, 0.5f), 0);
    EXPECT_EQ(at(-0.5f, -0.5f), 0);
    EXPECT_EQ(at(0.5f, -0.5f), 0);
    EXPECT_EQ(at(-0.98f, 0.98f), 1);
    EXPECT_EQ(at(-1.02f, 0.98f), 0);
    EXPECT_NEAR(at(0, 0.5f), 0.5f, 1e-4f);
    // The same points from behind, where right is left: the mirror image follows from the definition.
    const vec3 right_behind = -right;
    EXPECT_EQ(hole_strength_masked(hole, hole.origin_world + 5.0f * forward + 0.5f * right_behind + 0.5f * up,
                                   0.7f, 0, atlas),
              1);
  }
}

TEST(Hole, RollsClockwiseAsTheShooterSeesIt) {
  const MaskAtlas atlas = MaskAtlas::pack(std::vector<Mask>{quarter()}).value_or_throw();
  sim::State state;
  state.masks = atlas.key();
  for (std::uint32_t roll = 0; roll < sim::kFullTurn; roll += 911) {
    state.holes = {mask_shot(glm::ivec3(0), glm::ivec3(0, 0, -1024), roll)};
    const Hole hole = make_holes(state, &atlas)[0];
    const double angle = 2 * 3.14159265358979 * roll / sim::kFullTurn;
    // The top, seen along -z: from up to the right.
    EXPECT_NEAR(hole.up.x, std::sin(angle), 1e-7);
    EXPECT_NEAR(hole.up.y, std::cos(angle), 1e-7);
    EXPECT_NEAR(hole.right.x, std::cos(angle), 1e-7);
    EXPECT_NEAR(hole.right.y, -std::sin(angle), 1e-7);
    // The white quarter is now at the top left turned.
    const double x = -0.5 * std::cos(angle) + 0.5 * std::sin(angle),
                 y = 0.5 * std::sin(angle) + 0.5 * std::cos(angle);
    EXPECT_EQ(hole_strength_masked(hole, vec3(x, y, -5), 0.7f, 0, atlas), 1) << roll;
    EXPECT_EQ(hole_strength_masked(hole, vec3(-x, -y, -5), 0.7f, 0, atlas), 0) << roll;
  }
}

TEST(Hole, OfAMaskNeedsTheMasksOfItsState) {
  const MaskAtlas atlas = MaskAtlas::pack(std::vector<Mask>{quarter()}).value_or_throw();
  sim::State state;
  state.masks = {1, atlas.key().hash + 1};
  const sim::BulletHole open = mask_shot(glm::ivec3(0), glm::ivec3(0, 0, -1024), 0);
  state.holes = {open};
  EXPECT_THROW(make_holes(state, &atlas), Error);
  EXPECT_THROW(make_holes(state), Error);
  EXPECT_EQ(make_hole(open, state).shape, shared::kHoleMask) << "its axis does not depend on masks";
  state.holes[0].shot.shape = sim::HoleShape::cylinder;
  EXPECT_EQ(make_holes(state)[0].shape, shared::kHoleCylinder);
}

}  // namespace
}  // namespace brume::smoke
