#include "bake/mean_winding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "core/tasks.hpp"

namespace brume::bake {
namespace {

using glm::dvec3;
using glm::ivec3;

constexpr std::size_t kMaxSlabs = 64;
constexpr double kReachVoxels = 1e100;  // Products of three coordinates stay finite.

struct VoxelCorners {
  std::array<dvec3, 3> corners;  // In voxels.
};

// A convex polygon: a triangle that is cut at two planes per axis has at most 9 corners. This holds with
// rounding too: along each axis the coordinates rise and then fall around a triangle, and cut() preserves
// this because it interpolates within the ends of an edge, so that a plane cuts at most two edges.
struct Polygon {
  std::array<dvec3, 10> corners;
  std::size_t count = 0;

  void add(const dvec3& corner) {
    BRUME_ASSERT(count < corners.size(), std::to_string(count));
    corners[count++] = corner;
  }
  std::pair<double, double> range(int axis) const {
    double low = corners[0][axis], high = low;
    for (std::size_t i = 1; i < count; ++i) {
      low = std::min(low, corners[i][axis]);
      high = std::max(high, corners[i][axis]);
    }
    return {low, high};
  }
};

// Where the edge from a to b crosses a plane. The result does not depend on the direction of the edge, so
// that two triangles beside it are cut at the same point and no gap opens between them.
dvec3 crossing(const dvec3& a, const dvec3& b, int axis, double plane) {
  const dvec3& low = a[axis] < b[axis] ? a : b;
  const dvec3& high = a[axis] < b[axis] ? b : a;
  const double t = (plane - low[axis]) / (high[axis] - low[axis]);
  dvec3 at = glm::clamp(low + t * (high - low), glm::min(low, high), glm::max(low, high));
  at[axis] = plane;
  return at;
}

// The parts on both sides of a plane across an axis. Corners on the plane belong to both.
void cut(const Polygon& polygon, int axis, double plane, Polygon& below, Polygon& above) {
  below.count = above.count = 0;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const dvec3& a = polygon.corners[i];
    const dvec3& b = polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
    if (a[axis] <= plane) below.add(a);
    if (a[axis] >= plane) above.add(a);
    if ((a[axis] < plane && b[axis] > plane) || (a[axis] > plane && b[axis] < plane)) {
      const dvec3 at = crossing(a, b, axis, plane);
      below.add(at);
      above.add(at);
    }
  }
}

// Calls visit(i, part) for the parts of a polygon in the layers [i, i + 1] across an axis, begin <= i < end,
// and with i = begin - 1 for the part below all of them.
template <typename Visit>
void for_each_layer(const Polygon& polygon, int axis, int begin, int end, Visit visit) {
  const auto [low, high] = polygon.range(axis);
  if (low >= end) return;
  if (high < begin) return visit(begin - 1, polygon);

  // A polygon in one layer needs no copy.
  const int first = low < begin ? begin - 1 : static_cast<int>(low);
  if (first >= begin && high <= first + 1) return visit(first, polygon);

  // The others are cut from below.
  std::array<Polygon, 2> rests;
  Polygon part;
  const Polygon* rest = &polygon;
  std::size_t next = 0;
  for (int i = first; i < end; ++i) {
    if (i >= begin && high <= i + 1) return visit(i, *rest);
    cut(*rest, axis, i + 1, part, rests[next]);
    rest = &rests[next];
    next ^= 1;
    if (part.count >= 3) visit(i, std::as_const(part));
    if (rest->count < 3) return;
  }
}

// What a polygon adds to the mean winding number of the voxels in its column: `own` to the voxel whose top it
// is below, and `above` to each voxel above that.
struct ColumnSum {
  double own = 0, above = 0;
};

// The signed volume between a polygon and the plane z = top, and the signed area below it. Positive where
// the polygon faces down: the solid begins there.
ColumnSum column_sum(const Polygon& polygon, double top) {
  ColumnSum sum;
  const dvec3& a = polygon.corners[0];
  for (std::size_t i = 2; i < polygon.count; ++i) {
    const dvec3 &b = polygon.corners[i - 1], &c = polygon.corners[i];
    const double area = -0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    sum.above += area;
    sum.own += area * (top - (a.z + b.z + c.z) / 3);
  }
  return sum;
}

// The triangles in voxels, and those that may touch each slab of rows across y.
class Slabs {
 public:
  Slabs(std::span<const voxel::Triangle> triangles, const Box<double>& box, ivec3 size)
      : rows_((static_cast<std::size_t>(size.y) + kMaxSlabs - 1) / kMaxSlabs),
        firsts_((static_cast<std::size_t>(size.y) + rows_ - 1) / rows_ + 1) {
    // Into voxels.
    const dvec3 scale = dvec3(size) / (box.high - box.low);
    for (const voxel::Triangle& t : triangles) {
      const VoxelCorners in_voxels{
          {(dvec3(t.a) - box.low) * scale, (dvec3(t.b) - box.low) * scale, (dvec3(t.c) - box.low) * scale}};
      if (matters(in_voxels, size)) corners_.push_back(in_voxels);
    }

    // A counting sort into slabs, which preserves the order in each.
    for (const VoxelCorners& t : corners_) {
      const auto [first, last] = slabs_of(t);
      for (std::size_t slab = first; slab <= last; ++slab) ++firsts_[slab + 1];
    }
    for (std::size_t slab = 1; slab < firsts_.size(); ++slab) firsts_[slab] += firsts_[slab - 1];
    members_.resize(firsts_.back());
    std::vector<std::size_t> next(firsts_.begin(), firsts_.end() - 1);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const auto [first, last] = slabs_of(corners_[i]);
      for (std::size_t slab = first; slab <= last; ++slab)
        members_[next[slab]++] = static_cast<std::uint32_t>(i);
    }
  }

  std::size_t count() const { return firsts_.size() - 1; }
  int rows() const { return static_cast<int>(rows_); }
  std::span<const std::uint32_t> members(std::size_t slab) const {
    return std::span(members_).subspan(firsts_[slab], firsts_[slab + 1] - firsts_[slab]);
  }
  const VoxelCorners& triangle(std::uint32_t i) const { return corners_[i]; }

 private:
  // Whether it may add to a voxel: it is finite, in the footprint, and not above the box.
  static bool matters(const VoxelCorners& t, ivec3 size) {
    const auto& [a, b, c] = t.corners;
    for (const dvec3& p : t.corners)
      for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(p[axis]) < kReachVoxels)) return false;  // False for NaN.
    const dvec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    return low.x < size.x && low.y < size.y && low.z < size.z && high.x >= 0 && high.y >= 0;
  }
  std::pair<std::size_t, std::size_t> slabs_of(const VoxelCorners& t) const {
    const auto& [a, b, c] = t.corners;
    const auto [low, high] = std::minmax({a.y, b.y, c.y});
    const auto last = static_cast<double>(count() - 1), rows = static_cast<double>(rows_);
    return {static_cast<std::size_t>(std::clamp(std::floor(low / rows), 0.0, last)),
            static_cast<std::size_t>(std::clamp(std::floor(high / rows), 0.0, last))};
  }

  std::size_t rows_;                    // Per slab.
  std::vector<std::size_t> firsts_;     // Per slab, into members_; then its size.
  std::vector<VoxelCorners> corners_;   // Corners of all triangles that matter.
  std::vector<std::uint32_t> members_;  // Into corners_.
};

// The columns of the voxels in a slab of rows [begin, end) across y.
class SlabSums {
 public:
  SlabSums(ivec3 size, int begin, int end, std::vector<std::uint8_t>& crossed)
      : size_(size), begin_(begin), end_(end), crossed_(crossed) {
    // One value more than voxels: what begins above the last voxel.
    sums_.resize(static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(size.x) *
                 (static_cast<std::size_t>(size.z) + 1));
  }

  void add(const VoxelCorners& t) {
    Polygon triangle;
    for (const dvec3& corner : t.corners) triangle.add(corner);
    for_each_layer(triangle, 1, begin_, end_, [&](int y, const Polygon& row) {
      if (y < begin_) return;
      for_each_layer(row, 0, 0, size_.x, [&](int x, const Polygon& column) {
        if (x < 0) return;
        double* sums = &sums_[first_of(x, y)];
        for_each_layer(column, 2, 0, size_.z, [&](int z, const Polygon& piece) {
          const ColumnSum sum = column_sum(piece, z + 1);
          if (z < 0) {
            sums[0] += sum.above;
            return;
          }
          sums[z] += sum.own;
          sums[z + 1] += sum.above - sum.own;
          crossed_[voxel(x, y, z)] = 1;
        });
      });
    });
  }

  // Sums along z into the mean winding numbers.
  void finish(std::vector<double>& values) const {
    for (int y = begin_; y < end_; ++y)
      for (int x = 0; x < size_.x; ++x) {
        const double* sums = &sums_[first_of(x, y)];
        double sum = 0;
        for (int z = 0; z < size_.z; ++z) values[voxel(x, y, z)] = sum += sums[z];
      }
  }

 private:
  std::size_t first_of(int x, int y) const {
    const auto row = static_cast<std::size_t>(y - begin_);
    return (row * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x)) *
           (static_cast<std::size_t>(size_.z) + 1);
  }
  std::size_t voxel(int x, int y, int z) const {
    const auto plane = static_cast<std::size_t>(y) + static_cast<std::size_t>(size_.y) * std::size_t(z);
    return static_cast<std::size_t>(x) + static_cast<std::size_t>(size_.x) * plane;
  }

  ivec3 size_;
  int begin_, end_;
  std::vector<double> sums_;  // z fastest.
  std::vector<std::uint8_t>& crossed_;
};

}  // namespace

MeanWinding mean_winding(std::span<const voxel::Triangle> triangles, const Box<double>& box,
                         glm::uvec3 size) {
  BRUME_ASSERT(glm::all(glm::lessThan(box.low, box.high)), "an empty box");
  BRUME_ASSERT(size.x > 0 && size.y > 0 && size.z > 0, "no voxels");
  MeanWinding result;
  const std::size_t count = std::size_t{size.x} * size.y * size.z;
  result.values.resize(count);
  result.crossed.resize(count);
  const ivec3 voxels(size);
  const Slabs slabs(triangles, box, voxels);
  Progress job("winding", slabs.count());
  parallel_for(slabs.count(), 1, [&](std::size_t slab, std::size_t) {
    const int begin = static_cast<int>(slab) * slabs.rows();
    SlabSums sums(voxels, begin, std::min(begin + slabs.rows(), voxels.y), result.crossed);
    for (const std::uint32_t i : slabs.members(slab)) sums.add(slabs.triangle(i));
    sums.finish(result.values);
    job.advance();
  });
  return result;
}

}  // namespace brume::bake
