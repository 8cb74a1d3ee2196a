// Rays through voxels against all spheres, in extended precision.
#include "spheres/trace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <vector>

#include "core/tasks.hpp"
#include "spheres/light.hpp"
#include "spheres/paint.hpp"
#include "tests/sanitized.hpp"
#include "tests/spheres/test_tanks.hpp"

namespace brume::spheres {
namespace {

using glm::dvec3;
using glm::vec3;

struct Ray {
  vec3 origin, direction;
  float t_max = kNoEnd;
};

struct TracedTank {
  explicit TracedTank(Tank with)
      : tank(std::move(with)), bricks(list_bricks(tank)), ids(make_ids(tank, bricks)) {}
  TankView view() const { return {tank, bricks, ids}; }
  Tank tank;
  BrickLists bricks;
  VoxelIds ids;
};

// A sphere's chord in extended precision, and how far off t may be in double [t].
struct ExactChord {
  bool hits = false, unsure = false;  // by the discriminant, whose sign may be rounding
  long double enter = 0, leave = 0;
  double error = 0;
};

// The error of chord_of, u = 2^-53, all lengths in voxels, f the origin seen from the sphere's middle, r the
// radius, h half of the chord:
// - the nearest point has two dots (3 u each), a quotient, product and sum per component: at most 10 u |f|;
// - the discriminant twice that times r at a hit, and its own dot, squares and difference: 20 u |f| r + 6 u
// r^2;
// - h by it: that over 2 h, and never more than its square root; half of it again for the square root's own;
// - b / a: 6 u |f|; f f - r^2: 6 u (|f|^2 + r^2), which q = b + h divides: q >= h, and q >= |f| / 2 unless
//   |f| < 4 r. The sum of the two in units of length: 6 u |f| + 6 u (|f|^2 + r^2) / q.
ExactChord exact_chord(const Sphere& sphere, const Ray& ray) {
  constexpr double u = 0x1p-53;
  long double a = 0, b = 0, ff = 0, cross = 0;
  long double f[3], d[3];
  for (int i = 0; i < 3; ++i) {
    f[i] = static_cast<long double>(ray.origin[i]) - static_cast<long double>(sphere.center[i]);
    d[i] = static_cast<long double>(ray.direction[i]);
    a += d[i] * d[i];
    b -= f[i] * d[i];
    ff += f[i] * f[i];
  }
  // The squared distance to the line by a cross product: another form than the tested one.
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const long double c = f[j] * d[k] - f[k] * d[j];
    cross += c * c;
  }
  const long double r = static_cast<long double>(sphere.radius);
  const long double discriminant = r * r - cross / a;
  const auto distance = static_cast<double>(std::sqrt(ff)), radius = static_cast<double>(r);
  const double uncertain = 20 * u * distance * radius + 6 * u * radius * radius;
  ExactChord chord;
  chord.unsure = std::abs(static_cast<double>(discriminant)) <= uncertain;
  chord.hits = discriminant > 0;
  if (!chord.hits) return chord;
  const long double h = std::sqrt(discriminant), middle = b / a, length = std::sqrt(a);
  chord.enter = middle - h / length;
  chord.leave = middle + h / length;
  const auto half = static_cast<double>(h);
  const double of_half = 1.5 * std::min(uncertain / (2 * half), std::sqrt(uncertain)) + 2 * u * half;
  const double q = std::abs(static_cast<double>(b / length)) + half;
  const double of_ends = 6 * u * distance + 6 * u * (distance * distance + radius * radius) / q;
  chord.error = 2 * (of_half + of_ends) / static_cast<double>(length);
  return chord;
}

// All spheres that may meet the line: in double, with room for rounding.
std::vector<std::uint32_t> near_line(const Tank& tank, const Ray& ray) {
  std::vector<std::uint32_t> found;
  const double dx = ray.direction.x, dy = ray.direction.y, dz = ray.direction.z;
  const double a = dx * dx + dy * dy + dz * dz;
  for (std::size_t i = 0; i < tank.spheres.size(); ++i) {
    const Sphere& s = tank.spheres[i];
    const double x = double{s.center.x} - double{ray.origin.x}, y = double{s.center.y} - double{ray.origin.y},
                 z = double{s.center.z} - double{ray.origin.z};
    const double t = (x * dx + y * dy + z * dz) / a;
    const double ex = x - t * dx, ey = y - t * dy, ez = z - t * dz, r = s.radius;
    if (ex * ex + ey * ey + ez * ez <= r * r * 1.0001) found.push_back(static_cast<std::uint32_t>(i));
  }
  return found;
}

// Rays at random places, along axes, on planes of voxels, through their edges and corners, past spheres.
Ray random_ray(Random& random, const Tank& tank) {
  Ray ray;
  const bool on_lattice = random() % 4 == 0;
  const float far = random() % 16 == 0 ? 50.0f : 1.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const auto size = static_cast<float>(tank.size[axis]);
    ray.origin[axis] =
        random() % 2 ? uniform(random, 0, size) : uniform(random, -far * size, (1 + far) * size);
    if (on_lattice) ray.origin[axis] = std::round(2 * ray.origin[axis]) / 2;
    ray.direction[axis] = uniform(random, -1, 1);
  }
  const Sphere& target = tank.spheres[random() % tank.spheres.size()];
  const vec3 to_target = target.center - ray.origin;
  const vec3 across = glm::cross(to_target, vec3(uniform(random, -1, 1), uniform(random, -1, 1), 0.7f));
  switch (random() % 8) {
    case 0: {  // along an axis
      const int axis = static_cast<int>(random() % 3);
      for (int other = 0; other < 3; ++other)
        if (other != axis) ray.direction[other] = random() % 2 ? 0.0f : -0.0f;
      break;
    }
    case 1:  // in planes; nearly so
      ray.direction[static_cast<int>(random() % 3)] *= random() % 2 ? 0 : 1e-6f;
      break;
    case 2:  // through edges and corners
      for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = static_cast<float>(random() % 3) - 1;
      break;
    case 3:
    case 4:  // grazing a sphere, outside or inside by 1e-7 to 1e-1 of its radius
      if (glm::length(across) > 0) {
        const float off = std::pow(10.0f, uniform(random, -7, -1)) * (random() % 2 ? 1.0f : -1.0f);
        ray.direction = to_target + glm::normalize(across) * target.radius * (1 + off);
      }
      break;
    case 5:
      ray.direction = to_target;
      break;
    default:
      break;
  }
  if (ray.direction == vec3(0)) ray.direction.x = 1;
  ray.direction *= std::pow(2.0f, uniform(random, -3, 3));
  if (random() % 4 == 0) ray.t_max = uniform(random, 0, 20);
  return ray;
}

// How often a test could not decide by rounding.
struct Tally {
  std::size_t hits = 0, unsure = 0;
};

// The result of first_hit against all spheres.
void check_first(const TracedTank& traced, const Ray& ray, Tally& tally) {
  const auto hit = first_hit(traced.view(), ray.origin, ray.direction, ray.t_max);
  ExactChord best;
  std::uint32_t best_id = 0;
  const auto found = near_line(traced.tank, ray);
  for (const std::uint32_t i : found) {
    const ExactChord chord = exact_chord(traced.tank.spheres[i], ray);
    // Rounding may decide these: whether it is touched, begins outside, ends before.
    const long double t_max = static_cast<long double>(ray.t_max);
    if (chord.unsure || (chord.hits && (std::abs(static_cast<double>(chord.enter)) <= chord.error ||
                                        std::abs(static_cast<double>(chord.enter - t_max)) <= chord.error))) {
      ++tally.unsure;
      return;
    }
    if (!chord.hits || chord.enter < 0 || chord.enter > t_max) continue;
    if (best_id == 0 || chord.enter < best.enter) {
      best = chord;
      best_id = i + 1;
    }
  }
  ASSERT_EQ(hit.has_value(), best_id != 0);
  if (!hit) return;
  ++tally.hits;
  const ExactChord own = exact_chord(traced.tank.spheres[hit->id - 1], ray);
  const auto off = [&](long double t) { return std::abs(static_cast<double>(hit->t - t)); };
  ASSERT_TRUE(own.hits);
  ASSERT_LE(off(own.enter), own.error);
  if (hit->id != best_id) {
    ASSERT_LE(static_cast<double>(own.enter - best.enter), own.error + best.error);
  }
  // The normal: from the middle to the point, which is off by the error of t and the rounding of its sum.
  const Sphere& sphere = traced.tank.spheres[hit->id - 1];
  const dvec3 direction(ray.direction), origin(ray.origin);
  const double length = glm::length(direction);
  const double point_error = own.error * length + 0x1p-51 * (glm::length(origin) + std::abs(hit->t) * length +
                                                             glm::length(dvec3(sphere.center)));
  const dvec3 expected =
      (origin + static_cast<double>(own.enter) * direction - dvec3(sphere.center)) / double{sphere.radius};
  ASSERT_LE(glm::length(hit->normal - expected), 3 * point_error / double{sphere.radius} + 0x1p-50);
  ASSERT_NEAR(glm::length(hit->normal), 1, 0x1p-51);
}

// The chords of visit_chords against all spheres.
void check_chords(const TracedTank& traced, const Ray& ray, Tally& tally) {
  std::vector<Chord> visited;
  visit_chords(traced.view(), ray.origin, ray.direction, ray.t_max, [&](const Chord& chord) {
    visited.push_back(chord);
    return true;
  });
  ASSERT_TRUE(std::is_sorted(visited.begin(), visited.end(),
                             [](const Chord& a, const Chord& b) { return a.enter < b.enter; }));
  std::size_t expected = 0;
  for (const std::uint32_t i : near_line(traced.tank, ray)) {
    const ExactChord chord = exact_chord(traced.tank.spheres[i], ray);
    const double t_max = ray.t_max;
    const auto enter = static_cast<double>(chord.enter), leave = static_cast<double>(chord.leave);
    const auto same = [&](const Chord& other) { return other.id == i + 1; };
    const auto at = std::find_if(visited.begin(), visited.end(), same);
    ASSERT_LE(std::count_if(visited.begin(), visited.end(), same), 1);
    const bool is_unsure =
        chord.unsure ||
        (chord.hits && (std::abs(leave) <= chord.error || std::abs(enter - t_max) <= chord.error));
    if (is_unsure) {
      ++tally.unsure;
      expected += at != visited.end();
      continue;
    }
    const bool crosses = chord.hits && leave > 0 && enter < t_max;
    ASSERT_EQ(at != visited.end(), crosses);
    if (!crosses) continue;
    ++expected;
    ++tally.hits;
    ASSERT_NEAR(at->enter, std::max(enter, 0.0), chord.error + 0x1p-52 * std::abs(enter));
    ASSERT_NEAR(at->leave, std::min(leave, t_max), chord.error + 0x1p-52 * std::abs(leave));
  }
  ASSERT_EQ(visited.size(), expected);
}

// Spheres smaller than the rounding of t far away, next to edges and corners of voxels: where planes of two
// axes are crossed in the wrong order, all of a sphere may be in a voxel that the DDA leaves out.
Tank tank_of_dust(Random& random) {
  Tank tank;
  tank.size = {64, 64, 64};
  for (int i = 0; i < 60; ++i) {
    Sphere sphere{vec3(0), uniform(random, 0.00005f, 0.0003f)};
    for (int axis = 0; axis < 3; ++axis) {
      const auto plane = static_cast<float>(i % 2 ? 1 + random() % 63 : 8 + 8 * (random() % 7));  // of bricks
      sphere.center[axis] = plane + uniform(random, -0.0006f, 0.0006f);
    }
    sphere.center[int(random() % 3)] += random() % 2 ? 0.5f : 0.0f;
    tank.spheres.push_back(sphere);
    tank.colors.push_back(0);
  }
  return tank;
}

Ray ray_from_afar(Random& random, const Tank& tank) {
  Ray ray;
  for (int axis = 0; axis < 3; ++axis) ray.origin[axis] = uniform(random, -8000, 8000);
  const Sphere& target = tank.spheres[random() % tank.spheres.size()];
  ray.direction = target.center - ray.origin;
  return ray;
}

std::vector<TracedTank> tanks_of_rays() {
  Random random(11);
  std::vector<TracedTank> tanks;
  tanks.emplace_back(thrown_tank({40, 33, 21}, 700, 0.2f, 6, random));     // mixed
  tanks.emplace_back(jittered_tank({8, 8, 9}, 1.2f, 0.2f, random));        // overflows
  tanks.emplace_back(thrown_tank({600, 500, 200}, 60, 0.2f, 40, random));  // mostly empty bricks
  tanks.emplace_back(thrown_tank({1, 1, 1}, 40, 0.02f, 0.3f, random));
  tanks.emplace_back(thrown_tank({64, 64, 64}, 200, 0.2f, 0.4f, random));  // tiny and sparse
  return tanks;
}

template <typename Check>
Tally check_rays(std::size_t count, const Check& check) {
  const std::vector<TracedTank> tanks = tanks_of_rays();
  std::mutex mutex;
  Tally all;
  parallel_for(count, 5000, [&](std::size_t begin, std::size_t end) {
    Random random(static_cast<std::uint32_t>(begin) + 100);
    Tally tally;
    for (std::size_t i = begin; i < end && !testing::Test::HasFatalFailure(); ++i) {
      const TracedTank& traced = tanks[i % tanks.size()];
      const Ray ray = random_ray(random, traced.tank);
      SCOPED_TRACE("ray " + std::to_string(i));
      check(traced, ray, tally);
    }
    const std::lock_guard lock(mutex);
    all.hits += tally.hits;
    all.unsure += tally.unsure;
  });
  return all;
}

constexpr std::size_t kRays = kSanitized ? 20000 : 1000000;

TEST(FirstHit, EqualsAllSpheresForAMillionRays) {
  const Tally tally = check_rays(kRays, check_first);
  EXPECT_GT(tally.hits, kRays / 4);
  EXPECT_LT(tally.unsure, kRays / 1000);
}

TEST(FirstHit, MissesNoneNextToEdgesFromAfar) {
  Random random(31);
  const TracedTank traced(tank_of_dust(random));
  Tally tally;
  for (std::size_t i = 0; i < kRays / 2 && !HasFatalFailure(); ++i)
    check_first(traced, ray_from_afar(random, traced.tank), tally);
  EXPECT_GT(tally.hits, kRays / 100);
}

TEST(VisitChords, EqualAllSpheres) {
  const Tally tally = check_rays(kRays / 4, check_chords);
  EXPECT_GT(tally.hits, kRays / 10);
  EXPECT_LT(tally.unsure, kRays / 1000);
}

// One sphere of half transparency and an opaque one, on a line along x.
Tank two_spheres() {
  Tank tank;
  tank.size = {32, 8, 8};
  tank.spheres = {{{8, 4, 4}, 3}, {{20, 4, 4}, 2}};
  tank.colors = {0x80ffffffu, 0xff0000ffu};
  return tank;
}

TEST(Transmittance, FollowsBeerAlongTheChord) {
  const TracedTank traced(two_spheres());
  const double per_voxel = 1 - 128.0 / 255;
  const vec3 x(1, 0, 0);
  EXPECT_NEAR(transmittance(traced.view(), {-4, 4, 4}, x, 20), std::pow(per_voxel, 6), 1e-15);
  EXPECT_NEAR(transmittance(traced.view(), {-4, 4, 4}, 2.0f * x, 10), std::pow(per_voxel, 6), 1e-15);
  EXPECT_NEAR(transmittance(traced.view(), {8, 4, 4}, x, 8), std::pow(per_voxel, 3), 1e-15);  // from inside
  EXPECT_NEAR(transmittance(traced.view(), {8, 4, 4}, x, 1), per_voxel, 1e-15);
  EXPECT_EQ(transmittance(traced.view(), {-4, 4, 4}, x, 23), 0);
  EXPECT_EQ(transmittance(traced.view(), {20, 4, 4}, x, 1), 0);
  EXPECT_EQ(transmittance(traced.view(), {0, 0.5f, 4}, x, 40), 1);
}

TEST(FirstHit, NormalsAndRaysThatAreNone) {
  const TracedTank traced(two_spheres());
  const auto hit = first_hit(traced.view(), {-4, 4, 4}, {2, 0, 0});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->id, 1u);
  EXPECT_EQ(hit->t, 4.5);
  EXPECT_EQ(hit->normal, dvec3(-1, 0, 0));
  EXPECT_EQ(first_hit(traced.view(), {8, 4, 4}, {1, 0, 0})->id, 2u);  // leaves the first
  EXPECT_FALSE(first_hit(traced.view(), {-4, 4, 4}, {2, 0, 0}, 4.4f));
  EXPECT_FALSE(first_hit(traced.view(), {-4, 4, 4}, {0, 0, 0}));
  EXPECT_FALSE(first_hit(traced.view(), {-4, NAN, 4}, {1, 0, 0}));
  EXPECT_FALSE(first_hit(traced.view(), {-4, 4, 4}, {INFINITY, 0, 0}));
}

TEST(SphereChord, InFloatsIsThatInDouble) {
  // Terms of exact_chord's bound in floats, u = 2^-24 instead of 2^-53.
  Random random(21);
  std::size_t hits = 0;
  for (int i = 0; i < 100000; ++i) {
    const Tank tank{{100, 100, 100}, 1, {{vec3(uniform(random, 20, 80)), uniform(random, 0.2f, 20)}}, {0}};
    Ray ray = random_ray(random, tank);
    ray.direction = glm::normalize(ray.direction);
    const ExactChord exact = exact_chord(tank.spheres[0], ray);
    const glm::vec2 chord = shared::sphere_chord(packed(tank.spheres[0]), ray.origin, ray.direction);
    const double radius = tank.spheres[0].radius;
    const double distance = glm::length(dvec3(ray.origin) - dvec3(tank.spheres[0].center));
    const double uncertain = 0x1p-24 * (20 * distance * radius + 6 * radius * radius);
    const double length = glm::length(dvec3(ray.direction));
    const double half = exact.hits ? static_cast<double>(exact.leave - exact.enter) / 2 * length : 0;
    if (half * half <= uncertain) continue;  // also those that are missed by less
    ++hits;
    ASSERT_LE(chord.x, chord.y);
    const double error = exact.error * 0x1p29;  // + the difference origin - middle: u |f| of each component
    const double bound = error + 2 * 0x1p-24 * distance * (1 + radius / half) / length;
    ASSERT_NEAR(double{chord.x}, static_cast<double>(exact.enter), bound) << i;
    ASSERT_NEAR(double{chord.y}, static_cast<double>(exact.leave), bound) << i;
  }
  EXPECT_GT(hits, 20000u);
}

TEST(ExactLight, IsTheProductOverVoxels) {
  const glm::uvec3 size(9, 5, 3);
  std::vector<Color> paint(std::size_t{size.x} * size.y * size.z);
  const auto at = [&](int x, int y, int z) -> Color& { return paint[std::size_t((z * 5 + y) * 9 + x)]; };
  at(2, 2, 1) = 0x40000000u;
  at(4, 2, 1) = 0x80ffffffu;
  at(8, 4, 2) = 0xffu << 24;
  const double a = 1 - 64.0 / 255, b = 1 - 128.0 / 255;
  // t is float: its error is 3 * 2^-24 of a length of up to 8, times -ln b < 0.7.
  constexpr double kError = 4 * 3 * 0x1p-24 * 8;
  EXPECT_EQ(exact_light(paint, size, {0.5f, 2.5f, 1.5f}, {1, 2, 1}), 1);
  EXPECT_NEAR(exact_light(paint, size, {0.5f, 2.5f, 1.5f}, {6, 2, 1}), a * b, kError);
  EXPECT_NEAR(exact_light(paint, size, {0.5f, 2.5f, 1.5f}, {4, 2, 1}), a, kError);  // without itself
  EXPECT_NEAR(exact_light(paint, size, {4.25f, 2.5f, 1.5f}, {7, 2, 1}), std::pow(b, 0.75), kError);
  EXPECT_NEAR(exact_light(paint, size, {-50, 2.5f, 1.5f}, {4, 2, 1}), a, 10 * kError);
  EXPECT_EQ(exact_light(paint, size, {4.5f, 2.5f, 1.5f}, {4, 2, 1}), 1);  // at the light
  EXPECT_EQ(exact_light(paint, size, {30, 4.5f, 2.5f}, {7, 4, 2}), 0);
  // Along a diagonal: sqrt(3) per voxel, which is (3, 3, 1) and (4, 2, 1) of the tank's.
  const double diagonal = std::sqrt(2.0);
  EXPECT_NEAR(exact_light(paint, size, {6.5f, 0.5f, 1.5f}, {3, 3, 1}), std::pow(b, diagonal), kError);
}

}  // namespace
}  // namespace brume::spheres
