#include "bake/occlusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "core/tasks.hpp"
#include "tests/reference/occlusion.hpp"
#include "tests/sanitized.hpp"

namespace brume::bake {
namespace {

using Mesh = std::vector<voxel::Triangle>;

void add_quad(Mesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  mesh.push_back({a, b, c});
  mesh.push_back({a, c, d});
}

/// The sides of a prism with the polygon as its floor and roof; counter-clockwise from above.
Mesh make_prism(const std::vector<glm::vec2>& polygon, float low, float high) {
  Mesh mesh;
  const auto at = [](glm::vec2 p, float y) { return glm::vec3(p.x, y, p.y); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    add_quad(mesh, at(a, low), at(b, low), at(b, high), at(a, high));
    for (const float y : {low, high}) mesh.push_back({at(polygon[0], y), at(a, y), at(b, y)});
  }
  return mesh;
}

Mesh make_box(glm::vec3 low, glm::vec3 high) {
  return make_prism({{low.x, low.z}, {high.x, low.z}, {high.x, high.z}, {low.x, high.z}}, low.y, high.y);
}

/// A grid of points on a closed surface: of n x m quads.
Mesh make_surface(int n, int m, const std::function<glm::dvec3(double, double)>& point) {
  Mesh mesh;
  const auto at = [&](int i, int j) {
    return glm::vec3(point(static_cast<double>(i) / n, static_cast<double>(j % m) / m));
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return mesh;
}

Mesh make_sphere(glm::dvec3 middle, double radius, int rings) {
  return make_surface(rings, 2 * rings, [&](double u, double v) {
    const double down = glm::pi<double>() * u, around = glm::two_pi<double>() * v;
    return middle + radius * glm::dvec3(std::sin(down) * std::cos(around), std::cos(down),
                                        std::sin(down) * std::sin(around));
  });
}

/// A tube along the torus knot (2, 3), within 0.8 of the origin: 3,072 triangles.
Mesh make_knot() {
  const auto knot = [](double u) {
    const double t = glm::two_pi<double>() * u, r = 0.2 * (2 + std::cos(3 * t));
    return glm::dvec3(r * std::cos(2 * t), 0.2 * std::sin(3 * t), r * std::sin(2 * t));
  };
  return make_surface(128, 12, [&](double u, double v) {
    const glm::dvec3 ahead = glm::normalize(knot(u - std::floor(u) + 1e-4) - knot(u - std::floor(u) - 1e-4));
    const glm::dvec3 aside = glm::normalize(glm::cross(ahead, glm::dvec3(0, 1, 0)));
    const double around = glm::two_pi<double>() * v;
    return knot(u) + 0.1 * (std::cos(around) * aside + std::sin(around) * glm::cross(aside, ahead));
  });
}

OcclusionOptions options_of(glm::uvec3 size, std::uint32_t rays) {
  return {.size = size, .box = {glm::dvec3(-1), glm::dvec3(1)}, .rays = rays};
}

Occlusion bake(const Mesh& mesh, const OcclusionOptions& options) {
  auto occlusion = bake_occlusion(mesh, options);
  EXPECT_TRUE(occlusion) << occlusion.failure().message;
  return *std::move(occlusion);
}

/// Calls visit(index, middle) for each texel.
template <typename Visit>
void for_each_texel(const grids::DenseGrid& grid, Visit visit) {
  for_each_in({glm::ivec3(0), glm::ivec3(grid.size)}, [&](glm::ivec3 voxel) {
    visit(grid.index(glm::uvec3(voxel)), grid.box.low + grid.voxel_size() * (glm::dvec3(voxel) + 0.5));
  });
}

double rms_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

bool all_are(const grids::DenseGrid& grid, float value) {
  return std::ranges::all_of(grid.values, [&](float one) { return one == value; });
}

/// Of 256 rays beside the knot; measured against references below.
constexpr double kRms = 0.01;

/// Of a fraction that 4^k rays measure, 6 standard deviations. Each of the 2^k x 2^k cells has one ray: what
/// is constant in a cell adds no variance, and the rest of the integrand at most twice that of random rays
/// (Owen 1997, "Monte Carlo Variance of Scrambled Net Quadrature"), which is at most 1/4 in each
/// mixed cell: 2 (mixed / rays) / 4 / rays.
double sampling_bound(std::size_t mixed_cells, double rays) {
  return 6 * std::sqrt(0.5 * static_cast<double>(mixed_cells)) / rays;
}

constexpr std::size_t kCells = kSanitized ? 32 : 128;
constexpr std::uint32_t kManyRays = kCells * kCells;

TEST(Occlusion, OfARectangleAboveIsItsFormFactor) {
  const std::array<std::array<glm::dvec2, 2>, 3> rectangles{{{glm::dvec2(-50), glm::dvec2(50)},
                                                             {glm::dvec2(-4, -3), glm::dvec2(0.3, 5)},
                                                             {glm::dvec2(-1e10), glm::dvec2(1e10)}}};
  for (const auto& [low, high] : rectangles) {
    Mesh mesh;
    const glm::vec2 l(low), h(high);
    add_quad(mesh, {l.x, 1.2f, l.y}, {h.x, 1.2f, l.y}, {h.x, 1.2f, h.y}, {l.x, 1.2f, h.y});
    const Occlusion occlusion = bake(mesh, options_of({3, 2, 3}, kManyRays));
    EXPECT_TRUE(all_are(occlusion.down, 0));
    for_each_texel(occlusion.up, [&](std::size_t i, glm::dvec3 p) {
      const double height = double{1.2f} - p.y;
      const glm::dvec2 from = glm::dvec2(l) - glm::dvec2(p.x, p.z), to = glm::dvec2(h) - glm::dvec2(p.x, p.z);
      const double expected = reference::form_factor_of_rectangle(from, to, height);
      const std::size_t mixed = reference::count_mixed_cells(kCells, [&](glm::dvec3 direction) {
        const glm::dvec2 at = glm::dvec2(direction.x, direction.z) * (height / direction.y);
        return glm::all(glm::greaterThan(at, from)) && glm::all(glm::lessThan(at, to));
      });
      EXPECT_NEAR(occlusion.up.values[i], expected, sampling_bound(mixed, kManyRays)) << p.x << " " << p.y;
    });
  }
}

TEST(Occlusion, OfASphereAboveIsItsFormFactor) {
  constexpr int kRings = 100;
  constexpr double kRadius = 0.4;
  const glm::dvec3 middle(0.1, 0.8, -0.2);
  OcclusionOptions options = options_of({3, 2, 3}, kManyRays);
  options.box.high.y = 0.2;
  const Occlusion occlusion = bake(make_sphere(middle, kRadius, kRings), options);
  EXPECT_TRUE(all_are(occlusion.down, 0));
  // Quads are chords of arcs of pi / rings in two directions: they are inside of the sphere by at most
  // (1 - cos(pi / rings / 2)) of its radius for each, and areas change by twice that.
  const double flat = 4 * (1 - std::cos(0.5 * glm::pi<double>() / kRings));
  for_each_texel(occlusion.up, [&](std::size_t i, glm::dvec3 p) {
    const double distance = glm::length(middle - p), sine_squared = kRadius * kRadius / distance / distance;
    const glm::dvec3 to_middle = (middle - p) / distance;
    const double expected = to_middle.y * sine_squared;
    const std::size_t mixed = reference::count_mixed_cells(kCells, [&](glm::dvec3 direction) {
      return glm::dot(direction, to_middle) > std::sqrt(1 - sine_squared);
    });
    EXPECT_NEAR(occlusion.up.values[i], expected, flat * expected + sampling_bound(mixed, kManyRays));
  });
}

TEST(Occlusion, OfNothingIsNone) {
  const OcclusionOptions options = options_of({7, 1, 3}, 16);
  const Occlusion occlusion = bake({}, options);
  EXPECT_EQ(occlusion.up.values, std::vector<float>(21, 0.0f));
  EXPECT_EQ(occlusion.down.values, std::vector<float>(21, 0.0f));
  EXPECT_EQ(occlusion.up.size, options.size);
  EXPECT_EQ(occlusion.down.box, options.box);
  EXPECT_EQ(occlusion.up.name + occlusion.down.name, "updown");
}

TEST(Occlusion, TrianglesThatAreNotFiniteHideNothing) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  const Mesh bad{{{kNan, 1, 0}, {1, 1, 0}, {0, 1, 1}},
                 {{-9, 1, -9}, {9, 1, kInf}, {9, 1, -9}},
                 {{-9, 1, -9}, {-kInf, 1, 9}, {9, 1, 9}},
                 {{3e38f, 1, -9}, {-3e38f, 1, 9}, {9, 1, 9}},
                 {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}}};
  const OcclusionOptions options = options_of({5, 3, 4}, 64);
  const Occlusion nothing = bake(bad, options);
  EXPECT_TRUE(all_are(nothing.up, 0) && all_are(nothing.down, 0));
  const Mesh good = make_knot();
  Mesh both = bad;
  both.insert(both.end(), good.begin(), good.end());
  EXPECT_LE(rms_difference(bake(both, options).up.values, bake(good, options).up.values), 1.0 / 64);
}

TEST(Occlusion, InsideOfAClosedMeshIsExactlyOne) {
  std::vector<Mesh> meshes{make_box(glm::vec3(-1.1f), glm::vec3(1.2f)), make_sphere(glm::dvec3(0), 1.8, 90)};
  // Between triangles of all shapes.
  meshes.push_back(make_sphere(glm::dvec3(0), 1.8, 40));
  for (voxel::Triangle& triangle : meshes.back())
    for (glm::vec3* corner : {&triangle.a, &triangle.b, &triangle.c})
      *corner *= 1.0f + 0.03f * std::sin(40 * corner->x + 50 * corner->y * corner->z);
  for (const Mesh& mesh : meshes)
    for (const double scale : {1e-6, 0.1, 1.0, 1e9}) {
      Mesh scaled = mesh;
      for (voxel::Triangle& triangle : scaled)
        for (glm::vec3* corner : {&triangle.a, &triangle.b, &triangle.c})
          *corner = glm::vec3(scale * (glm::dvec3(*corner) + glm::dvec3(7, -5, 3)));
      OcclusionOptions options = options_of(kSanitized ? glm::uvec3(4) : glm::uvec3(9, 10, 11), 256);
      options.box = {scale * glm::dvec3(6, -6, 2), scale * glm::dvec3(8, -4, 4)};
      const Occlusion occlusion = bake(scaled, options);
      EXPECT_TRUE(all_are(occlusion.up, 1) && all_are(occlusion.down, 1)) << mesh.size() << " " << scale;
    }
}

TEST(Occlusion, FollowsBruteForce) {
  constexpr int kRays = kSanitized ? 1000 : 10000;
  constexpr std::size_t kPick = kSanitized ? 97 : 53;
  const Mesh mesh = make_knot();
  const Occlusion occlusion = bake(mesh, options_of({8, 8, 8}, 256));
  std::mt19937_64 random(5);
  double squares = 0, noise = 0, count = 0;
  for_each_texel(occlusion.up, [&](std::size_t i, glm::dvec3 p) {
    if (i % kPick != 11) return;
    const bool up = i / kPick % 2 == 0;
    const double expected = reference::hidden_fraction(mesh, p, up ? 1 : -1, kRays, random);
    const double value = double{(up ? occlusion.up : occlusion.down).values[i]};
    squares += (value - expected) * (value - expected);
    noise += value * (1 - value) / kRays;  // the variance of the reference
    count += 1;
  });
  EXPECT_GT(count, 4);
  EXPECT_LE(std::sqrt(std::max(0.0, squares - noise) / count), kRms);
}

TEST(Occlusion, NoiseIsSmallAndNotTheSameInNeighbours) {
  const Mesh mesh = make_knot();
  OcclusionOptions options = options_of({24, 2, 24}, 256);
  const Occlusion occlusion = bake(mesh, options);
  options.rays = kSanitized ? 4096 : 16384;
  options.seed = 9;
  const Occlusion expected = bake(mesh, options);
  for (const auto part : {&Occlusion::up, &Occlusion::down}) {
    const grids::DenseGrid &grid = occlusion.*part, &exact = expected.*part;
    EXPECT_LE(rms_difference(grid.values, exact.values), kRms);
    // Of n independent pairs, the correlation is 0 with the standard deviation 1 / sqrt(n).
    double squares = 0, products = 0, pairs = 0;
    const auto error = [&](std::size_t i) { return double{grid.values[i]} - exact.values[i]; };
    for (std::size_t i = 0; i < grid.values.size(); ++i) squares += error(i) * error(i);
    for (std::size_t i = 1; i < grid.values.size(); ++i) {
      if (i % grid.size.x == 0) continue;
      products += error(i) * error(i - 1);
      pairs += 1;
    }
    const double correlation = products / pairs / (squares / static_cast<double>(grid.values.size()));
    EXPECT_LE(std::abs(correlation), 5 / std::sqrt(pairs));
  }
}

TEST(Occlusion, SeedsChangeTheNoiseOnly) {
  const Mesh mesh = make_knot();
  OcclusionOptions options = options_of({10, 10, 10}, 256);
  const Occlusion first = bake(mesh, options);
  options.seed = 1;
  const Occlusion second = bake(mesh, options);
  const double difference = rms_difference(first.up.values, second.up.values);
  EXPECT_GT(difference, 0);
  EXPECT_LE(difference, std::sqrt(2.0) * kRms);  // the noise of both
}

TEST(Occlusion, MirroredMeshesSwapUpAndDown) {
  Mesh mesh = make_knot();
  add_quad(mesh, {-0.9f, 0.6f, -0.7f}, {0.5f, 0.6f, -0.7f}, {0.5f, 0.7f, 0.3f}, {-0.9f, 0.7f, 0.3f});
  Mesh mirrored = mesh;
  for (voxel::Triangle& triangle : mirrored)
    for (glm::vec3* corner : {&triangle.a, &triangle.b, &triangle.c}) corner->y = -corner->y;
  const OcclusionOptions options = options_of({9, 8, 9}, 256);
  const Occlusion up = bake(mesh, options), down = bake(mirrored, options);
  std::vector<float> turned;
  for (std::uint32_t z = 0; z < 9; ++z)
    for (std::uint32_t y = 0; y < 8; ++y)
      for (std::uint32_t x = 0; x < 9; ++x)
        turned.push_back(down.down.values[down.down.index({x, 7 - y, z})]);
  EXPECT_LE(rms_difference(up.up.values, turned), std::sqrt(2.0) * kRms);  // the noise of both
}

TEST(Occlusion, ThinSheetsHideFromBothSides) {
  Mesh mesh;
  add_quad(mesh, {-9, 0, -9}, {9, 0, -9}, {9, 0, 9}, {-9, 0, 9});
  const Occlusion occlusion = bake(mesh, options_of({4, 6, 5}, 1024));
  for (voxel::Triangle& triangle : mesh) std::swap(triangle.b, triangle.c);
  const Occlusion turned = bake(mesh, options_of({4, 6, 5}, 1024));
  for_each_texel(occlusion.up, [&](std::size_t i, glm::dvec3 p) {
    const auto& [facing, away] =
        p.y < 0 ? std::tie(occlusion.up, occlusion.down) : std::tie(occlusion.down, occlusion.up);
    // Below 1 m, at most 1/65 of the rays pass more than 8 m away; sampling adds at most 0.71 / 32 (RMS).
    EXPECT_GT(facing.values[i], 0.9) << p.y;
    EXPECT_EQ(away.values[i], 0) << p.y;
    // At the edges rounding may differ.
    EXPECT_NEAR(occlusion.up.values[i], turned.up.values[i], 1.0 / 1024);
    EXPECT_NEAR(occlusion.down.values[i], turned.down.values[i], 1.0 / 1024);
  });
}

/// Where neither corners nor texels are exact in floats.
constexpr double kScale = 0.1;
const glm::dvec3 kAway(0.3, -0.7, 1.1);

Mesh placed(Mesh mesh) {
  for (voxel::Triangle& triangle : mesh)
    for (glm::vec3* corner : {&triangle.a, &triangle.b, &triangle.c})
      *corner = glm::vec3(kScale * glm::dvec3(*corner) + kAway);
  return mesh;
}

/// Of eight texels along each edge from -1 to 1, whose middles are at odd multiples of 1/8. Calls
/// visit(middle, up, down).
template <typename Visit>
void for_each_texel_beside(const Mesh& mesh, Visit visit) {
  OcclusionOptions options = options_of({8, 8, 8}, 256);
  options.box = {kScale * options.box.low + kAway, kScale * options.box.high + kAway};
  const Occlusion occlusion = bake(placed(mesh), options);
  for_each_texel(occlusion.up, [&](std::size_t i, glm::dvec3 p) {
    const glm::dvec3 middle = glm::round(8.0 * (p - kAway) / kScale) / 8.0;
    visit(middle, double{occlusion.up.values[i]}, double{occlusion.down.values[i]});
  });
}

TEST(Occlusion, TexelsOnFacesOfABoxAreAboveOrBelowThem) {
  constexpr double kFace = 0.625;
  for_each_texel_beside(make_box(glm::vec3(-kFace), glm::vec3(kFace)),
                        [&](glm::dvec3 p, double up, double down) {
                          const auto is_inside = [](double x) { return x >= -kFace && x < kFace; };
                          if (is_inside(p.x) && is_inside(p.z)) {
                            if (is_inside(p.y)) {
                              EXPECT_EQ(up, 1);
                            }
                            if (is_inside(-p.y)) {
                              EXPECT_EQ(down, 1);
                            }
                          }
                          if (p.y >= kFace) {
                            EXPECT_EQ(up, 0);
                          }
                          if (p.y <= -kFace) {
                            EXPECT_EQ(down, 0);
                          }
                          // Just outside of a wall, half of the sky is hidden: that of half of the cells. Of
                          // rays almost along the wall, one may leave it before it crosses it.
                          const double along = p.x == kFace ? p.z : p.z == kFace ? p.x : kFace;
                          if (std::abs(p.y) < kFace && std::abs(along) < kFace) {
                            EXPECT_NEAR(up, 0.5, 1.0 / 256) << p.x << " " << p.y << " " << p.z;
                            EXPECT_NEAR(down, 0.5, 1.0 / 256) << p.x << " " << p.y << " " << p.z;
                          }
                        });
}

TEST(Occlusion, TexelsOnObliqueSheetsAreAllOnOneSide) {
  for (const glm::dvec2 slope :
       {glm::dvec2(0, 0), {3, 1}, {1, 0}, {-1, 0}, {0, 1}, {1, 1}, {1, -1}, {-1, -1}, {2, 0}, {0, -3}}) {
    // Through texels: odd multiples of 1/8, too.
    const double middle = std::fmod(slope.x + slope.y, 2) == 0 ? 0.125 : 0;
    const auto at = [&](double x, double z) { return glm::vec3(x, slope.x * x + slope.y * z + middle, z); };
    Mesh mesh;
    add_quad(mesh, at(-9, -9), at(9, -9), at(9, 9), at(-9, 9));
    // Right above a sheet, its slope hides a part of the sky.
    const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope.x, 1, -slope.y));
    const std::size_t mixed = reference::count_mixed_cells(
        16, [&](glm::dvec3 direction) { return glm::dot(direction, normal) < 0; });
    const double expected = (1 - normal.y) / 2, bound = sampling_bound(mixed, 256);
    int found = 0;
    for_each_texel_beside(mesh, [&](glm::dvec3 p, double up, double down) {
      if (p.y != slope.x * p.x + slope.y * p.z + middle) return;
      EXPECT_NEAR(up, expected, bound) << slope.x << " " << slope.y << ": " << p.x << " " << p.z;
      EXPECT_NEAR(down, expected, bound) << slope.x << " " << slope.y << ": " << p.x << " " << p.z;
      ++found;
    });
    EXPECT_GE(found, 8);
  }
}

TEST(Occlusion, TexelsOnAnObliqueWallAreAllOnOneSide) {
  constexpr float kEdge = 0.875f;
  const std::size_t mixed =
      reference::count_mixed_cells(16, [](glm::dvec3 direction) { return direction.x < direction.z; });
  for (const bool is_inside : {true, false}) {
    // The solid is where x > z, or where x < z.
    const glm::vec2 corner = is_inside ? glm::vec2(kEdge, -kEdge) : glm::vec2(-kEdge, kEdge);
    const Mesh mesh = make_prism({glm::vec2(-kEdge), glm::vec2(kEdge), corner}, -kEdge, kEdge);
    for_each_texel_beside(mesh, [&](glm::dvec3 p, double up, double down) {
      if (p.x != p.z || std::abs(p.x) > 0.7 || std::abs(p.y) > 0.7) return;
      const double bound = is_inside ? 0 : sampling_bound(mixed, 256);
      EXPECT_NEAR(up, is_inside ? 1 : 0.5, bound);
      EXPECT_NEAR(down, is_inside ? 1 : 0.5, bound);
    });
  }
}

TEST(Occlusion, TexelsAboveAllAreTracedNoDifferently) {
  Mesh mesh = make_knot();
  for (const float y : {-0.3f, 0.3f}) add_quad(mesh, {-2, y, -2}, {2, y, -2}, {2, y, 2}, {-2, y, 2});
  Mesh tall = mesh;
  // Points, which hide nothing.
  for (const float y : {-50.0f, 50.0f}) tall.push_back({{0, y, 0}, {0, y, 0}, {0, y, 0}});
  const OcclusionOptions options = options_of({5, 64, 4}, 100);
  const Occlusion a = bake(mesh, options), b = bake(tall, options);
  for (std::size_t i = 0; i < a.up.values.size(); ++i) {
    // Another tree may round a ray at an edge differently.
    EXPECT_NEAR(a.up.values[i], b.up.values[i], 1.0 / 100);
    EXPECT_NEAR(a.down.values[i], b.down.values[i], 1.0 / 100);
  }
}

TEST(Occlusion, AnyNumberOfThreadsGivesTheSame) {
  const Mesh mesh = make_knot();
  const std::array<OcclusionOptions, 4> cases{options_of({1, 1, 1}, 5000), options_of({7, 1, 3}, 1),
                                              options_of({33, 17, 5}, 37), options_of({3, 40, 2}, 64)};
  for (const OcclusionOptions& options : cases) {
    set_thread_count(1);
    const Occlusion one = bake(mesh, options);
    set_thread_count(4);
    const Occlusion four = bake(mesh, options);
    set_thread_count(0);
    EXPECT_EQ(one.up.values.size(), std::size_t{options.size.x} * options.size.y * options.size.z);
    EXPECT_EQ(one.up.values, four.up.values);
    EXPECT_EQ(one.down.values, four.down.values);
    EXPECT_TRUE(std::ranges::all_of(one.up.values, [](float value) { return value >= 0 && value <= 1; }));
  }
}

TEST(Occlusion, StopsWhenTold) {
  const Mesh mesh = make_knot();
  std::atomic<bool> stopped{true};
  const OcclusionOptions endless = options_of({64, 64, 64}, 1u << 24);
  const auto before = bake_occlusion(mesh, endless, &stopped);
  ASSERT_FALSE(before);
  EXPECT_EQ(before.failure().code, ErrorCode::internal);
  EXPECT_EQ(before.failure().message, "ambient occlusion: stopped");
  stopped = false;
  std::jthread stopper([&] { stopped = true; });
  EXPECT_FALSE(bake_occlusion(mesh, endless, &stopped));
}

TEST(Occlusion, RefusesTooManyTexels) {
  for (const std::uint32_t edge : {1u << 11, 1u << 16, ~0u}) {
    const auto result = bake_occlusion(make_knot(), options_of(glm::uvec3(edge), 1));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.failure().code, ErrorCode::resource_limit);
    EXPECT_NE(result.failure().message.find(std::to_string(edge)), std::string::npos);
  }
}

}  // namespace
}  // namespace brume::bake
