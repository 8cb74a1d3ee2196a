#include "bake/coverage.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "bake/mean_winding.hpp"
#include "bake/winding_number.hpp"
#include "core/progress.hpp"
#include "core/tasks.hpp"

namespace brume::bake {
namespace {

using glm::dvec3;
using glm::vec3;
using voxel::Triangle;

// Fractions this near to 0 or 1 are taken for rounding errors, which reach 2e-10 for a mesh a million voxels
// long.
constexpr double kRounding = 1e-9;
// Beside a sheet the winding number comes near to 1/2, to either side by the approximation.
constexpr double kInside = 0.5 + WindingTree::kError;
// Assumed to be more than the change of the winding number in half a voxel that no triangle crosses.
constexpr double kNearBorder = 0.25;
constexpr int kSamples = 4;  // Per axis of a voxel.

bool is_before(const vec3& a, const vec3& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

// The triangles with finite corners in an order that depends only on where they are: the least corner of each
// first, and 0 for -0.
std::vector<Triangle> in_order(std::span<const Triangle> triangles) {
  std::vector<Triangle> ordered;
  ordered.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    std::array<vec3, 3> corners{t.a + 0.0f, t.b + 0.0f, t.c + 0.0f};
    bool finite = true;
    for (const vec3& p : corners)
      finite = finite && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    if (!finite) continue;
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), is_before), corners.end());
    ordered.push_back({corners[0], corners[1], corners[2]});
  }
  std::sort(ordered.begin(), ordered.end(), [](const Triangle& s, const Triangle& t) {
    if (s.a != t.a) return is_before(s.a, t.a);
    if (s.b != t.b) return is_before(s.b, t.b);
    return is_before(s.c, t.c);
  });
  return ordered;
}

struct PositionHash {
  std::size_t operator()(const vec3& p) const {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(p[axis])) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

// Counts the edges that are not used equally often in both directions.
std::size_t count_open_edges(const std::vector<Triangle>& triangles) {
  // Number the positions.
  std::unordered_map<vec3, std::uint32_t, PositionHash> numbers;
  numbers.reserve(triangles.size());
  const auto number = [&](const vec3& p) {
    return numbers.try_emplace(p, static_cast<std::uint32_t>(numbers.size())).first->second;
  };

  // Each edge from its lower to its higher number, then whether the triangle uses it backwards.
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    const std::array<std::uint32_t, 3> corners{number(t.a), number(t.b), number(t.c)};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % 3]);
      edges.push_back(std::uint64_t{low} << 33 | std::uint64_t{high} << 1 | (low != corners[i]));
    }
  }
  std::sort(edges.begin(), edges.end());

  // Compare both directions of each.
  std::size_t open = 0;
  for (std::size_t i = 0; i < edges.size();) {
    const std::uint64_t edge = edges[i] >> 1;
    std::ptrdiff_t balance = 0;
    for (; i < edges.size() && edges[i] >> 1 == edge; ++i) balance += edges[i] & 1 ? -1 : 1;
    open += balance != 0;
  }
  return open;
}

// Whether the signed volume is negative, by more than rounding. From the middle of the mesh, where an open
// mesh has a meaningful one too.
bool faces_inwards(const std::vector<Triangle>& triangles) {
  if (triangles.empty()) return false;
  dvec3 low(triangles[0].a), high = low;
  for (const Triangle& t : triangles)
    for (const dvec3 p : {dvec3(t.a), dvec3(t.b), dvec3(t.c)}) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  const dvec3 middle = 0.5 * (low + high);
  double volume = 0, size = 0;
  for (const Triangle& t : triangles) {
    const double part = glm::dot(dvec3(t.a) - middle, glm::cross(dvec3(t.b) - middle, dvec3(t.c) - middle));
    volume += part;
    size += std::abs(part);
  }
  return volume < -kRounding * size;
}

MeshFaults faults_of(const std::vector<Triangle>& ordered) {
  return {count_open_edges(ordered), faces_inwards(ordered)};
}

float fraction_of(double winding) {
  const double fraction = std::abs(winding);
  if (fraction < kRounding) return 0;
  if (fraction > 1 - kRounding) return 1;
  return static_cast<float>(fraction);
}

// The fraction of a voxel that is inside of an open mesh.
float sampled_fraction(const WindingTree& tree, const dvec3& low, const dvec3& voxel, bool crossed) {
  const auto is_inside = [](double winding) { return std::abs(winding) > kInside; };
  // How many of `count` points per axis are inside, from the first to the last of kSamples.
  const auto inside_of = [&](int count) {
    const double step = (kSamples - 1.0) / (count - 1);
    int inside = 0;
    for (int z = 0; z < count; ++z)
      for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x) {
          const dvec3 at = (step * dvec3(x, y, z) + 0.5) / double{kSamples};
          inside += is_inside(tree.winding_number(low + at * voxel));
        }
    return inside;
  };

  // Without a triangle in the voxel the winding number is smooth: fewer points decide.
  if (!crossed) {
    const double winding = tree.winding_number(low + 0.5 * voxel);
    if (std::abs(std::abs(winding) - kInside) > kNearBorder) return is_inside(winding) ? 1.0f : 0.0f;
    const int inside = inside_of(2);
    if (inside == 0) return 0;
    if (inside == 8) return 1;
  }
  return static_cast<float>(inside_of(kSamples)) / static_cast<float>(kSamples * kSamples * kSamples);
}

void sample_open(const std::vector<Triangle>& triangles, const std::vector<std::uint8_t>& crossed,
                 grids::DenseGrid& grid) {
  const WindingTree tree(triangles);
  const dvec3 voxel = grid.voxel_size();
  const std::size_t rows = std::size_t{grid.size.y} * grid.size.z;
  Progress job("coverage", rows);
  parallel_for(rows, 1, [&](std::size_t row, std::size_t) {
    for (std::uint32_t x = 0; x < grid.size.x; ++x) {
      const std::size_t i = row * grid.size.x + x;
      const dvec3 at(x, row % grid.size.y, row / grid.size.y);
      grid.values[i] = sampled_fraction(tree, grid.box.low + at * voxel, voxel, crossed[i] != 0);
    }
    job.advance();
  });
}

}  // namespace

std::string MeshFaults::text() const {
  if (open_edges == 0) return {};
  return "has " + std::to_string(open_edges) + (open_edges == 1 ? " open edge" : " open edges") +
         ", so its inside is a guess by winding number; close its holes for exact coverage";
}

MeshFaults find_faults(std::span<const Triangle> triangles) {
  return faults_of(in_order(triangles));
}

Coverage mesh_coverage(std::span<const Triangle> triangles, const Box<double>& box, glm::uvec3 size) {
  const std::vector<Triangle> ordered = in_order(triangles);
  Coverage coverage{{{}, size, box, {}}, faults_of(ordered)};
  MeanWinding mean = mean_winding(ordered, box, size);
  coverage.grid.values.resize(mean.values.size());
  if (coverage.faults.open_edges > 0) {
    sample_open(ordered, mean.crossed, coverage.grid);
  } else {
    std::transform(mean.values.begin(), mean.values.end(), coverage.grid.values.begin(), fraction_of);
  }
  return coverage;
}

}  // namespace brume::bake
