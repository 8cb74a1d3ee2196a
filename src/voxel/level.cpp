#include "voxel/level.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "voxel/voxelize.hpp"

namespace brume::voxel {
namespace {

using glm::dvec3;
using glm::ivec3;

constexpr std::size_t kTrianglesPerRun = 32;

// The bits of a brick's slice z within the box.
std::uint64_t slice_bits(const Box<int>& box, ivec3 brick, int z) {
  const Box<int> in_brick = intersection<int>({box.low - brick * kBrickSize, box.high - brick * kBrickSize},
                                              {ivec3(0), ivec3(kBrickSize)});
  if (in_brick.empty() || z < in_brick.low.z || z >= in_brick.high.z) return 0;
  const std::uint64_t row = (std::uint64_t{1} << in_brick.high.x) - (std::uint64_t{1} << in_brick.low.x);
  std::uint64_t bits = 0;
  for (int y = in_brick.low.y; y < in_brick.high.y; ++y) bits |= row << (8 * y);
  return bits;
}

Box<int> bricks_of(const Box<int>& voxels) {
  if (voxels.empty()) return {};
  return {voxels.low >> 3, ((voxels.high - 1) >> 3) + 1};
}

void fill_box(BitGrid& grid, const Box<int>& voxels, bool solid) {
  for_each_in(bricks_of(voxels), [&](ivec3 at) {
    BitGrid::Brick* brick = solid ? &grid.ensure_brick(at) : grid.find_brick_to_write(at);
    for (int z = 0; brick && z < kBrickSize; ++z) {
      std::uint64_t& slice = (*brick)[static_cast<unsigned>(z)];
      const std::uint64_t bits = slice_bits(voxels, at, z);
      slice = solid ? slice | bits : slice & ~bits;
    }
  });
}

BitGrid make_copy(const BitGrid& grid, const Box<int>& voxels) {
  BitGrid copy(grid.layout());
  for_each_in(bricks_of(voxels), [&](ivec3 at) {
    const BitGrid::Brick* brick = grid.find_brick(at);
    if (!brick) return;
    BitGrid::Brick& target = copy.ensure_brick(at);
    for (int z = 0; z < kBrickSize; ++z)
      target[static_cast<unsigned>(z)] = (*brick)[static_cast<unsigned>(z)] & slice_bits(voxels, at, z);
  });
  return copy;
}

// The bounding box of both.
Box<int> joined(const Box<int>& a, const Box<int>& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

}  // namespace

Level::Level(BitGrid grid, std::vector<std::vector<Triangle>> parts) : grid_(std::move(grid)) {
  parts_.reserve(parts.size());
  for (auto& triangles : parts) parts_.push_back(make_part(std::move(triangles), Role::wall));
}

Level::Level(BitGrid grid, RoleGrids roles, std::vector<LevelPart> parts)
    : grid_(std::move(grid)), roles_(std::move(roles)) {
  parts_.reserve(parts.size());
  for (LevelPart& part : parts) {
    BRUME_ASSERT(part.role != Role::glass || roles_.sight, "a level of glass has a grid of what stops sight");
    BRUME_ASSERT(part.role != Role::grille || roles_.bodies, "one of grilles has one of what stops bodies");
    parts_.push_back(make_part(std::move(part.triangles), part.role));
  }
}

Level::Part Level::make_part(std::vector<Triangle> triangles, Role role) {
  constexpr Run kNothing{glm::vec3(INFINITY), glm::vec3(-INFINITY)};
  Part part;
  part.role = role;
  part.triangles = std::move(triangles);
  part.bounds = kNothing;
  for (std::size_t i = 0; i < part.triangles.size(); ++i) {
    if (i % kTrianglesPerRun == 0) part.runs.push_back(kNothing);
    Run& run = part.runs.back();
    const Triangle& t = part.triangles[i];
    // This argument order ignores NaN: triangles with a NaN are skipped everywhere.
    for (const glm::vec3& p : {t.a, t.b, t.c}) {
      run.low = glm::min(run.low, p);
      run.high = glm::max(run.high, p);
    }
    part.bounds.low = glm::min(part.bounds.low, run.low);
    part.bounds.high = glm::max(part.bounds.high, run.high);
  }
  return part;
}

bool Level::Reach::misses(const Run& run) const {
  return glm::any(glm::lessThan(dvec3(run.high), low)) || glm::any(glm::greaterThan(dvec3(run.low), high));
}

Level::Reach Level::reach_of(const dvec3& low_voxel, const dvec3& high_voxel) const {
  constexpr double kMargin = 1e-3;
  // Triangles that only touch the box count; the margin is far above the rounding error.
  const GridLayout& layout = grid_.layout();
  const dvec3 origin(layout.origin_world);
  const double size = layout.voxel_size;
  return {origin + (low_voxel - kMargin) * size, origin + (high_voxel + kMargin) * size};
}

Box<int> Level::voxels_of(const Part& part) const {
  const GridLayout& layout = grid_.layout();
  Box<int> box;  // As in voxelize, touching the face of a voxel counts.
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = layout.origin_world[axis], size = layout.voxel_size;
    const double low = (part.bounds.low[axis] - origin) / size,
                 high = (part.bounds.high[axis] - origin) / size;
    // Include one voxel outside of the grid: the planes of border cells depend on it.
    const auto clamped = [&](double v) {
      return static_cast<int>(std::clamp(v, -2.0, layout.size[axis] + 2.0));
    };
    box.low[axis] = clamped(std::ceil(low) - 1);
    box.high[axis] = clamped(std::floor(high) + 1);
  }
  return box;
}

void Level::gather(const Part& part, const Reach& reach, std::vector<Triangle>& out) const {
  if (!part.shown || reach.misses(part.bounds)) return;
  for (std::size_t run = 0; run < part.runs.size(); ++run) {
    if (reach.misses(part.runs[run])) continue;
    const std::size_t end = std::min(part.triangles.size(), (run + 1) * kTrianglesPerRun);
    for (std::size_t i = run * kTrianglesPerRun; i < end; ++i) {
      const Triangle& t = part.triangles[i];
      if (!reach.misses({glm::min(glm::min(t.a, t.b), t.c), glm::max(glm::max(t.a, t.b), t.c)}))
        out.push_back(t);
    }
  }
}

LevelChange Level::show(std::span<const std::uint32_t> parts, bool shown) {
  Box<int> touched;
  ++last_layer_;
  for (const std::uint32_t i : parts) {
    BRUME_ASSERT(i < parts_.size(), std::to_string(i));
    Part& part = parts_[i];
    if (part.shown == shown) continue;
    part.shown = shown;
    part.layer = last_layer_;
    touched = joined(touched, voxels_of(part));
  }
  return rebuild(touched);
}

LevelChange Level::replace(std::uint32_t number, std::vector<Triangle> triangles) {
  BRUME_ASSERT(number < parts_.size(), std::to_string(number));
  Part part = make_part(std::move(triangles), parts_[number].role);
  part.shown = parts_[number].shown;
  part.layer = ++last_layer_;
  const Box<int> touched = part.shown ? joined(voxels_of(parts_[number]), voxels_of(part)) : Box<int>{};
  parts_[number] = std::move(part);
  return rebuild(touched);
}

std::uint32_t Level::add_part() {
  parts_.push_back(make_part({}, Role::wall));
  return part_count() - 1;
}

LevelChange Level::set_box(Box<int> box, bool solid) {
  box = intersection(box, {ivec3(0), grid_.size()});
  if (box.empty()) return rebuild({});
  // Boxes that it covers have no effect any more.
  std::erase_if(boxes_, [&](const EditedBox& other) { return box.contains(other.voxels); });
  boxes_.push_back({box, solid, ++last_layer_});
  return rebuild(box);
}

/// Redraws the voxels from all layers.
void Level::paint(const Box<int>& voxels) {
  // All visible layers, bottom to top.
  struct Layer {
    std::uint64_t order;
    const Part* part;
    const EditedBox* box;
  };
  std::vector<Layer> layers;
  for (const Part& part : parts_)
    if (part.shown) layers.push_back({part.layer, &part, nullptr});
  for (const EditedBox& box : boxes_) layers.push_back({box.layer, nullptr, &box});
  std::stable_sort(layers.begin(), layers.end(),
                   [](const Layer& a, const Layer& b) { return a.order < b.order; });

  // Draw them over an empty box.
  fill_boxes(voxels, false);
  const Reach reach = reach_of(dvec3(voxels.low), dvec3(voxels.high));
  std::vector<Triangle> triangles;
  for (const Layer& layer : layers) {
    if (layer.box) {
      fill_boxes(intersection(layer.box->voxels, voxels), layer.box->solid);
      continue;
    }
    triangles.clear();
    gather(*layer.part, reach, triangles);
    draw_part(layer.part->role, triangles, voxels);
  }
}

/// Fills the boxes of all grids.
void Level::fill_boxes(const Box<int>& voxels, bool solid) {
  fill_box(grid_, voxels, solid);
  if (roles_.sight) fill_box(*roles_.sight, voxels, solid);
  if (roles_.bodies) fill_box(*roles_.bodies, voxels, solid);
}

void Level::draw_part(Role role, std::span<const Triangle> triangles, const Box<int>& voxels) {
  if (stops_smoke(role)) draw_triangles(triangles, voxels, grid_);
  if (roles_.sight && stops_sight(role)) draw_triangles(triangles, voxels, *roles_.sight);
  if (roles_.bodies && stops_bodies(role)) draw_triangles(triangles, voxels, *roles_.bodies);
}

LevelChange Level::rebuild(const Box<int>& touched) {
  const Box<int> voxels = intersection(touched, {ivec3(0), grid_.size()});
  // Every cell with a corner in a touched voxel, including voxels outside of the grid.
  const Box<int> cells = touched.empty()
                             ? Box<int>{}
                             : intersection<int>({touched.low - 1, touched.high}, {ivec3(-1), grid_.size()});
  LevelChange change{voxels, cells, make_copy(grid_, voxels), {}};
  if (roles_.sight) change.roles_before.sight = make_copy(*roles_.sight, voxels);
  if (roles_.bodies) change.roles_before.bodies = make_copy(*roles_.bodies, voxels);
  if (voxels.empty()) change.voxels = {};
  if (cells.empty()) change.cells = {};
  if (!voxels.empty()) paint(voxels);
  change.planes = planes_in(change.cells);
  return change;
}

void Level::add_faces(const EditedBox& box, std::vector<Triangle>& out) const {
  const auto corner = [&](int axis, int side, int u, int w) {
    ivec3 v;
    v[axis] = side ? box.voxels.high[axis] : box.voxels.low[axis];
    v[(axis + 1) % 3] = u ? box.voxels.high[(axis + 1) % 3] : box.voxels.low[(axis + 1) % 3];
    v[(axis + 2) % 3] = w ? box.voxels.high[(axis + 2) % 3] : box.voxels.low[(axis + 2) % 3];
    return world_from_voxel(grid_.layout(), glm::vec3(v));
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1}) {
      const glm::vec3 a = corner(axis, side, 0, 0), b = corner(axis, side, 1, 0),
                      c = corner(axis, side, 1, 1), d = corner(axis, side, 0, 1);
      out.push_back({a, b, c});
      out.push_back({a, c, d});
    }
}

SurfacePlanes Level::planes_in(const Box<int>& cells) const {
  const Reach reach = reach_of(dvec3(cells.low) + 0.5, dvec3(cells.high) + 0.5);
  std::vector<Triangle> triangles;
  for (const Part& part : parts_)
    if (stops_smoke(part.role)) gather(part, reach, triangles);
  std::vector<Box<int>> cleared;
  const Box<int> corners{cells.low, cells.high + 1};
  for (const EditedBox& box : boxes_) {
    if (intersection(box.voxels, {corners.low - 1, corners.high + 1}).empty()) continue;
    if (box.solid) {
      add_faces(box, triangles);
    } else {
      cleared.push_back(box.voxels);
    }
  }
  return SurfacePlanes::build_in(triangles, grid_, cells, cleared);
}

std::uint64_t Level::bytes() const {
  std::uint64_t sum = grid_.bytes() + roles_.bytes() + boxes_.size() * sizeof(EditedBox);
  for (const Part& part : parts_)
    sum += sizeof(Part) + part.triangles.size() * sizeof(Triangle) + part.runs.size() * sizeof(Run);
  return sum;
}

}  // namespace brume::voxel
