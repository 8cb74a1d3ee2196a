#include "bake/coverage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "core/tasks.hpp"
#include "tests/bake/meshes.hpp"
#include "tests/voxel/random.hpp"

namespace brume::bake {
namespace {

using glm::dvec3;
using glm::uvec3;
using glm::vec3;
using voxel::Random;

const Box<double> kAround{dvec3(-1.3), dvec3(1.3)};

double mean_difference(const Coverage& a, const Coverage& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.grid.values.size(); ++i)
    sum += std::abs(double{a.grid.values[i]} - double{b.grid.values[i]});
  return sum / static_cast<double>(a.grid.values.size());
}

float at(const Coverage& coverage, uvec3 voxel) {
  return coverage.grid.values[coverage.grid.index(voxel)];
}

void expect_fractions(const Coverage& coverage) {
  for (const float value : coverage.grid.values) ASSERT_TRUE(value >= 0 && value <= 1) << value;
}

/// In another order, and the corners of each from another one.
Mesh shuffled(Mesh mesh, Random& random) {
  for (std::size_t i = mesh.size(); i > 1; --i) std::swap(mesh[i - 1], mesh[random() % i]);
  for (voxel::Triangle& t : mesh) {
    if (random() % 3 == 0) t = {t.b, t.c, t.a};
    if (random() % 3 == 0) t = {t.c, t.a, t.b};
    for (vec3* p : {&t.a, &t.b, &t.c})
      for (int axis = 0; axis < 3; ++axis)
        if ((*p)[axis] == 0) (*p)[axis] = random() % 2 ? 0.0f : -0.0f;
  }
  return mesh;
}

TEST(Coverage, ABoxOnPlanesBetweenVoxelsIsEmptyOrFull) {
  const Box<double> box{dvec3(-2), dvec3(6)};
  const Coverage coverage = mesh_coverage(box_mesh({-1, 0, 1}, {5, 3, 4}), box, uvec3(8));
  EXPECT_EQ(coverage.faults.open_edges, 0u);
  EXPECT_FALSE(coverage.faults.inside_out);
  EXPECT_EQ(coverage.faults.text(), "");
  EXPECT_EQ(coverage.grid.size, uvec3(8));
  EXPECT_EQ(coverage.grid.box, box);
  for (unsigned z = 0; z < 8; ++z)
    for (unsigned y = 0; y < 8; ++y)
      for (unsigned x = 0; x < 8; ++x) {
        const bool inside = x >= 1 && x < 7 && y >= 2 && y < 5 && z >= 3 && z < 6;
        EXPECT_EQ(at(coverage, {x, y, z}), inside ? 1.0f : 0.0f);
      }
}

TEST(Coverage, FractionsAreExact) {
  // Half of a voxel, a quarter, an eighth.
  const Coverage coverage =
      mesh_coverage(box_mesh({0.5f, 0.5f, 0.5f}, {2, 2, 2}), {dvec3(0), dvec3(3)}, uvec3(3));
  EXPECT_EQ(at(coverage, {0, 0, 0}), 0.125f);
  EXPECT_EQ(at(coverage, {1, 0, 0}), 0.25f);
  EXPECT_EQ(at(coverage, {1, 1, 0}), 0.5f);
  EXPECT_EQ(at(coverage, {1, 1, 1}), 1.0f);
  EXPECT_EQ(at(coverage, {2, 1, 1}), 0.0f);
}

TEST(Coverage, ACavityStaysEmpty) {
  const Mesh mesh = joined(box_mesh(vec3(-3), vec3(3)), inverted(box_mesh(vec3(-1), vec3(1))));
  for (const bool inside_out : {false, true}) {
    const Coverage coverage =
        mesh_coverage(inside_out ? inverted(mesh) : mesh, {dvec3(-4), dvec3(4)}, uvec3(8));
    EXPECT_EQ(coverage.faults.inside_out, inside_out);
    EXPECT_EQ(at(coverage, {4, 4, 4}), 0.0f);
    EXPECT_EQ(at(coverage, {3, 3, 3}), 0.0f);
    EXPECT_EQ(at(coverage, {1, 4, 4}), 1.0f);
    EXPECT_EQ(at(coverage, {0, 4, 4}), 0.0f);
    EXPECT_EQ(std::accumulate(coverage.grid.values.begin(), coverage.grid.values.end(), 0.0), 216 - 8);
  }
}

TEST(Coverage, InsideOutIsCorrectedAndReported) {
  const Mesh mesh = sphere_mesh(dvec3(0.1), 1, 24, 12);
  const Coverage right = mesh_coverage(mesh, kAround, uvec3(11, 12, 13));
  const Coverage inverse = mesh_coverage(inverted(mesh), kAround, uvec3(11, 12, 13));
  EXPECT_FALSE(right.faults.inside_out);
  EXPECT_TRUE(inverse.faults.inside_out);
  EXPECT_EQ(inverse.faults.text(), "");
  // The sums are those with the opposite sign up to rounding, then rounded to floats: 2^-24.
  for (std::size_t i = 0; i < right.grid.values.size(); ++i)
    EXPECT_NEAR(right.grid.values[i], inverse.grid.values[i], 1e-7);

  // Of two solids, one inside out.
  const Mesh a = sphere_mesh(dvec3(-0.6, 0, 0), 0.5, 24, 12), b = sphere_mesh(dvec3(0.7, 0, 0), 0.4, 24, 12);
  const Coverage both = mesh_coverage(joined(a, b), kAround, uvec3(16));
  const Coverage one = mesh_coverage(joined(a, inverted(b)), kAround, uvec3(16));
  EXPECT_FALSE(one.faults.inside_out);
  for (std::size_t i = 0; i < both.grid.values.size(); ++i)
    EXPECT_NEAR(both.grid.values[i], one.grid.values[i], 1e-7);
}

TEST(Coverage, OverlappingSolidsCountOnceWhereTheyFillVoxels) {
  const Mesh mesh = joined(box_mesh({0, 0, 0}, {3, 3, 3}), box_mesh({1, 1, 1}, {4, 4, 4}));
  const Coverage coverage = mesh_coverage(mesh, {dvec3(0), dvec3(5)}, uvec3(5));
  expect_fractions(coverage);
  EXPECT_EQ(at(coverage, {2, 2, 2}), 1.0f);
  EXPECT_EQ(std::accumulate(coverage.grid.values.begin(), coverage.grid.values.end(), 0.0), 27 + 27 - 8);
}

TEST(Coverage, DoesNotDependOnOrderOrThreads) {
  Random random(7);
  Mesh open = sphere_mesh(dvec3(0), 1, 24, 12);
  open.erase(open.begin() + 100, open.begin() + 140);
  for (const Mesh& mesh : {sphere_mesh(dvec3(0), 1, 30, 15), torus_mesh(0.8, 0.3, 20, 10), open}) {
    set_thread_count(1);
    const Coverage one = mesh_coverage(mesh, kAround, uvec3(15, 14, 9));
    set_thread_count(4);
    const Coverage other = mesh_coverage(shuffled(mesh, random), kAround, uvec3(15, 14, 9));
    set_thread_count(0);
    EXPECT_EQ(one.grid.values, other.grid.values);
    EXPECT_EQ(one.faults.open_edges, other.faults.open_edges);
  }
}

TEST(Coverage, CountsOpenEdges) {
  Mesh cube = box_mesh(vec3(-1), vec3(1));
  EXPECT_EQ(find_faults(cube).open_edges, 0u);
  EXPECT_EQ(find_faults(joined(cube, cube)).open_edges, 0u);
  // Triangles that are segments change nothing.
  EXPECT_EQ(find_faults(joined(cube, {{vec3(0), vec3(1), vec3(1)}})).open_edges, 0u);
  // A triangle the wrong side out has three edges that both sides use in one direction.
  Mesh flipped = cube;
  std::swap(flipped[3].a, flipped[3].b);
  EXPECT_EQ(find_faults(flipped).open_edges, 3u);

  cube.pop_back();
  EXPECT_EQ(find_faults(cube).open_edges, 3u);
  cube.pop_back();
  EXPECT_EQ(find_faults(cube).open_edges, 4u);
  EXPECT_EQ(
      find_faults(cube).text(),
      "has 4 open edges, so its inside is a guess by winding number; close its holes for exact coverage");
  EXPECT_EQ((MeshFaults{1, false}.text().substr(0, 15)), "has 1 open edge");
  EXPECT_EQ(find_faults({}).open_edges, 0u);
}

TEST(Coverage, AnOpenBoxIsSolidUpToItsOpening) {
  // Its edge is 8 voxels of 1/4, open to +z. Inside, the winding number is 1 - W / 4 pi, where W is the solid
  // angle of the opening: at depth d below its middle, where it is largest, 4 atan(1 / (d sqrt(2 + d^2))).
  // From one voxel below the opening, d >= 1/4, that is more than 0.6. Outside it is -W / 4 pi, or W / 4 pi
  // above the opening: at most 0.487 at the lowest points of a voxel, d = 1/32. In between lies the border,
  // and in it the error of the approximation.
  Mesh cube = box_mesh(vec3(-1), vec3(1));
  cube.resize(10);
  for (const bool inside_out : {false, true}) {
    const Coverage coverage =
        mesh_coverage(inside_out ? inverted(cube) : cube, {dvec3(-2), dvec3(2)}, uvec3(16));
    EXPECT_EQ(coverage.faults.open_edges, 4u);
    EXPECT_EQ(coverage.faults.inside_out, inside_out);
    expect_fractions(coverage);
    for (unsigned z = 0; z < 16; ++z)
      for (unsigned y = 0; y < 16; ++y)
        for (unsigned x = 0; x < 16; ++x) {
          const bool across = x >= 4 && x < 12 && y >= 4 && y < 12;
          const bool inside = across && z >= 4 && z < 11, outside = !across || z < 4 || z >= 12;
          const float value = at(coverage, {x, y, z});
          if (inside || outside) {
            ASSERT_EQ(value, inside ? 1.0f : 0.0f) << x << " " << y << " " << z;
          }
        }
  }
}

TEST(Coverage, ASheetEnclosesNothing) {
  // Its solid angle is below 2 pi from everywhere. In the middle of voxels, on planes between them, and far
  // larger than the box.
  for (const Mesh& mesh : {sheet_mesh({-1, -1, 0.03f}, 2, 20), sheet_mesh({-1, -1, 0}, 2, 20),
                           sheet_mesh({-1e4f, -1e4f, 0.03f}, 2e4f, 1)}) {
    const Coverage coverage = mesh_coverage(mesh, kAround, uvec3(12));
    EXPECT_GT(coverage.faults.open_edges, 0u);
    EXPECT_FALSE(coverage.faults.inside_out);
    for (const float value : coverage.grid.values) EXPECT_EQ(value, 0.0f);
  }
}

TEST(Coverage, ASmallHoleChangesLittle) {
  Mesh mesh = sphere_mesh(dvec3(0.02, 0.01, 0), 1, 48, 24);
  const Coverage closed = mesh_coverage(mesh, kAround, uvec3(32));
  mesh.erase(mesh.begin() + 500);
  const Coverage open = mesh_coverage(mesh, kAround, uvec3(32));
  EXPECT_EQ(open.faults.open_edges, 3u);
  expect_fractions(open);
  // Points at distances of 1/4 place the surface in a voxel with an error between -1/8 and 1/8, on average
  // 1/16 or less. Triangles cross about 1.5 * 4 pi 12.3^2 of the 32^3 voxels, 9 %.
  EXPECT_LT(mean_difference(closed, open), 0.006);
}

TEST(Coverage, MixedOrientationsGiveFractions) {
  Random random(8);
  Mesh mesh = sphere_mesh(dvec3(0), 1, 24, 12);
  for (voxel::Triangle& t : mesh)
    if (random() % 2) std::swap(t.a, t.b);
  const Coverage coverage = mesh_coverage(mesh, kAround, uvec3(9));
  EXPECT_GT(coverage.faults.open_edges, 0u);
  expect_fractions(coverage);
}

TEST(Coverage, HostileMeshesGiveFractions) {
  const Coverage none = mesh_coverage({}, kAround, uvec3(3, 1, 2));
  EXPECT_EQ(none.grid.values, std::vector<float>(6, 0.0f));
  EXPECT_EQ(none.faults.text(), "");

  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf, 1e30f, -3.4e38f}) {
    Mesh mesh = sphere_mesh(dvec3(0), 1, 12, 6);
    mesh[17].b.y = bad;
    expect_fractions(mesh_coverage(mesh, kAround, uvec3(5)));
    // Closed, but vast.
    for (voxel::Triangle& t : mesh)
      for (vec3* p : {&t.a, &t.b, &t.c})
        if (p->z == 1) p->z = bad;
    expect_fractions(mesh_coverage(mesh, kAround, uvec3(1)));
  }
  // One voxel around it holds all of its volume.
  const Mesh mesh = sphere_mesh(dvec3(0), 1, 12, 6);
  const Coverage one = mesh_coverage(mesh, {dvec3(-1), dvec3(1)}, uvec3(1));
  EXPECT_FLOAT_EQ(one.grid.values[0], static_cast<float>(signed_volume(mesh) / 8));
}

}  // namespace
}  // namespace brume::bake
