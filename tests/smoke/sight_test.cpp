#include "smoke/sight.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "core/tasks.hpp"
#include "tests/reference/smoke_integral.hpp"
#include "tests/sanitized.hpp"
#include "tests/smoke/sight_scene.hpp"
#include "voxel/traverse.hpp"

namespace brume::smoke {
namespace {

using reference::SmokeIntegral;

constexpr float kInf = std::numeric_limits<float>::infinity();

SmokeIntegral reference_of(const SightScene& scene, std::span<const shared::Hole> holes, float time,
                           const Segment& s, double step) {
  return reference::integrate_smoke(
      scene.volume().layout(), holes, time, s, step,
      [&](glm::dvec3 p_voxel) { return reference::smoke_density(scene.volume(), p_voxel); }, scene.masks());
}

shared::Hole random_hole(std::mt19937& random, const MaskAtlas& masks) {
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> share(0, 1);
  const auto vector = [&] {
    const float x = normal(random), y = normal(random), z = normal(random);
    return glm::vec3(x, y, z);
  };
  shared::Hole h{};
  const Segment way = SightScene::segment(random);
  h.origin_world = 0.5f * (way.a_world + way.b_world);  // near the middle, where the smoke is
  h.forward = glm::normalize(vector());
  h.right = glm::normalize(glm::cross(h.forward, vector()));
  h.up = glm::cross(h.right, h.forward);
  h.radius = 0.05f + share(random);
  h.distance_to_far = 1 + 12 * share(random);
  h.time_start = 2.4f * share(random) - 0.4f;
  h.time_to_reach_far = random() % 4 == 0 ? 0 : share(random);
  h.time_to_expand = 0.2f * share(random);
  h.time_to_stay_open = 2 * share(random);
  h.time_to_fade = 0.5f * share(random);
  h.shape = static_cast<shared::uint>(random() % 3);
  const MaskRectangle& rectangle = masks.rectangle(static_cast<std::uint32_t>(random() % masks.count()));
  h.uv_min = rectangle.uv_min;
  h.uv_max = rectangle.uv_max;
  return h;
}

// What a quadrature may miss: 0.3 % of what the holes take, and rounding of floats.
double allowed(const SmokeIntegral& expected) {
  return expected.error + 0.003 * (expected.plain - expected.holed) + 1e-5 * (1 + expected.plain);
}

TEST(Sight, EqualsTheIntegralInSmallSteps) {
  const float per_voxel = 1 / SightScene::kVoxel;
  for (std::uint32_t seed = 0; seed < (kSanitized ? 2 : 6); ++seed) {
    const SightScene scene(seed, 24);
    const Sight sight = scene.sight({per_voxel});
    std::mt19937 random(seed);
    double whole = 0, taken = 0;
    for (int i = 0; i < 40; ++i) {
      const Segment s = SightScene::segment(random);
      const SmokeIntegral expected = reference_of(scene, scene.holes(), scene.time(), s, 1.0 / 2048);
      EXPECT_NEAR(*sight.optical_depth(s.a_world, s.b_world), expected.holed, allowed(expected))
          << seed << ' ' << i;
      whole += expected.plain;
      taken += expected.plain - expected.holed;
    }
    EXPECT_GT(whole, 20);
    EXPECT_GT(taken, 0.2);
  }
}

TEST(Sight, FollowsHolesOfAnyShapeAndAge) {
  const SightScene scene(1, 0);
  const float per_voxel = 1 / SightScene::kVoxel;
  std::mt19937 random(77);
  double taken[3] = {}, worst = 0;
  for (int round = 0; round < 60; round += kSanitized ? 5 : 1) {
    std::vector<shared::Hole> holes;
    for (int i = 0; i < 9; ++i) holes.push_back(random_hole(random, scene.masks()));
    const float time = 0.04f * static_cast<float>(round);
    const Sight sight(scene.volume(), scene.grid(), holes, time,
                      {.extinction = per_voxel, .masks = &scene.masks()});
    for (int i = 0; i < 18; ++i) {
      // On the axis of a hole, along it but not straight, and across it.
      const shared::Hole& aimed_at = holes[static_cast<std::size_t>(i / 2)];
      const glm::vec3 far = aimed_at.origin_world + aimed_at.forward * aimed_at.distance_to_far;
      Segment s{aimed_at.origin_world, far};
      if (i % 6 == 1) s.a_world += 0.4f * aimed_at.radius * aimed_at.right;
      if (i % 6 >= 2) {
        const Segment any = SightScene::segment(random);
        const glm::vec3 on_axis = 0.5f * (aimed_at.origin_world + far);
        s = {any.a_world, 2.0f * on_axis - any.a_world};
      }
      const SmokeIntegral expected = reference_of(scene, holes, time, s, 1.0 / 1024);
      const float depth = *sight.optical_depth(s.a_world, s.b_world);
      EXPECT_NEAR(depth, expected.holed, allowed(expected)) << round << ' ' << i;
      worst = std::fmax(worst, std::abs(double{depth} - expected.holed) - expected.error);
      taken[aimed_at.shape] += expected.plain - expected.holed;
    }
  }
  RecordProperty("beyond_the_steps_voxels", std::to_string(worst));
  // Holes of each shape matter; the few rounds under a sanitizer meet some shapes rarely.
  for (const double share : taken) EXPECT_GT(share, kSanitized ? 0 : 5);
}

// The shaders and sample_density read a boundary cell like any other where its solid corners weigh less than
// 1/512 together; a line of sight reads its planes there too. All the same the two are within 1 %.
TEST(Sight, AgreesWithThePointsThatShadersRead) {
  for (std::uint32_t seed = 0; seed < 8; seed += 2) {
    const SightScene scene(seed, 8);
    const Sight sight = scene.sight({1 / SightScene::kVoxel});
    std::mt19937 random(seed + 100);
    for (int i = 0; i < 100; ++i) {
      const Segment s = SightScene::segment(random);
      const SmokeIntegral expected = reference::integrate_smoke(
          scene.volume().layout(), scene.holes(), scene.time(), s, 1.0 / 512,
          [&](glm::dvec3 p) { return double{sample_density(scene.volume(), glm::vec3(p))}; }, scene.masks());
      EXPECT_NEAR(*sight.optical_depth(s.a_world, s.b_world), expected.holed,
                  allowed(expected) + 0.01 * expected.holed + 0.01)
          << seed << ' ' << i;
    }
  }
}

/// A grid without walls, full of smoke: density 1 up to the centres of its outermost voxels, and from there
/// down to 0 within one voxel.
struct FullBox {
  voxel::BitGrid grid;
  sim::World world;
  SmokeVolume volume;
  explicit FullBox(const voxel::GridLayout& layout)
      : grid(layout), world(grid), volume(grid, [](glm::ivec3) { return std::span<const voxel::Plane>(); }) {
    sim::ThrowSmoke thrown;
    thrown.from = thrown.at = sim::position_from_metres(
        glm::dvec3(layout.origin_world) + 0.5 * double{layout.voxel_size} * glm::dvec3(layout.size));
    thrown.smoke.voxels = 1000000;
    world.append(thrown).value_or_throw();
    world.advance_to(200);
    volume.update(world);
  }
};

TEST(Sight, IsExactInUniformSmokeAndInItsRim) {
  for (const glm::ivec3 size : {glm::ivec3(33, 17, 5), glm::ivec3(7, 1, 9), glm::ivec3(1, 1, 1)}) {
    const voxel::GridLayout layout{size, 0.25f, {-1.5f, 0.75f, 3}};
    const FullBox box(layout);
    const Sight sight(box.volume, box.grid, {}, 0, {3});
    const glm::vec3 low = layout.origin_world, high = low + 0.25f * glm::vec3(size);
    const glm::vec3 inner_low = low + 0.125f, inner_high = high - 0.125f;
    // Inside.
    std::mt19937 random(3);
    std::uniform_real_distribution<float> share(0, 1);
    for (int i = 0; i < 100; ++i) {
      const auto point = [&] {
        const float x = share(random), y = share(random), z = share(random);
        return glm::mix(inner_low, inner_high, glm::vec3(x, y, z));
      };
      const glm::vec3 a = point(), b = point();
      EXPECT_NEAR(*sight.optical_depth(a, b), 3 * glm::length(b - a), 1e-5f * (1 + 3 * glm::length(b - a)));
    }
    // Straight out through the rim: u of a voxel into it, u - u^2 / 2 of a voxel's smoke.
    const glm::vec3 middle = 0.5f * (low + high);
    for (int axis = 0; axis < 3; ++axis) {
      for (const float u : {0.0f, 0.25f, 0.5f, 1.0f, 40.0f}) {
        glm::vec3 b = middle;
        b[axis] = inner_high[axis] + u * 0.25f;
        const float in_rim = std::min(u, 1.0f);
        const float expected =
            3 * (inner_high[axis] - middle[axis] + 0.25f * (in_rim - 0.5f * in_rim * in_rim));
        EXPECT_NEAR(*sight.optical_depth(middle, b), expected, 1e-5f * (1 + expected)) << axis << ' ' << u;
      }
    }
  }
}

TEST(Sight, AddsUpAlongALineAndIsTheSameInBothDirections) {
  const SightScene scene(2, 20);
  const Sight sight = scene.sight();
  std::mt19937 random(9);
  std::uniform_real_distribution<float> share(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const Segment s = SightScene::segment(random);
    const glm::vec3 middle = glm::mix(s.a_world, s.b_world, share(random));
    const float whole = *sight.optical_depth(s.a_world, s.b_world);
    // The middle lies off the line by its rounding; a plane cut there makes at most that much difference.
    const float tolerance = 1e-4f * (1 + whole);
    EXPECT_NEAR(*sight.optical_depth(s.b_world, s.a_world), whole, tolerance);
    EXPECT_NEAR(*sight.optical_depth(s.a_world, middle) + *sight.optical_depth(middle, s.b_world), whole,
                0.003f * whole + tolerance);
    EXPECT_GE(whole, 0);
  }
}

TEST(Sight, TakesDegenerateSegments) {
  const SightScene scene(2, 20);
  const Sight sight = scene.sight({1 / SightScene::kVoxel});
  const voxel::GridLayout& layout = SightScene::kFrame;
  const auto at = [&](float x, float y, float z) {
    return layout.origin_world + SightScene::kVoxel * glm::vec3(x, y, z);
  };
  EXPECT_EQ(*sight.optical_depth(at(16, 8, 14), at(16, 8, 14)), 0);
  EXPECT_TRUE(*sight.visible(at(-50, 8, 14), at(-50, 8, 14), 0));
  // Along the axes: on faces of voxels, through their centres, on edges of bricks; from far outside.
  std::vector<Segment> segments;
  for (const float a : {8.0f, 8.5f, 16.0f, 9.25f})
    for (const float b : {8.0f, 11.5f, 16.0f})
      for (const float from : {-3000.0f, 0.0f, 8.0f, 8.5f}) {
        segments.push_back({at(from, a, b), at(40, a, b)});
        segments.push_back({at(a, from, b), at(a, 25, b)});
        segments.push_back({at(a, b, from), at(a, b, 33)});
      }
  segments.push_back({at(0, 0, 0), at(16, 16, 16)});
  segments.push_back({at(8, 8, 8), at(16, 16, 8)});
  for (const Segment& s : segments) {
    const SmokeIntegral expected =
        reference_of(scene, scene.holes(), scene.time(),
                     {glm::max(s.a_world, layout.origin_world - 2.0f), s.b_world}, 1.0 / 512);
    EXPECT_NEAR(*sight.optical_depth(s.a_world, s.b_world), expected.holed, allowed(expected) + 1e-3);
  }
  // Past the grid, and with nothing between.
  EXPECT_EQ(*sight.optical_depth(at(-9, 0, -9), at(-9, 9, 40)), 0);
  EXPECT_TRUE(*sight.visible(at(-9, 0, -9), at(-9, 9, 40), 0));
  EXPECT_EQ(*sight.optical_depth(glm::vec3(16384), glm::vec3(16384, -16384, 16384)), 0);
}

TEST(Sight, RefusesWhatIsNoPoint) {
  const SightScene scene(1, 0);
  const Sight sight = scene.sight();
  const glm::vec3 good(0, 3, 9);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInf, -kInf, 16385.0f, -3e38f}) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 p = good;
      p[axis] = bad;
      EXPECT_EQ(sight.optical_depth(p, good).failure().code, ErrorCode::bad_input);
      EXPECT_EQ(sight.visible(good, p, 1).failure().code, ErrorCode::bad_input);
      EXPECT_EQ(sight.first_wall(good, p).failure().code, ErrorCode::bad_input);
      EXPECT_EQ(sight.sense({p, {1, 0, 0}, 9}, {}).failure().code, ErrorCode::bad_input);
      const std::vector<Segment> many{{good, good}, {good, p}};
      std::vector<float> depths(2, -1);
      const auto batch = sight.optical_depths(many, depths);
      EXPECT_NE(batch.failure().message.find("query 1"), std::string::npos) << batch.failure().message;
      EXPECT_EQ(depths[0], -1);
    }
    EXPECT_FALSE(bad < 3e38f && bad > 0 ? sight.sense({good, {1, 0, 0}, 40000}, {})
                                        : sight.sense({good, {bad, 0, 0}, bad}, {}));
  }
  EXPECT_FALSE(sight.sense({good, {0, 0, 0}, 9}, {}));
  EXPECT_FALSE(sight.sense({good, {1, 0, 0}, 0}, {}));
  EXPECT_FALSE(sight.visible(good, good, -0.5f));
  EXPECT_FALSE(sight.visible(good, good, std::nanf("")));
  EXPECT_THROW(scene.sight({-1}), Error);
  EXPECT_THROW(scene.sight({std::nanf("")}), Error);
  EXPECT_THROW(Sight(scene.volume(), scene.grid(), {}, kInf), Error);
}

TEST(Sight, SeesWhatNeitherWallNorSmokeHides) {
  for (const std::uint32_t seed : {1u, 2u, 4u}) {
    const SightScene scene(seed, 20);
    const Sight sight = scene.sight();
    std::mt19937 random(seed);
    int visible = 0, by_wall = 0, by_smoke = 0;
    for (int i = 0; i < 2000; ++i) {
      const Segment s = SightScene::segment(random);
      const bool wall = sight.first_wall(s.a_world, s.b_world)->has_value();
      const float depth = *sight.optical_depth(s.a_world, s.b_world);
      for (const float threshold : {0.0f, 0.5f, 3.0f, kInf})
        EXPECT_EQ(*sight.visible(s.a_world, s.b_world, threshold), !wall && depth <= threshold);
      visible += !wall && depth <= 3;
      by_wall += wall;
      by_smoke += !wall && depth > 3;
    }
    EXPECT_GT(visible, 100);
    EXPECT_GT(by_smoke, 100);
    EXPECT_EQ(by_wall > 100, seed % 2 == 0);
  }
}

TEST(Sight, FindsTheFirstWall) {
  // A wall at x = 10 with a gap at y in [5, 7).
  voxel::BitGrid grid({{33, 17, 9}, 0.5f, {1, 2, 3}});
  for (int y = 0; y < 17; ++y)
    for (int z = 0; z < 9; ++z)
      if (y < 5 || y > 6) grid.set({10, y, z}, true);
  const sim::World world(grid);
  SmokeVolume volume(grid, [](glm::ivec3) { return std::span<const voxel::Plane>(); });
  const Sight sight(volume, grid, {}, 0);
  const auto at = [](float x, float y, float z) { return glm::vec3(1, 2, 3) + 0.5f * glm::vec3(x, y, z); };
  const auto hit = *sight.first_wall(at(2, 2.5f, 4.5f), at(20, 2.5f, 4.5f));
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->voxel, glm::ivec3(10, 2, 4));
  EXPECT_EQ(hit->normal, glm::ivec3(-1, 0, 0));
  EXPECT_FLOAT_EQ(hit->distance, 4);
  EXPECT_FALSE(*sight.visible(at(2, 2.5f, 4.5f), at(20, 2.5f, 4.5f), kInf));
  EXPECT_TRUE(*sight.visible(at(2, 6, 4.5f), at(20, 6, 4.5f), 0));
  EXPECT_TRUE(*sight.visible(at(2, 2.5f, 4.5f), at(9.9f, 2.5f, 4.5f), 0));
  // A player who leans against the wall is in its voxel, visible from there and back; not through another
  // voxel.
  EXPECT_TRUE(*sight.visible(at(2, 2.5f, 4.5f), at(10.1f, 2.5f, 4.5f), 0));
  EXPECT_TRUE(*sight.visible(at(10.1f, 2.5f, 4.5f), at(2, 2.5f, 4.5f), 0));
  EXPECT_FALSE(*sight.visible(at(10.5f, 2.5f, 1.5f), at(10.5f, 2.5f, 6.5f), 0));
}

TEST(Sight, WallsAreThoseOfTheVoxelWalk) {
  const SightScene scene(4, 0);
  const Sight sight = scene.sight();
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Segment s = SightScene::segment(random);
    const glm::vec3 a = voxel::voxel_from_world(SightScene::kFrame, s.a_world),
                    b = voxel::voxel_from_world(SightScene::kFrame, s.b_world);
    const float length = glm::length(b - a);
    std::optional<glm::ivec3> expected;
    float from = 0;
    voxel::visit_voxels(SightScene::kFrame, a, (b - a) / length, length, [&](glm::ivec3 v, float t, float) {
      const bool end = v == glm::ivec3(glm::floor(a)) || v == glm::ivec3(glm::floor(b));
      if (!scene.grid().solid(v) || end) return true;
      expected = v;
      from = t;
      return false;
    });
    const auto wall = *sight.first_wall(s.a_world, s.b_world);
    ASSERT_EQ(wall.has_value(), expected.has_value()) << i;
    if (!wall) continue;
    EXPECT_EQ(wall->voxel, *expected);
    EXPECT_NEAR(wall->distance, from * SightScene::kVoxel, 1e-5f * length);
  }
}

TEST(Sight, SensesDistanceSmokeAndColour) {
  const SightScene scene(2, 12);
  const Sight sight = scene.sight({2, {0.5f, 0.6f, 0.7f}});
  const SurfaceAlbedo albedo = [](const SightWall& wall) { return glm::vec3(wall.voxel) / 64.0f; };
  std::mt19937 random(6);
  int surfaces = 0;
  for (int i = 0; i < 500; ++i) {
    const Segment s = SightScene::segment(random);
    const SensorRay ray{s.a_world, 7.0f * (s.b_world - s.a_world), 12};
    const SensorSample sample = *sight.sense(ray, albedo);
    const glm::vec3 direction = glm::normalize(ray.direction_world);
    EXPECT_EQ(sample.smoke_albedo, glm::vec3(0.5f, 0.6f, 0.7f));
    EXPECT_EQ(sample.surface.has_value(), sample.distance < 12);
    if (sample.surface) {
      EXPECT_EQ(sample.surface_albedo, albedo(*sample.surface));
      EXPECT_TRUE(scene.grid().solid(sample.surface->voxel));
      ++surfaces;
    } else {
      EXPECT_EQ(sample.surface_albedo, glm::vec3(0));
    }
    const float depth = *sight.optical_depth(s.a_world, s.a_world + sample.distance * direction);
    EXPECT_NEAR(sample.optical_depth, depth, 1e-3f * (1 + depth));
  }
  EXPECT_GT(surfaces, 50);
}

TEST(Sight, GivesTheSameBitsForOneAndForMany) {
  const SightScene scene(2, 32);
  const Sight sight = scene.sight();
  std::mt19937 random(4);
  std::vector<Segment> segments(3001);
  std::vector<SensorRay> rays;
  for (Segment& s : segments) s = SightScene::segment(random);
  for (const Segment& s : segments) rays.push_back({s.a_world, s.b_world - s.a_world + 1e-3f, 9});
  for (const unsigned threads : {1u, 2u, 8u}) {
    set_thread_count(threads);
    std::vector<float> depths(segments.size());
    std::vector<std::uint8_t> visible(segments.size());
    std::vector<SensorSample> samples(segments.size());
    sight.optical_depths(segments, depths).value_or_throw();
    sight.visible(segments, 1, visible).value_or_throw();
    sight.sense(rays, {}, samples).value_or_throw();
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const auto& [a, b] = segments[i];
      EXPECT_EQ(std::bit_cast<std::uint32_t>(depths[i]),
                std::bit_cast<std::uint32_t>(*sight.optical_depth(a, b)));
      EXPECT_EQ(visible[i] != 0, *sight.visible(a, b, 1));
      const SensorSample one = *sight.sense(rays[i], {});
      EXPECT_EQ(std::bit_cast<std::uint32_t>(samples[i].optical_depth),
                std::bit_cast<std::uint32_t>(one.optical_depth));
      EXPECT_EQ(samples[i].distance, one.distance);
    }
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace brume::smoke
