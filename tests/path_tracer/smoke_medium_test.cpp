// Smoke as a medium: its density against double precision, and its bounds.
#include "reference/smoke_medium.hpp"

#include <random>

#include "planning/frame_input.hpp"
#include "tests/path_tracer/statistics.hpp"
#include "tests/reference/hole.hpp"
#include "tests/reference/smoke_integral.hpp"
#include "tests/smoke/sight_scene.hpp"

namespace brume::reference {
namespace {

class SmokeMediumTest : public testing::TestWithParam<std::uint32_t> {
 protected:
  SmokeMediumTest() : scene_(GetParam(), 9) {
    input_.volume = &scene_.volume();
    input_.state = &scene_.state();
    input_.holes = scene_.holes();
    input_.time = scene_.time();
    input_.look.extinction = 3;
    input_.look.noise_frequency = 0.2f;
    input_.look.swirl_width = 1;
  }
  glm::vec3 random_point() {
    const smoke::Segment segment = smoke::SightScene::segment(random_);
    return segment.a_world;
  }

  static const smoke::SmokeNoise& noise() {
    static const smoke::NoiseTile tile = smoke::make_noise_tile({16, 4, 7});
    static const smoke::SmokeNoise both{tile, smoke::make_detail_tile(tile)};
    return both;
  }

  smoke::SightScene scene_;
  planning::SmokeInput input_;
  std::mt19937 random_{7};
};

TEST_P(SmokeMediumTest, DensityIsThatOfDoublePrecision) {
  input_.holes = {};
  const SmokeMedium medium(input_, noise, nullptr);
  const shared::VolumeLayout& layout = scene_.volume().layout();
  int dense = 0, off = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 p = random_point();
    const double expected = smoke_density(
        scene_.volume(), (glm::dvec3(p) - glm::dvec3(layout.origin_world)) / double{layout.voxel_size});
    dense += expected > 0;
    // A point on a plane may fall on its other side.
    off += std::abs(double{medium.density(p)} - expected) > 1e-5;
  }
  EXPECT_GT(dense, 1000);
  EXPECT_LE(off, 4);
}

TEST_P(SmokeMediumTest, HolesAreThoseOfDoublePrecision) {
  const SmokeMedium medium(input_, noise, &scene_.masks());
  planning::SmokeInput whole = input_;
  whole.holes = {};
  const SmokeMedium without(whole, noise, nullptr);
  int cut = 0, off = 0;
  ASSERT_FALSE(scene_.holes().empty());
  std::uniform_real_distribution<float> share(0, 1);
  for (std::size_t i = 0; i < 20000; ++i) {
    // Around one of the holes.
    const shared::Hole& around = scene_.holes()[i % scene_.holes().size()];
    const glm::vec2 across = 1.2f * around.radius * (2.0f * glm::vec2(share(random_), share(random_)) - 1.0f);
    const glm::vec3 p = around.origin_world + around.distance_to_far * share(random_) * around.forward +
                        across.x * around.right + across.y * around.up;
    double low = double{without.density(p)}, high = low;
    bool is_cut = false, is_mask = false;
    for (const shared::Hole& hole : scene_.holes()) {
      if (hole.shape == shared::kHoleMask) {
        const float strength = smoke::hole_strength_masked(hole, p, input_.time, 0, scene_.masks());
        is_mask = is_mask || strength > 0;
        continue;
      }
      const StrengthRange range =
          strengths_within(hole, glm::dvec3(p), double{input_.time}, 0, nullptr, 1e-5, 1e-5);
      low *= 1 - range.high;
      high *= 1 - range.low;
      is_cut = is_cut || range.high > 0;
    }
    if (is_mask) continue;
    cut += is_cut && high > 0;
    const double found = double{medium.density(p)};
    off += found < low - 1e-5 || found > high + 1e-5;
  }
  EXPECT_GT(cut, 20);
  EXPECT_EQ(off, 0);
}

TEST_P(SmokeMediumTest, BoundsHold) {
  for (const float erosion : {0.0f, 0.4f, 1.0f}) {
    input_.look.erosion = erosion;
    input_.look.detail = erosion;
    input_.look.hole_rim = 0.2f;
    input_.look.swirl = 0.3f;
    const SmokeMedium medium(input_, noise, &scene_.masks());
    int dense = 0;
    for (int i = 0; i < 4000; ++i) {
      const smoke::Segment s = smoke::SightScene::segment(random_);
      const Ray ray{s.a_world, glm::normalize(s.b_world - s.a_world), glm::length(s.b_world - s.a_world)};
      std::uniform_real_distribution<float> share(0, 1);
      float covered = 0;
      medium.majorants().traverse(ray, [&](float begin, float end, float bound) {
        covered += end - begin;
        const float t = begin + (end - begin) * (0.01f + 0.98f * share(random_));
        const float extinction = medium.extinction(ray.at(t));
        EXPECT_LE(extinction, bound);
        dense += extinction > 0;
        return false;
      });
      // Nothing is dense outside of the cells.
      if (covered == 0) {
        EXPECT_EQ(medium.extinction(ray.at(ray.end * share(random_))), 0);
      }
    }
    EXPECT_GT(dense, 500);
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutWalls, SmokeMediumTest, testing::Values(2u, 4u, 5u));

}  // namespace
}  // namespace brume::reference
