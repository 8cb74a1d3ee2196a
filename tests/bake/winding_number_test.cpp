#include "bake/winding_number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/bake/meshes.hpp"
#include "tests/sanitized.hpp"
#include "tests/voxel/random.hpp"

namespace brume::bake {
namespace {

using glm::dvec3;
using glm::vec3;
using voxel::Random;
using voxel::uniform;

double brute_force(const Mesh& mesh, dvec3 p) {
  double sum = 0;
  for (const voxel::Triangle& t : mesh) sum += solid_angle(dvec3(t.a) - p, dvec3(t.b) - p, dvec3(t.c) - p);
  return sum / (4 * std::numbers::pi);
}

TEST(WindingNumber, SolidAngles) {
  // An eighth of the sphere, from inside and from outside; a point in the plane of a triangle, beside it.
  EXPECT_NEAR(solid_angle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}), std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(solid_angle({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), -std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(solid_angle({1, 0, 0}, {2, 0, 0}, {1, 1, 0}), 0);
  EXPECT_EQ(solid_angle(dvec3(0), dvec3(0), dvec3(0)), 0);
}

TEST(WindingNumber, CubesAreExact) {
  Mesh cube = box_mesh(vec3(-1), vec3(1));
  EXPECT_NEAR(WindingTree(cube).winding_number({0.2, 0.3, -0.9}), 1, WindingTree::kError);
  EXPECT_NEAR(WindingTree(cube).winding_number(dvec3(0)), 1, 1e-12);
  EXPECT_NEAR(WindingTree(inverted(cube)).winding_number(dvec3(0)), -1, 1e-12);
  EXPECT_NEAR(WindingTree(cube).winding_number({1.1, 0, 0}), 0, WindingTree::kError);
  // From the middle each face covers a sixth.
  cube.pop_back();
  cube.pop_back();
  EXPECT_NEAR(WindingTree(cube).winding_number(dvec3(0)), 5.0 / 6, 1e-12);
}

TEST(WindingNumber, StaysNearTheSumOverAllTriangles) {
  Mesh sphere = sphere_mesh(dvec3(0.2, 0, 0), 1, 60, 30);
  sphere.resize(sphere.size() * 3 / 4);
  Mesh torus = torus_mesh(0.8, 0.3, 80, 30);
  torus.resize(torus.size() / 2);
  const Mesh sheet = sheet_mesh({-1, -1, 0}, 2, 40);
  Random random(5);
  for (const Mesh& mesh : {sphere, torus, sheet, joined(sphere, torus)}) {
    const WindingTree tree(mesh);
    double worst = 0;
    for (int i = 0; i < (kSanitized ? 200 : 3000); ++i) {
      // Everywhere, or near the surface.
      const double reach = i % 3 ? 1.5 : 4;
      dvec3 p(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
      p *= reach;
      if (i % 2) p = 0.001 * p + dvec3(mesh[random() % mesh.size()].b);
      worst = std::max(worst, std::abs(tree.winding_number(p) - brute_force(mesh, p)));
    }
    EXPECT_LT(worst, WindingTree::kError);
  }
}

TEST(WindingNumber, IsFiniteOnTrianglesAndForHostileOnes) {
  const Mesh sphere = sphere_mesh(dvec3(0), 1, 12, 6);
  const WindingTree tree(sphere);
  for (const voxel::Triangle& t : sphere) {
    // A triangle adds at most 1/2 to a point on it, and all others at most 1 together.
    const dvec3 a(t.a), b(t.b), c(t.c);
    EXPECT_LE(std::abs(tree.winding_number((a + b + c) / 3.0)), 1.5 + WindingTree::kError);
    EXPECT_LE(std::abs(tree.winding_number(0.5 * (a + b))), 2 + WindingTree::kError);
    EXPECT_TRUE(std::isfinite(tree.winding_number(a)));
  }
  EXPECT_EQ(WindingTree(Mesh{}).winding_number(dvec3(0)), 0);

  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const float values[] = {0, 1, -1, 1e30f, -3.4e38f, nan, inf, 1e-40f};
  Random random(6);
  Mesh mesh;
  const auto corner = [&] {
    const float x = values[random() % 8], y = values[random() % 8];
    return vec3(x, y, values[random() % 8]);
  };
  for (int i = 0; i < 500; ++i) mesh.push_back({corner(), corner(), corner()});
  const WindingTree hostile(mesh);
  for (const double x : {0.0, 1.0, -3.0, 1e30})
    EXPECT_TRUE(std::isfinite(hostile.winding_number({x, 0, 1}))) << x;
}

}  // namespace
}  // namespace brume::bake
