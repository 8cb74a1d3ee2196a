// Rays against triangles, without Embree.
#include "trace/triangle_bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace brume::trace {
namespace {

using Triangle = TriangleBvh::Triangle;
constexpr float kFar = std::numeric_limits<float>::infinity();

bool accept_all(const TriangleBvh::Hit&) {
  return true;
}

TriangleBvh tree_of(const Triangle& triangle) {
  return TriangleBvh(std::span(&triangle, 1));
}

class Random {
 public:
  glm::vec3 point(float reach) {
    std::uniform_real_distribution<float> of(-reach, reach);
    const float x = of(engine_), y = of(engine_);
    return {x, y, of(engine_)};
  }
  /// Not near 0, of any length.
  glm::vec3 direction() {
    glm::vec3 d(0);
    while (glm::dot(d, d) < 0.01f) d = point(1);
    return d;
  }
  float fraction() { return std::uniform_real_distribution<float>(0, 1)(engine_); }

 private:
  std::mt19937 engine_{7};
};

std::vector<Triangle> soup(Random& random, std::size_t count) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 middle = random.point(4);
    const float reach = 0.05f + 2 * std::pow(random.fraction(), 3.0f);
    triangles.push_back(
        {middle + random.point(reach), middle + random.point(reach), middle + random.point(reach)});
  }
  return triangles;
}

/// A ball around 0 of radius 1: the faces of an octahedron, divided again and again.
std::vector<Triangle> ball(int divisions) {
  std::vector<Triangle> faces;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 x(i & 1 ? 1 : -1, 0, 0), y(0, i & 2 ? 1 : -1, 0), z(0, 0, i & 4 ? 1 : -1);
    faces.push_back({x, y, z});
  }
  for (int division = 0; division < divisions; ++division) {
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : faces) {
      // The same floats from both faces at an edge: sums do not depend on the order of two.
      const glm::vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  return faces;
}

// What lies on a ray of well shaped triangles, by aiming at it. Floats of about 4 have errors of 2^-22; the
// corners are sheared by at most as much, and seen at an angle of 0.3 or more.
TEST(TriangleBvhTest, FindsWhatARayIsAimedAt) {
  Random random;
  for (int i = 0; i < 20'000;) {
    const glm::vec3 middle = random.point(2);
    const glm::vec3 u = glm::normalize(random.direction());
    const glm::vec3 n = glm::normalize(glm::cross(u, random.direction()));
    const Triangle triangle{middle, middle + u, middle + glm::cross(n, u)};
    const float v = 1.5f * random.fraction() - 0.25f, w = 1.5f * random.fraction() - 0.25f;
    const float least = std::min({v, w, 1 - v - w});
    const glm::vec3 target = middle + v * u + w * glm::cross(n, u), from = random.point(4);
    const float t = glm::distance(from, target);
    const glm::vec3 direction = (target - from) / t;
    if (!(t > 0.1f && std::abs(glm::dot(direction, n)) > 0.3f)) continue;
    ++i;
    const auto hit = tree_of(triangle).nearest(from, direction, kFar, accept_all);
    constexpr float kError = 64 * 0x1p-22f / 0.3f;
    if (std::abs(least) < kError) continue;
    ASSERT_EQ(hit.has_value(), least > 0) << i;
    if (!hit) continue;
    EXPECT_NEAR(hit->t, t, kError);
    EXPECT_NEAR(hit->at.x, v, kError);
    EXPECT_NEAR(hit->at.y, w, kError);
    EXPECT_FALSE(tree_of(triangle).nearest(from, direction, t - kError, accept_all));
    EXPECT_FALSE(tree_of(triangle).nearest(from, -direction, kFar, accept_all));
  }
}

// The nearest of all is the nearest of trees of one triangle each, which the test above is about.
TEST(TriangleBvhTest, FindsTheNearestOfMany) {
  Random random;
  const std::vector<Triangle> triangles = soup(random, 700);
  const TriangleBvh all(triangles);
  std::vector<TriangleBvh> single;
  for (const Triangle& triangle : triangles) single.push_back(tree_of(triangle));
  std::size_t hits = 0;
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 from = random.point(5), direction = random.direction();
    const float end = i % 3 == 0 ? 2 * random.fraction() : kFar;
    const auto is_odd = [](const TriangleBvh::Hit& hit) { return hit.triangle % 2 == 1; };
    for (const bool all_count : {true, false}) {
      float expected = kFar;
      for (std::size_t k = all_count ? 0 : 1; k < single.size(); k += all_count ? 1 : 2)
        if (const auto hit = single[k].nearest(from, direction, end, accept_all))
          expected = std::min(expected, hit->t);
      const auto found =
          all.nearest(from, direction, end, all_count ? TriangleBvh::Accepts(accept_all) : is_odd);
      ASSERT_EQ(found.has_value(), expected < kFar) << i;
      if (!found) continue;
      ++hits;
      EXPECT_FLOAT_EQ(found->t, expected) << i;
      EXPECT_TRUE(all_count || is_odd(*found));
    }
  }
  EXPECT_GT(hits, 500u);
}

// Rays to the corners and the edges of a ball do not leave it, from anywhere inside, nor do those along the
// axes.
TEST(TriangleBvhTest, LetsNoRayPassBetweenTriangles) {
  const std::vector<Triangle> faces = ball(4);
  const TriangleBvh tree(faces);
  Random random;
  for (int eye = 0; eye < 8; ++eye) {
    const glm::vec3 from = eye == 0 ? glm::vec3(0) : random.point(0.5f);
    std::size_t passed = 0;
    for (const auto& [a, b, c] : faces)
      for (const glm::vec3& target : {a, b, c, 0.5f * (a + b), 0.25f * a + 0.75f * b, (a + b + c) / 3.0f})
        passed += !tree.nearest(from, target - from, kFar, accept_all);
    EXPECT_EQ(passed, 0u) << eye;
  }
}

TEST(TriangleBvhTest, TakesTrianglesOfAnyShape) {
  EXPECT_FALSE(TriangleBvh().nearest({0, 0, 0}, {0, 0, 1}, kFar, accept_all));
  EXPECT_FALSE(TriangleBvh(std::span<const Triangle>()).nearest({0, 0, 0}, {0, 0, 1}, kFar, accept_all));
  const Triangle square{glm::vec3(-1, -1, 2), glm::vec3(1, -1, 2), glm::vec3(0, 1, 2)};
  const std::vector<Triangle> copies(10'000, square);
  const auto of_copies = TriangleBvh(copies).nearest({0, 0, 0}, {0, 0, 1}, kFar, accept_all);
  ASSERT_TRUE(of_copies);
  EXPECT_EQ(of_copies->t, 2);
  // Points and lines are never hit.
  std::vector<Triangle> flat(100, {glm::vec3(0, 0, 1), glm::vec3(0, 0, 1), glm::vec3(0, 0, 1)});
  flat.resize(200, {glm::vec3(-1, 0, 1), glm::vec3(0, 0, 1), glm::vec3(1, 0, 1)});
  flat.push_back(square);
  const auto behind = TriangleBvh(flat).nearest({0, 0, 0}, {0, 0, 1}, kFar, accept_all);
  ASSERT_TRUE(behind);
  EXPECT_EQ(behind->triangle, 200u);
  // Each 1.5 times as far away as the one before: every split by area takes few of them.
  std::vector<Triangle> chain;
  for (int i = -100; i < 100; ++i) {
    const float at = std::pow(1.5f, static_cast<float>(i));
    chain.push_back({glm::vec3(-at, -at, at), glm::vec3(at, -at, at), glm::vec3(0, at, at)});
  }
  const TriangleBvh tree(chain);
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const float from = 0.5f * (chain[i][0].z + chain[i + 1][0].z);
    const auto next = tree.nearest({0, 0, from}, {0, 0, 1}, kFar, accept_all);
    ASSERT_TRUE(next);
    EXPECT_EQ(next->triangle, i + 1);
  }
}

}  // namespace
}  // namespace brume::trace
