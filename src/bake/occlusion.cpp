// Rays of ambient occlusion with Embree: 16 of one texel at a time, of neighbouring directions, which is
// faster than 16 neighbouring texels with one direction, than 8 rays or 1, and than Embree's paths for
// coherent rays.
#include "bake/occlusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/checked.hpp"
#include "core/progress.hpp"
#include "core/tasks.hpp"
#include "shared/hash.h"
#include "trace/low_discrepancy.hpp"
#include "trace/triangle_tree.hpp"

namespace brume::bake {
namespace {

constexpr std::uint64_t kMostTexels = std::uint64_t{1} << 32;
constexpr std::size_t kMostTriangles = 1'000'000'000;  // Their corners have 32-bit indices.
constexpr std::size_t kLanes = 16;

bool is_stopped(const std::atomic<bool>* stopped) {
  return stopped && stopped->load(std::memory_order_relaxed);
}

Failure stopped_failure() {
  return {ErrorCode::internal, "ambient occlusion: stopped"};
}

/// Where floats are precise: the middle of the box is 0, half of its longest edge is 1.
struct UnitSpace {
  glm::dvec3 middle_world;
  double per_metre;

  explicit UnitSpace(const Box<double>& box)
      : middle_world(box.low + 0.5 * (box.high - box.low)),
        per_metre(2 / std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z})) {}
  glm::dvec3 from_world(glm::dvec3 p_world) const { return per_metre * (p_world - middle_world); }
};

// Directions.

/// From a square to the unit disk, areas in proportion: Shirley and Chiu 1997, "A Low Distortion Map Between
/// Disk and Square".
glm::dvec2 disk_from_square(std::uint32_t u, std::uint32_t v) {
  // The middle of 2^-32, which is never 0.
  const double a = (u + 0.5) * 0x1p-31 - 1, b = (v + 0.5) * 0x1p-31 - 1;
  constexpr double kEighth = 0.25 * 3.14159265358979323846;
  if (std::abs(a) > std::abs(b)) return a * glm::dvec2(std::cos(kEighth * b / a), std::sin(kEighth * b / a));
  return b * glm::dvec2(std::sin(kEighth * a / b), std::cos(kEighth * a / b));
}

/// A part of the rays of several texels: sets of directions around +y, cosine-weighted, each scrambled on its
/// own. One set after the other, in whole packets.
class RaySets {
 public:
  /// Rays begin..begin + rays of each set, which are several packets of neighbours.
  RaySets(std::uint32_t sets, std::uint32_t begin, std::uint32_t rays, std::uint32_t seed)
      : sets_(sets), rays_(rays), room_((rays + kLanes - 1) / kLanes * kLanes) {
    for (auto* const part : {&x, &y, &z}) part->resize(sets * room_);
    parallel_for(sets, 8, [&](std::size_t first, std::size_t end) {
      for (std::size_t set = first; set < end; ++set) fill(static_cast<std::uint32_t>(set), begin, seed);
    });
  }

  std::uint32_t sets() const { return sets_; }
  std::uint32_t rays() const { return rays_; }
  std::size_t first(std::uint32_t set) const { return set * room_; }

  std::vector<float> x, y, z;

 private:
  void fill(std::uint32_t set, std::uint32_t begin, std::uint32_t seed) {
    // Scramble the points.
    struct Point {
      std::uint64_t order;
      std::uint32_t u, v;
    };
    std::vector<Point> points(rays_);
    const glm::uvec3 seeds = shared::pcg3d({set, seed, 0x6f63636cu});
    for (std::uint32_t i = 0; i < rays_; ++i) {
      Point& p = points[i];
      p.u = trace::first_scrambled(begin + i, seeds.x);
      p.v = trace::second_scrambled(begin + i, seeds.y);
      p.order = trace::interleaved(p.u, p.v);
    }
    // Put neighbours beside each other: in Morton order.
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.order < b.order; });
    // Raise them from the disk to the hemisphere (Malley).
    for (std::uint32_t i = 0; i < rays_; ++i) {
      const glm::dvec2 disk = disk_from_square(points[i].u, points[i].v);
      const std::size_t to = first(set) + i;
      x[to] = static_cast<float>(disk.x);
      y[to] = static_cast<float>(std::sqrt(std::max(0.0, 1 - glm::dot(disk, disk))));
      z[to] = static_cast<float>(disk.y);
    }
  }

  std::uint32_t sets_, rays_;
  std::size_t room_;
};

// The mesh.

/// The triangles as Embree traces them.
class Occluders {
 public:
  /// Corners in unit space, three for each triangle, at least one triangle.
  Result<void> build(std::span<const glm::vec3> corners, const std::atomic<bool>* stopped);

  /// How many rays of a set hit a triangle, from a point in unit space; `side` -1 mirrors them to -y.
  std::uint32_t count_hidden(const RaySets& sets, std::uint32_t set, glm::vec3 from, float side) const;

  /// The first error since the start, of any thread.
  Result<void> check() const { return tree_.check(); }

 private:
  trace::TriangleTree tree_;
  float low_ = 0, high_ = 0;  // Along y.
};

Result<void> Occluders::build(std::span<const glm::vec3> corners, const std::atomic<bool>* stopped) {
  std::vector<std::uint32_t> indices(corners.size());
  std::iota(indices.begin(), indices.end(), 0u);
  const trace::TriangleMesh mesh{corners, indices};
  if (auto built = tree_.build("ambient occlusion", {&mesh, 1}, stopped); !built) return built;
  const auto [low, high] =
      std::minmax_element(corners.begin(), corners.end(), [](glm::vec3 a, glm::vec3 b) { return a.y < b.y; });
  low_ = low->y;
  high_ = high->y;
  return {};
}

std::uint32_t Occluders::count_hidden(const RaySets& sets, std::uint32_t set, glm::vec3 from,
                                      float side) const {
  if (side > 0 ? from.y > high_ : from.y < low_) return 0;
  // What all packets have in common.
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay16 rays;
  alignas(64) std::array<int, kLanes> active;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    rays.org_x[lane] = from.x;
    rays.org_y[lane] = from.y;
    rays.org_z[lane] = from.z;
    rays.tnear[lane] = rays.time[lane] = 0;
    rays.mask[lane] = ~0u;
    rays.id[lane] = rays.flags[lane] = 0;
  }
  // Trace them.
  std::uint32_t hidden = 0;
  for (std::uint32_t begin = 0; begin < sets.rays(); begin += kLanes) {
    const std::size_t at = sets.first(set) + begin;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      rays.dir_x[lane] = sets.x[at + lane];
      rays.dir_y[lane] = side * sets.y[at + lane];
      rays.dir_z[lane] = sets.z[at + lane];
      rays.tfar[lane] = std::numeric_limits<float>::infinity();
      active[lane] = begin + lane < sets.rays() ? -1 : 0;
    }
    trace::embree().Occluded16(active.data(), tree_.scene(), &context, &rays);
    for (std::size_t lane = 0; lane < kLanes; ++lane) hidden += rays.tfar[lane] < 0;  // -infinity: a hit
  }
  return hidden;
}

/// The corners of the triangles that can hide something, in unit space.
std::vector<glm::vec3> corners_in(const UnitSpace& space, std::span<const voxel::Triangle> triangles) {
  // Products of three such coordinates are far from the largest float.
  constexpr double kReach = 2e11;
  std::vector<glm::vec3> corners;
  corners.reserve(3 * triangles.size());
  for (const voxel::Triangle& triangle : triangles) {
    const std::array points{space.from_world(glm::dvec3(triangle.a)),
                            space.from_world(glm::dvec3(triangle.b)),
                            space.from_world(glm::dvec3(triangle.c))};
    // Comparisons with NaN are false.
    if (std::ranges::all_of(points, [](glm::dvec3 p) {
          return std::abs(p.x) < kReach && std::abs(p.y) < kReach && std::abs(p.z) < kReach;
        }))
      for (const glm::dvec3 p : points) corners.emplace_back(p);
  }
  return corners;
}

// The bake.

/// Which texels, and where their rays start.
class Texels {
 public:
  Texels(const OcclusionOptions& options, const UnitSpace& space) : options_(options), space_(space) {
    // Far more than floats round, so that neighbours on one plane start on one side of it. Mostly along y:
    // that side is then where the rays go. The others differ, so that usual walls do not contain the offset.
    const glm::dvec3 edges = space.per_metre * voxel_size();
    const double offset = std::max(1e-3 * std::min({edges.x, edges.y, edges.z}), 1e-5);
    offset_ = offset * glm::dvec3(0.25, 0.95, 0.11);
  }

  /// In unit space; `side` is 1 for rays around +y and -1 around -y.
  glm::vec3 start(std::size_t texel, double side) const {
    const glm::uvec3 size = options_.size;
    const glm::dvec3 voxel(texel % size.x, texel / size.x % size.y, texel / size.x / size.y);
    const glm::dvec3 middle = options_.box.low + voxel_size() * (voxel + 0.5);
    return glm::vec3(space_.from_world(middle) + glm::dvec3(offset_.x, side * offset_.y, offset_.z));
  }

  /// The set of rays that a texel takes: neighbours rarely take the same.
  std::uint32_t set(std::size_t texel, std::uint32_t side, std::uint32_t sets) const {
    const auto low = static_cast<std::uint32_t>(texel);
    return shared::pcg3d({low, options_.seed, side}).x % sets;
  }

 private:
  glm::dvec3 voxel_size() const { return (options_.box.high - options_.box.low) / glm::dvec3(options_.size); }

  const OcclusionOptions& options_;
  const UnitSpace& space_;
  glm::dvec3 offset_;
};

/// Adds the hidden rays of a part of all rays to the values of each texel.
void trace(const Occluders& occluders, const RaySets& sets, const Texels& texels, Occlusion& occlusion,
           const std::atomic<bool>* stopped, Progress& job) {
  parallel_for(occlusion.up.values.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t texel = begin; texel < end && !is_stopped(stopped); ++texel) {
      const auto hidden = [&](std::uint32_t number, float side) {
        return static_cast<float>(occluders.count_hidden(sets, texels.set(texel, number, sets.sets()),
                                                         texels.start(texel, double{side}), side));
      };
      // Floats hold whole numbers up to 2^24 exactly.
      occlusion.up.values[texel] += hidden(0, 1);
      occlusion.down.values[texel] += hidden(1, -1);
    }
    job.advance(end - begin);
  });
}

Result<Occlusion> bake(std::span<const voxel::Triangle> triangles, const OcclusionOptions& options,
                       std::size_t texel_count, const std::atomic<bool>* stopped) {
  // Nothing hides nothing.
  Occlusion occlusion;
  for (grids::DenseGrid* const grid : {&occlusion.up, &occlusion.down}) {
    grid->name = grid == &occlusion.up ? "up" : "down";
    grid->size = options.size;
    grid->box = options.box;
    grid->values.assign(texel_count, 0);
  }
  // Rays are traced part by part, so that the directions of many require little memory.
  constexpr std::uint32_t kRaysAtATime = 4096, kMostSets = 256;
  Progress job("occlusion", texel_count * ((options.rays + kRaysAtATime - 1) / kRaysAtATime));
  const UnitSpace space(options.box);
  std::vector<glm::vec3> corners = corners_in(space, triangles);
  if (is_stopped(stopped)) return stopped_failure();
  if (corners.empty()) return occlusion;
  Occluders occluders;
  if (const auto built = occluders.build(corners, stopped); !built) return built.failure();
  corners = {};

  // Trace
  const Texels texels(options, space);
  const auto sets = static_cast<std::uint32_t>(std::min<std::size_t>(2 * texel_count, kMostSets));
  for (std::uint32_t begin = 0; begin < options.rays && !is_stopped(stopped); begin += kRaysAtATime) {
    const RaySets part(sets, begin, std::min(options.rays - begin, kRaysAtATime), options.seed);
    trace(occluders, part, texels, occlusion, stopped, job);
  }
  if (is_stopped(stopped)) return stopped_failure();
  if (const auto fine = occluders.check(); !fine) return fine.failure();
  for (auto* const values : {&occlusion.up.values, &occlusion.down.values})
    for (float& value : *values) value /= static_cast<float>(options.rays);
  return occlusion;
}

bool is_valid(const OcclusionOptions& options) {
  const glm::dvec3 edges = options.box.high - options.box.low;
  for (int axis = 0; axis < 3; ++axis)
    if (!(edges[axis] > 0 && std::isfinite(edges[axis])) || options.size[axis] == 0) return false;
  return options.rays >= 1 && options.rays <= 1u << 24;
}

}  // namespace

Result<Occlusion> bake_occlusion(std::span<const voxel::Triangle> triangles, const OcclusionOptions& options,
                                 const std::atomic<bool>* stopped) {
  BRUME_ASSERT(is_valid(options), std::to_string(options.rays));
  const glm::uvec3 size = options.size;
  const std::string text =
      std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z) + " texels";
  const auto texels = checked_mul(size.x, size.y, size.z);
  if (!texels || *texels > kMostTexels)
    return Failure{ErrorCode::resource_limit,
                   "ambient occlusion: " + text + " are more than 2^32; choose a smaller size"};
  if (triangles.size() > kMostTriangles)
    return Failure{ErrorCode::resource_limit, "ambient occlusion: the mesh has " +
                                                  std::to_string(triangles.size()) +
                                                  " triangles, more than 10^9; simplify it"};
  try {
    return bake(triangles, options, *texels, stopped);
  } catch (const std::bad_alloc&) {
    return Failure{ErrorCode::resource_limit, "ambient occlusion: not enough memory for " + text + " and " +
                                                  std::to_string(triangles.size()) +
                                                  " triangles; choose a smaller size"};
  }
}

grids::DenseGrid combine_occlusion(const Occlusion& occlusion, const OcclusionCurve& curve) {
  const grids::DenseGrid &up = occlusion.up, &down = occlusion.down;
  BRUME_ASSERT(up.size == down.size && up.values.size() == down.values.size(), std::to_string(up.size.y));
  BRUME_ASSERT(curve.gamma > 0 && curve.correction >= 0 && curve.correction <= 1 && curve.falloff >= 0,
               std::to_string(curve.gamma));
  grids::DenseGrid combined = up;
  combined.name = "combined";
  const std::size_t rows = std::size_t{up.size.y} * up.size.z;
  parallel_for(rows, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const double slice = static_cast<double>(row % up.size.y);
      const double distance = std::abs(2 * slice + 1 - up.size.y) / up.size.y;
      const double exponent =
          1 + (curve.gamma - 1) * curve.correction * std::pow(1 - distance, curve.falloff);
      for (std::size_t i = row * up.size.x; i < (row + 1) * up.size.x; ++i)
        combined.values[i] =
            static_cast<float>(std::pow(double{std::max(up.values[i], down.values[i])}, exponent));
    }
  });
  return combined;
}

}  // namespace brume::bake
