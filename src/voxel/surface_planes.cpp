#include "voxel/surface_planes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "core/tasks.hpp"

namespace brume::voxel {
namespace {

using glm::dvec3;
using glm::ivec3;

// Pieces whose normals are within 25 degrees form one cluster: a column of one voxel radius becomes two or
// three planes in a cell, the two slopes of a roof stay separate.
constexpr double kSameDirection = 0.9;
// A cluster below 2 % of a voxel face is an edge that barely enters the cell: no visible effect.
constexpr double kLeastArea = 0.02;
// A surface within this distance of a voxel counts as touching it: above the rounding error of floats.
constexpr double kAtVoxel = 1e-3;
constexpr std::int64_t kCellsForThreads = 32768;

// Space of this file: cell space = voxel space - 0.5, so that cell c covers [c, c + 1).
dvec3 cell_from_world(const GridLayout& layout, glm::vec3 p) {
  return (dvec3(p) - dvec3(layout.origin_world)) / double{layout.voxel_size} - 0.5;
}

std::uint64_t key_of(ivec3 size, ivec3 cell) {
  const auto nx = static_cast<std::uint64_t>(size.x) + 1, ny = static_cast<std::uint64_t>(size.y) + 1;
  const auto x = static_cast<std::uint64_t>(cell.x + 1), y = static_cast<std::uint64_t>(cell.y + 1),
             z = static_cast<std::uint64_t>(cell.z + 1);
  return x + nx * (y + ny * z);
}

// A convex polygon: three corners plus one for each of the six cuts.
struct Polygon {
  std::array<dvec3, 9> corners;
  unsigned count = 0;
};

// The part below or above `limit` along `axis`. Sutherland & Hodgman 1974, for one plane.
Polygon cut(const Polygon& in, int axis, double limit, bool keep_below) {
  Polygon out;
  const auto inside = [&](const dvec3& p) { return keep_below ? p[axis] <= limit : p[axis] >= limit; };
  for (unsigned i = 0; i < in.count; ++i) {
    const dvec3 &p = in.corners[i], &q = in.corners[i + 1 == in.count ? 0 : i + 1];
    const bool p_inside = inside(p);
    if (p_inside && out.count < out.corners.size()) out.corners[out.count++] = p;
    if (p_inside == inside(q) || out.count == out.corners.size()) continue;
    dvec3 crossing = p + (limit - p[axis]) / (q[axis] - p[axis]) * (q - p);
    crossing[axis] = limit;
    out.corners[out.count++] = crossing;
  }
  return out;
}

// The part of one triangle in one cell.
struct Piece {
  std::uint64_t cell;  // x and y of the cell in its slab: x + nx * y
  glm::vec3 normal;    // unit length
  glm::vec3 centroid;  // relative to the cell's centre
  float area;          // [voxel^2]
};

// First and last cell that [from, to] overlaps, within [low, high].
bool cell_range(double from, double to, int low, int high, int& first, int& last) {
  if (!(from < high + 1.0) || !(to >= low)) return false;
  first = static_cast<int>(std::max<double>(low, std::floor(from)));
  last = static_cast<int>(std::min<double>(high, std::floor(to)));
  return true;
}

// Cuts the polygon at the cell borders along `axis` and calls visit(cell index, part).
template <typename Visit>
void slice(const Polygon& polygon, int axis, int low, int high, Visit visit) {
  double from = polygon.corners[0][axis], to = from;
  for (unsigned i = 1; i < polygon.count; ++i) {
    from = std::min(from, polygon.corners[i][axis]);
    to = std::max(to, polygon.corners[i][axis]);
  }
  int first = 0, last = 0;
  if (!cell_range(from, to, low, high, first, last)) return;
  for (int i = first; i <= last; ++i) {
    Polygon part = polygon;
    if (from < i) part = cut(part, axis, i, false);
    if (to > i + 1) part = cut(part, axis, i + 1, true);
    if (part.count >= 3) visit(i, part);
  }
}

// Area and centroid of a planar polygon with unit normal n, as a fan of triangles.
Piece measure(const Polygon& polygon, const dvec3& n, const dvec3& centre) {
  double area = 0;
  dvec3 moment(0);
  const dvec3 a = polygon.corners[0] - centre;
  for (unsigned i = 1; i + 1 < polygon.count; ++i) {
    const dvec3 b = polygon.corners[i] - centre, c = polygon.corners[i + 1] - centre;
    const double part = 0.5 * glm::dot(n, glm::cross(b - a, c - a));
    area += part;
    moment += part / 3 * (a + b + c);
  }
  Piece piece{0, glm::vec3(n), glm::vec3(0), static_cast<float>(area)};
  if (area > 0) piece.centroid = glm::vec3(moment / area);
  return piece;
}

struct Cluster {
  double area = 0;
  dvec3 normal{0}, moment{0};  // sums weighted by area
};

dvec3 canonical(dvec3 n) {
  const dvec3 size = glm::abs(n);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return n[axis] < 0 ? -n : n;
}

// Clusters the pieces of one cell, largest first, by direction and appends the planes.
std::uint8_t cluster_pieces(std::span<const Piece> pieces, std::vector<Cluster>& clusters,
                            std::vector<Plane>& planes) {
  // Add each piece to the cluster of the nearest direction.
  clusters.clear();
  for (const Piece& piece : pieces) {
    const dvec3 n(piece.normal);
    Cluster* home = nullptr;
    double best = kSameDirection, sign = 1;
    for (Cluster& cluster : clusters) {
      const double along = glm::dot(n, cluster.normal) / glm::length(cluster.normal);
      if (std::abs(along) > best) home = &cluster, best = std::abs(along), sign = along < 0 ? -1 : 1;
    }
    if (!home) home = &clusters.emplace_back();
    home->area += piece.area;
    home->normal += sign * piece.area * n;
    home->moment += double{piece.area} * dvec3(piece.centroid);
  }

  // The largest clusters become planes.
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.area > b.area; });
  std::uint8_t count = 0;
  for (const Cluster& cluster : clusters) {
    if (count == kMaxPlanes || (count > 0 && cluster.area < kLeastArea)) break;
    const dvec3 n = canonical(glm::normalize(cluster.normal));
    const double offset = std::clamp(glm::dot(n, cluster.moment / cluster.area), -1.0, 1.0);
    planes.push_back({glm::vec3(n), static_cast<float>(offset)});
    ++count;
  }
  return count;
}

// The cells of one z, built by one thread.
struct Slab {
  std::vector<std::uint64_t> keys;
  std::vector<std::uint8_t> counts;
  std::vector<Plane> planes;
};

bool has_solid_corner(const BitGrid& grid, ivec3 cell) {
  for (int i = 0; i < 8; ++i)
    if (grid.solid(cell + ivec3(i & 1, i >> 1 & 1, i >> 2))) return true;
  return false;
}

bool at_solid_voxel(const BitGrid& grid, ivec3 cell, const dvec3& from_centre) {
  const auto low = ivec3(glm::floor(from_centre - kAtVoxel)),
             high = ivec3(glm::floor(from_centre + kAtVoxel));
  bool found = false;
  for_each_in({low, high + 1}, [&](ivec3 v) { found = found || grid.solid(cell + 1 + v); });
  return found;
}

class SlabBuilder {
 public:
  SlabBuilder(std::span<const Triangle> triangles, const BitGrid& grid, const Box<int>& cells,
              std::span<const Box<int>> cleared)
      : triangles_(triangles), grid_(grid), cells_(cells), cleared_(cleared) {}

  Slab build(std::span<const std::uint32_t> in_slab, int z) {
    pieces_.clear();
    for (const std::uint32_t i : in_slab) add(triangles_[i], z);
    order_.resize(pieces_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      const Piece &p = pieces_[a], &q = pieces_[b];
      if (p.cell != q.cell) return p.cell < q.cell;
      return p.area != q.area ? p.area > q.area : a < b;
    });
    return cluster_cells(z);
  }

 private:
  void add(const Triangle& t, int z) {
    const GridLayout& layout = grid_.layout();
    Polygon triangle;
    triangle.count = 3;
    triangle.corners[0] = cell_from_world(layout, t.a);
    triangle.corners[1] = cell_from_world(layout, t.b);
    triangle.corners[2] = cell_from_world(layout, t.c);
    const dvec3 cross =
        glm::cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
    const double length = glm::length(cross);
    if (!(length > 0) || !std::isfinite(length)) return;  // A degenerate triangle has no plane.
    const dvec3 n = cross / length;
    slice(triangle, 2, z, z, [&](int, const Polygon& in_slab) {
      slice(in_slab, 1, cells_.low.y, cells_.high.y - 1, [&](int y, const Polygon& in_row) {
        slice(in_row, 0, cells_.low.x, cells_.high.x - 1, [&](int x, const Polygon& in_cell) {
          if (touches_cleared({x, y, z})) {
            add_octants(in_cell, n, {x, y, z});
          } else {
            add_piece(measure(in_cell, n, dvec3(x, y, z) + 0.5), {x, y, z});
          }
        });
      });
    });
  }

  void add_piece(Piece piece, ivec3 cell) {
    if (!(piece.area > 0)) return;
    piece.cell = static_cast<std::uint64_t>(cell.x + 1) +
                 (static_cast<std::uint64_t>(grid_.size().x) + 1) * static_cast<std::uint64_t>(cell.y + 1);
    pieces_.push_back(piece);
  }

  bool touches_cleared(ivec3 cell) const {
    return std::any_of(cleared_.begin(), cleared_.end(), [&](const Box<int>& box) {
      return !intersection(box, {cell, cell + 2}).empty();
    });
  }

  // Adds the parts of the cell's eight octants that lie in or at a solid voxel.
  void add_octants(const Polygon& in_cell, const dvec3& n, ivec3 cell) {
    const dvec3 centre = dvec3(cell) + 0.5;
    for (int octant = 0; octant < 8; ++octant) {
      Polygon part = in_cell;
      for (int axis = 0; axis < 3 && part.count >= 3; ++axis) {
        const bool below = (octant >> axis & 1) == 0;
        // A polygon in the middle plane itself belongs to the upper half.
        const auto end = part.corners.begin() + part.count;
        const bool all_above =
            std::all_of(part.corners.begin(), end, [&](const dvec3& p) { return p[axis] >= centre[axis]; });
        part = below && all_above ? Polygon{} : cut(part, axis, centre[axis], below);
      }
      if (part.count < 3) continue;
      const Piece piece = measure(part, n, centre);
      if (at_solid_voxel(grid_, cell, dvec3(piece.centroid))) add_piece(piece, cell);
    }
  }

  Slab cluster_cells(int z) {
    Slab slab;
    const auto nx = static_cast<std::uint64_t>(grid_.size().x) + 1;
    for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
      const std::uint64_t in_slab = pieces_[order_[begin]].cell;
      gathered_.clear();
      for (; end < order_.size() && pieces_[order_[end]].cell == in_slab; ++end)
        gathered_.push_back(pieces_[order_[end]]);
      const ivec3 cell(static_cast<int>(in_slab % nx) - 1, static_cast<int>(in_slab / nx) - 1, z);
      if (!has_solid_corner(grid_, cell)) continue;
      slab.counts.push_back(cluster_pieces(gathered_, clusters_, slab.planes));
      slab.keys.push_back(key_of(grid_.size(), cell));
    }
    return slab;
  }

  std::span<const Triangle> triangles_;
  const BitGrid& grid_;
  const Box<int> cells_;
  std::span<const Box<int>> cleared_;
  std::vector<Piece> pieces_, gathered_;
  std::vector<std::uint32_t> order_;
  std::vector<Cluster> clusters_;
};

// The triangles that overlap each slab of cells from z = low_z on, ascending: a counting sort.
struct SlabTriangles {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> triangles;

  SlabTriangles(std::span<const Triangle> all, const GridLayout& layout, int low_z, int high_z) {
    // The slabs of each triangle.
    constexpr std::size_t kTrianglesPerTask = 2048;
    const auto slabs = static_cast<std::size_t>(high_z - low_z);
    std::vector<std::pair<int, int>> range(all.size(), {0, -1});
    parallel_for(all.size(), kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const double a = cell_from_world(layout, all[i].a).z, b = cell_from_world(layout, all[i].b).z,
                     c = cell_from_world(layout, all[i].c).z;
        auto& [low, high] = range[i];
        if (!std::isfinite(a + b + c) ||
            !cell_range(std::min({a, b, c}), std::max({a, b, c}), low_z, high_z - 1, low, high))
          low = 0, high = -1;
      }
    });

    // Count, sum up, distribute.
    first.assign(slabs + 1, 0);
    for (const auto& [low, high] : range)
      for (int z = low; z <= high; ++z) ++first[static_cast<std::size_t>(z - low_z + 1)];
    for (std::size_t z = 1; z <= slabs; ++z) first[z] += first[z - 1];
    triangles.resize(first[slabs]);
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < all.size(); ++i)
      for (int z = range[i].first; z <= range[i].second; ++z)
        triangles[next[static_cast<std::size_t>(z - low_z)]++] = static_cast<std::uint32_t>(i);
  }
  std::span<const std::uint32_t> in_slab(std::size_t slab) const {
    return std::span(triangles).subspan(first[slab], first[slab + 1] - first[slab]);
  }
};

bool plausible(const Plane& plane) {
  const float length = glm::length(plane.normal);
  return std::abs(length - 1) < 1e-3f && std::abs(plane.offset) <= 1;  // False for NaN.
}

/// The reverse of key_of, plus 1.
ivec3 cell_of_key(ivec3 size, std::uint64_t key) {
  const auto nx = static_cast<std::uint64_t>(size.x) + 1, ny = static_cast<std::uint64_t>(size.y) + 1;
  return ivec3(glm::u64vec3(key % nx, key / nx % ny, key / nx / ny));
}

/// The key of the brick that has a cell + 1.
std::uint64_t brick_key(ivec3 above) {
  const glm::u64vec3 brick(above >> 3);
  return brick.x | brick.y << 21 | brick.z << 42;
}

/// Where the search for a key begins. Fibonacci hashing: Knuth 1973, 6.4.
std::uint64_t slot_of(std::uint64_t key) {
  return key * 0x9e3779b97f4a7c15ull >> 32;
}

unsigned bit_of(ivec3 above) {
  return static_cast<unsigned>((above.x & 7) + 8 * (above.y & 7));
}

}  // namespace

SurfacePlanes SurfacePlanes::build(std::span<const Triangle> triangles, const BitGrid& grid) {
  return build_in(triangles, grid, {ivec3(-1), grid.size()}, {});
}

SurfacePlanes SurfacePlanes::build_in(std::span<const Triangle> triangles, const BitGrid& grid,
                                      const Box<int>& cells, std::span<const Box<int>> cleared) {
  BRUME_ASSERT(triangles.size() < 0xffffffffu, std::to_string(triangles.size()));
  BRUME_ASSERT((Box<int>{ivec3(-1), grid.size()}.contains(cells)), "the cells lie in the grid");
  // Build the slabs in parallel.
  std::vector<Slab> slabs;
  if (!cells.empty()) {
    const SlabTriangles slab_triangles(triangles, grid.layout(), cells.low.z, cells.high.z);
    slabs.resize(static_cast<std::size_t>(cells.high.z - cells.low.z));
    // A few cells take less time than starting another thread.
    const glm::i64vec3 size(cells.high - cells.low);
    const std::size_t grain = size.x * size.y * size.z < kCellsForThreads ? slabs.size() : 1;
    Progress job("surfaces", slabs.size());
    parallel_for(slabs.size(), grain, [&](std::size_t begin, std::size_t end) {
      SlabBuilder builder(triangles, grid, cells, cleared);
      for (std::size_t i = begin; i < end; ++i)
        slabs[i] = builder.build(slab_triangles.in_slab(i), cells.low.z + static_cast<int>(i));
      job.advance(end - begin);
    });
  }

  // Concatenate them.
  SurfacePlanes result;
  result.size_ = grid.size();
  result.first_.push_back(0);
  for (const Slab& slab : slabs) {
    result.keys_.insert(result.keys_.end(), slab.keys.begin(), slab.keys.end());
    result.planes_.insert(result.planes_.end(), slab.planes.begin(), slab.planes.end());
    for (const std::uint8_t count : slab.counts) result.first_.push_back(result.first_.back() + count);
  }
  result.build_index();
  return result;
}

std::optional<SurfacePlanes> SurfacePlanes::from_parts(ivec3 size, std::vector<std::uint64_t> keys,
                                                       std::span<const std::uint8_t> counts,
                                                       std::vector<Plane> planes) {
  if (counts.size() != keys.size() || keys.size() >= 0xffffffffu) return std::nullopt;
  const std::uint64_t end = key_of(size, size - 1) + 1;
  SurfacePlanes result;
  result.size_ = size;
  result.first_.push_back(0);
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] >= end || (i > 0 && keys[i] <= keys[i - 1])) return std::nullopt;
    if (counts[i] < 1 || counts[i] > kMaxPlanes) return std::nullopt;
    total += counts[i];
    if (total > planes.size()) return std::nullopt;
    result.first_.push_back(static_cast<std::uint32_t>(total));
  }
  if (total != planes.size() || !std::all_of(planes.begin(), planes.end(), plausible)) return std::nullopt;
  result.keys_ = std::move(keys);
  result.planes_ = std::move(planes);
  result.build_index();
  return result;
}

void SurfacePlanes::build_index() {
  // The bricks, each once.
  const auto above = [&](std::size_t i) { return cell_of_key(size_, keys_[i]); };
  std::vector<std::uint64_t> found;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const std::uint64_t key = brick_key(above(i));
    if (found.empty() || found.back() != key) found.push_back(key);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  index_.assign(std::bit_ceil(2 * found.size() + 1), 0);
  bricks_.reserve(found.size());
  for (const std::uint64_t key : found) add_to_index(key);

  // The cells of each brick, then their places: keys are sorted as the cells within a brick are.
  const auto number = [&](ivec3 cell_above) {
    return static_cast<std::size_t>(find_brick(brick_key(cell_above)) - bricks_.data());
  };
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const ivec3 at = above(i);
    bricks_[number(at)].cells[static_cast<std::size_t>(at.z & 7)] |= std::uint64_t{1} << bit_of(at);
  }
  std::uint32_t count = 0;
  for (Brick& brick : bricks_) {
    brick.first = count;
    for (std::size_t z = 0; z < 8; ++z) {
      brick.before[z] = static_cast<std::uint16_t>(count - brick.first);
      count += static_cast<std::uint32_t>(std::popcount(brick.cells[z]));
    }
  }
  order_.resize(keys_.size());
  std::vector<std::uint32_t> placed(bricks_.size(), 0);
  for (std::uint32_t i = 0; i < keys_.size(); ++i) {
    const std::size_t brick = number(above(i));
    order_[bricks_[brick].first + placed[brick]++] = i;
  }
}

void SurfacePlanes::add_to_index(std::uint64_t brick_key) {
  std::uint64_t slot = slot_of(brick_key);
  while (index_[slot & (index_.size() - 1)] != 0) ++slot;
  bricks_.push_back({.key = brick_key});
  index_[slot & (index_.size() - 1)] = static_cast<std::uint32_t>(bricks_.size());
}

const SurfacePlanes::Brick* SurfacePlanes::find_brick(std::uint64_t brick_key) const {
  for (std::uint64_t slot = slot_of(brick_key);; ++slot) {
    const std::uint32_t entry = index_[slot & (index_.size() - 1)];
    if (entry == 0) return nullptr;
    if (bricks_[entry - 1].key == brick_key) return &bricks_[entry - 1];
  }
}

std::span<const Plane> SurfacePlanes::at(ivec3 cell) const {
  if (glm::any(glm::lessThan(cell, ivec3(-1))) || glm::any(glm::greaterThanEqual(cell, size_))) return {};
  if (keys_.empty()) return {};
  const ivec3 above = cell + 1;
  const Brick* brick = find_brick(brick_key(above));
  if (!brick) return {};
  const auto z = static_cast<std::size_t>(above.z & 7);
  const std::uint64_t cells = brick->cells[z], bit = std::uint64_t{1} << bit_of(above);
  if ((cells & bit) == 0) return {};
  const auto rank = static_cast<std::uint32_t>(brick->before[z] + std::popcount(cells & (bit - 1)));
  const std::uint32_t i = order_[brick->first + rank];
  return std::span(planes_).subspan(first_[i], first_[i + 1] - first_[i]);
}

std::uint64_t SurfacePlanes::bytes() const {
  return keys_.size() * sizeof(keys_[0]) + first_.size() * sizeof(first_[0]) +
         planes_.size() * sizeof(planes_[0]) + index_.size() * sizeof(index_[0]) +
         bricks_.size() * sizeof(bricks_[0]) + order_.size() * sizeof(order_[0]);
}

}  // namespace brume::voxel
