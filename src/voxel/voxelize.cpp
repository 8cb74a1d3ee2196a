#include "voxel/voxelize.hpp"

#include <atomic>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/progress.hpp"
#include "core/tasks.hpp"
#include "voxel/triangle_box.hpp"

namespace brume::voxel {
namespace {

using glm::dvec3;
using glm::ivec3;

// Writes voxels into a grid; caches the brick of the last one.
class Pen {
 public:
  explicit Pen(BitGrid& grid) : grid_(grid) {}

  bool solid(ivec3 v) {
    move_to(v >> 3);
    return brick_ && ((*brick_)[static_cast<unsigned>(v.z & 7)] >> bit(v) & 1);
  }
  void set(ivec3 v) {
    move_to(v >> 3);
    if (!brick_) brick_ = &grid_.ensure_brick(v >> 3);
    (*brick_)[static_cast<unsigned>(v.z & 7)] |= std::uint64_t{1} << bit(v);
  }

 private:
  static int bit(ivec3 v) { return (v.x & 7) + 8 * (v.y & 7); }
  void move_to(ivec3 b) {
    if (b == at_) return;
    at_ = b;
    brick_ = grid_.find_brick_to_write(b);
  }

  BitGrid& grid_;
  ivec3 at_{-1};
  BitGrid::Brick* brick_ = nullptr;
};

// Voxels [low, high] per axis that the closed interval [from, to] touches, within the grid.
struct Range {
  int low = 0, high = -1;
  bool thin = false;  // The interval touches one voxel only.

  Range() = default;
  Range(double from, double to, int low_limit, int high_limit) {
    const double first = std::ceil(from) - 1, last = std::floor(to);
    thin = first == last;
    low = static_cast<int>(std::clamp<double>(first, low_limit, high_limit + 1.0));
    high = static_cast<int>(std::clamp<double>(last, low_limit - 1.0, high_limit));
  }
  bool empty() const { return low > high; }
};

class TriangleScan {
 public:
  TriangleScan(VoxelTriangle& t, const Box<int>& box, Pen& pen) : t_(t), pen_(pen) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto [from, to] = std::minmax({t.corners[0][axis], t.corners[1][axis], t.corners[2][axis]});
      range_[axis] = Range(from, to, box.low[axis], box.high[axis] - 1);
    }
  }

  void run() {
    if (range_[0].empty() || range_[1].empty() || range_[2].empty()) return;
    const int thin = range_[0].thin + range_[1].thin + range_[2].thin;
    if (thin >= 2) return fill_box();
    t_.fix();
    if (thin == 1) return scan_slab(range_[0].thin ? 0 : range_[1].thin ? 1 : 2);
    dvec3 reach;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = t_.corners[0][axis];
      reach[axis] = std::max(std::abs(range_[axis].low - at), std::abs(range_[axis].high + 1 - at));
    }
    const PlaneTest plane(t_, reach);
    if (plane.normal == dvec3(0)) {
      scan_segment();
    } else {
      scan_columns(plane);
    }
  }

 private:
  // Along a single row of voxels a triangle touches every voxel of its range, because it is connected.
  void fill_box() {
    for (int z = range_[2].low; z <= range_[2].high; ++z)
      for (int y = range_[1].low; y <= range_[1].high; ++y)
        for (int x = range_[0].low; x <= range_[0].high; ++x) pen_.set({x, y, z});
  }

  // Visits the columns (u, w) of a projection that the three edges do not separate.
  template <typename Visit>
  void for_columns(const ProjectionTest& projection, int axis, Visit visit) {
    const int a1 = (axis + 1) % 3, a2 = (axis + 2) % 3;
    for (int w = range_[a2].low; w <= range_[a2].high; ++w) {
      const auto [first, last] = row(projection, a1, a2, w);
      for (int u = first; u <= last; ++u)
        if (projection.joins(t_.fixed_voxel(a1, u), t_.fixed_voxel(a2, w))) visit(u, w);
    }
  }

  // A conservative range of the columns in row w that pass the edge tests.
  std::pair<int, int> row(const ProjectionTest& projection, int a1, int a2, int w) const {
    const Range& range_u = range_[a1];
    if (range_u.high - range_u.low <= 3) return {range_u.low, range_u.high};
    double from = range_u.low, to = range_u.high;
    const auto scale = static_cast<double>(std::int64_t{1} << t_.shift),
               base = static_cast<double>(t_.base[a1]);
    for (const EdgeTest& edge : projection.edges) {
      if (edge.nu == 0) continue;
      const Int128 along_w = Int128{edge.nw} * (t_.fixed_voxel(a2, w) - edge.at_w);
      const auto nu = static_cast<double>(edge.nu);
      const double p = static_cast<double>(edge.low - along_w) / nu,
                   q = static_cast<double>(edge.high - along_w) / nu;
      const auto at = static_cast<double>(edge.at_u);
      from = std::max(from, base + (at + std::min(p, q)) / scale - margin());
      to = std::min(to, base + (at + std::max(p, q)) / scale + margin());
    }
    return {static_cast<int>(std::ceil(from)), static_cast<int>(std::floor(to))};
  }

  // Along `axis` the triangle lies within one voxel: the projection decides.
  void scan_slab(int axis) {
    for_columns(ProjectionTest(t_, axis), axis, [&](int u, int w) {
      ivec3 v;
      v[axis] = range_[axis].low;
      v[(axis + 1) % 3] = u;
      v[(axis + 2) % 3] = w;
      pen_.set(v);
    });
  }

  // Visits columns along the dominant axis of the normal, and in each the few voxels that the plane crosses.
  void scan_columns(const PlaneTest& plane) {
    const dvec3 n = plane.normal, size = glm::abs(n);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int a1 = (axis + 1) % 3, a2 = (axis + 2) % 3;
    const ProjectionTest along_a1(t_, a1), along_a2(t_, a2);
    for_columns(ProjectionTest(t_, axis), axis, [&](int u, int w) {
      // The range in which the plane crosses the column.
      const double across = n[a1] * (u - plane.at[a1]) + n[a2] * (w - plane.at[a2]);
      const double p = (plane.low - across) / n[axis], q = (plane.high - across) / n[axis];
      const double from = plane.at[axis] + std::min(p, q) - margin();
      const double to = plane.at[axis] + std::max(p, q) + margin();
      const int low = static_cast<int>(std::ceil(std::max<double>(range_[axis].low, from)));
      const int high = static_cast<int>(std::floor(std::min<double>(range_[axis].high, to)));

      // The exact tests.
      for (int i = low; i <= high; ++i) {
        ivec3 v;
        v[axis] = i;
        v[a1] = u;
        v[a2] = w;
        if (!pen_.solid(v) && plane.joins(v) &&
            along_a1.joins(t_.fixed_voxel(a2, w), t_.fixed_voxel(axis, i)) &&
            along_a2.joins(t_.fixed_voxel(axis, i), t_.fixed_voxel(a1, u)))
          pen_.set(v);
      }
    });
  }

  // A degenerate triangle is its longest edge: follow it slab by slab.
  void scan_segment() {
    // The longest edge and its dominant axis.
    const ProjectionTest projections[3] = {{t_, 0}, {t_, 1}, {t_, 2}};
    dvec3 p = t_.corners[0], q = t_.corners[1];
    for (unsigned i = 1; i < 3; ++i) {
      const dvec3 e = t_.corners[(i + 1) % 3] - t_.corners[i];
      if (glm::dot(e, e) > glm::dot(q - p, q - p)) p = t_.corners[i], q = t_.corners[(i + 1) % 3];
    }
    const dvec3 along = q - p, size = glm::abs(along);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;

    for (int i = range_[axis].low; i <= range_[axis].high; ++i) {
      // The bounds of the edge within this slab.
      const dvec3 from = p + std::clamp((i - margin() - p[axis]) / along[axis], 0.0, 1.0) * along;
      const dvec3 to = p + std::clamp((i + 1 + margin() - p[axis]) / along[axis], 0.0, 1.0) * along;
      Range slab[3];
      for (int k = 0; k < 3; ++k)
        slab[k] = Range(std::min(from[k], to[k]) - margin(), std::max(from[k], to[k]) + margin(),
                        range_[k].low, range_[k].high);
      slab[axis].low = slab[axis].high = i;

      // The exact tests.
      for (int z = slab[2].low; z <= slab[2].high; ++z)
        for (int y = slab[1].low; y <= slab[1].high; ++y)
          for (int x = slab[0].low; x <= slab[0].high; ++x) {
            const std::int64_t fx = t_.fixed_voxel(0, x), fy = t_.fixed_voxel(1, y),
                               fz = t_.fixed_voxel(2, z);
            if (projections[0].joins(fy, fz) && projections[1].joins(fz, fx) && projections[2].joins(fx, fy))
              pen_.set({x, y, z});
          }
    }
  }

  // Margin [voxels] of the candidate search in doubles, far above their error; the exact tests decide.
  double margin() const { return 1e-3 + std::ldexp(1.0, 16 - t_.shift); }

  VoxelTriangle& t_;
  Pen& pen_;
  Range range_[3];
};

bool within_reach(const VoxelTriangle& t) {
  constexpr auto kLimit = static_cast<double>(std::int64_t{1} << VoxelTriangle::kMaxExponent);
  for (const dvec3& p : t.corners)
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(p[axis]) < kLimit)) return false;  // False for NaN.
  return true;
}

void draw(const Triangle& t, const GridLayout& layout, const Box<int>& box, Pen& pen) {
  const dvec3 origin(layout.origin_world);
  const double voxel_size = layout.voxel_size;
  VoxelTriangle in_voxels({(dvec3(t.a) - origin) / voxel_size, (dvec3(t.b) - origin) / voxel_size,
                           (dvec3(t.c) - origin) / voxel_size});
  if (within_reach(in_voxels)) TriangleScan(in_voxels, box, pen).run();
}

void merge(BitGrid& into, const BitGrid& from) {
  from.for_each_brick([&](ivec3 at, const BitGrid::Brick& brick) {
    BitGrid::Brick& target = into.ensure_brick(at);
    for (unsigned z = 0; z < brick.size(); ++z) target[z] |= brick[z];
  });
}

std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

Result<void> check_frame(const GridLayout& layout) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const std::string given = "grid: " + std::to_string(layout.size[axis]) + " voxels along " + kAxes[axis];
    if (layout.size[axis] < 1) return Failure{ErrorCode::usage, given + "; give 1 to 4096 per axis"};
    if (layout.size[axis] > kMaxAxis)
      return Failure{ErrorCode::resource_limit,
                     given + "; at most 4096 per axis: make the voxels larger or the grid smaller"};
    if (!std::isfinite(layout.origin_world[axis]))
      return Failure{ErrorCode::usage, std::string("grid: the origin's ") + kAxes[axis] + " is not finite"};
  }
  if (!std::isfinite(layout.voxel_size) || layout.voxel_size <= 0)
    return Failure{ErrorCode::usage, "grid: voxel size " + to_text(double{layout.voxel_size}) +
                                         " m; give a finite number above 0"};
  return {};
}

Result<GridLayout> layout_around(glm::vec3 low_world, glm::vec3 high_world, float voxel_size,
                                 int margin_voxels) {
  GridLayout layout{ivec3(1), voxel_size, glm::vec3(0)};
  if (auto checked = check_frame(layout); !checked) return checked.failure();
  if (margin_voxels < 0)
    return Failure{ErrorCode::usage,
                   "grid: margin " + std::to_string(margin_voxels) + "; give 0 or more voxels"};
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(low_world[axis]) || !std::isfinite(high_world[axis]) ||
        low_world[axis] > high_world[axis])
      return Failure{ErrorCode::bad_input,
                     "grid: the scene has no bounds; it needs at least one triangle with finite corners"};
    const double low = std::floor(double{low_world[axis]} / voxel_size) - margin_voxels;
    const double high = std::ceil(double{high_world[axis]} / voxel_size) + margin_voxels;
    const double size = std::max(high - low, 1.0);
    if (!(size <= kMaxAxis))
      return Failure{ErrorCode::resource_limit,
                     "grid: the scene would need " + to_text(size) +
                         " voxels along an axis; at most 4096: make the voxels larger"};
    layout.size[axis] = static_cast<int>(size);
    layout.origin_world[axis] = static_cast<float>(low * voxel_size);
  }
  return layout;
}

Result<BitGrid> voxelize(std::span<const Triangle> triangles, const GridLayout& layout) {
  if (auto checked = check_frame(layout); !checked) return checked.failure();
  constexpr std::size_t kTrianglesPerTask = 512;
  const std::size_t tasks = (triangles.size() + kTrianglesPerTask - 1) / kTrianglesPerTask;
  const std::size_t workers = std::max<std::size_t>(1, std::min<std::size_t>(thread_count(), tasks));
  std::vector<BitGrid> grids(workers, BitGrid(layout));
  std::atomic<std::size_t> next{0};
  const Box<int> all{ivec3(0), layout.size};

  Progress job("voxelize", triangles.size());
  // Each worker draws into a grid of its own. The union does not depend on which worker drew what.
  parallel_for(workers, 1, [&](std::size_t worker, std::size_t) {
    Pen pen(grids[worker]);
    for (std::size_t task; (task = next.fetch_add(1)) < tasks;) {
      const std::size_t end = std::min(triangles.size(), (task + 1) * kTrianglesPerTask);
      for (std::size_t i = task * kTrianglesPerTask; i < end; ++i) draw(triangles[i], layout, all, pen);
      job.advance(end - task * kTrianglesPerTask);
    }
  });
  for (std::size_t worker = 1; worker < workers; ++worker) merge(grids[0], grids[worker]);
  return std::move(grids[0]);
}

void draw_triangles(std::span<const Triangle> triangles, const Box<int>& box, BitGrid& grid) {
  BRUME_ASSERT((Box<int>{ivec3(0), grid.size()}.contains(box)), "the box lies in the grid");
  if (box.empty()) return;
  Pen pen(grid);
  for (const Triangle& t : triangles) draw(t, grid.layout(), box, pen);
}

}  // namespace brume::voxel
