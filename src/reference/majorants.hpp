// Upper bounds of a medium along a ray.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "surfaces/ray.hpp"

namespace brume::reference {

using surfaces::Ray;

/// By how much bounds exceed what they are of: values at points are rounded.
constexpr float kBoundSlack = 1.0001f;

/// Cells of equal size under an affine transform, each with an upper bound of the extinction in it [1/m]. A
/// cell may be divided into voxels with bounds of their own.
class Majorants {
 public:
  Majorants() = default;
  /// Around a box of voxels; cells of `cell` voxels, or the least power of two of them that leaves at most
  /// kMostCells.
  Majorants(const glm::mat4& world_from_voxel, const Box<int>& voxels, int cell);

  static constexpr std::uint64_t kMostCells = std::uint64_t{1} << 24;

  const glm::ivec3& size() const { return size_; }
  int cell_voxels() const { return cell_; }
  float& at(const glm::ivec3& cell) { return bounds_[index(cell)]; }
  /// The extinction in a part of a cell is nowhere less; the least of all parts counts.
  void lower_least(const glm::ivec3& cell, float least) {
    if (least_.empty()) least_.resize(bounds_.size(), std::numeric_limits<float>::infinity());
    float& stored = least_[index(cell)];
    stored = glm::min(stored, least);
  }
  /// 0 where nothing was said.
  float least(std::uint32_t cell) const {
    return least_.empty() || least_[cell] > bounds_[cell] ? 0 : least_[cell];
  }
  /// Bounds of the voxels of a cell, cell_voxels()^3 of them, x fastest, then y, then z; none above the
  /// cell's.
  void divide(const glm::ivec3& cell, std::span<const float> bounds) {
    if (divided_.empty()) divided_.resize(bounds_.size());
    voxel_bounds_.insert(voxel_bounds_.end(), bounds.begin(), bounds.end());
    divided_[index(cell)] = static_cast<std::uint32_t>(voxel_bounds_.size() / bounds.size());
  }
  std::uint32_t count() const { return static_cast<std::uint32_t>(bounds_.size()); }
  /// By the number of a cell, below count().
  float bound(std::uint32_t cell) const { return bounds_[cell]; }
  /// The cell of a point; nothing outside of all.
  std::optional<std::uint32_t> cell_at(const glm::vec3& p_world) const;
  /// A point at fractions of a cell.
  glm::vec3 world_point(std::uint32_t cell, const glm::vec3& at) const;
  float cell_volume() const { return cell_volume_; }  ///< [m^3]
  glm::vec3 voxel_from_world(const glm::vec3& p_world) const {
    return glm::vec3(voxel_from_world_ * glm::vec4(p_world, 1));
  }

  /// Calls visit(begin, end, bound) for the parts of a ray in cells, and voxels of divided ones, whose bound
  /// is above 0, in order, until it returns true. Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm
  /// for Ray Tracing".
  template <typename Visit>
  void traverse(const Ray& ray, const Visit& visit) const {
    traverse_between(ray,
                     [&](float begin, float end, float, float bound) { return visit(begin, end, bound); });
  }
  /// The same with visit(begin, end, least, bound).
  template <typename Visit>
  void traverse_between(const Ray& ray, const Visit& visit) const {
    traverse_cells(ray, [&](float begin, float end, std::uint32_t cell) {
      if (!(bounds_[cell] > 0)) return false;
      if (divided_.empty() || divided_[cell] == 0) return visit(begin, end, least(cell), bounds_[cell]);
      return traverse_voxels(ray, cell, begin, end, [&](float from, float to, float bound) {
        return bound > 0 && visit(from, to, least(cell), bound);
      });
    });
  }
  /// The same with the numbers of all cells: visit(begin, end, cell).
  template <typename Visit>
  void traverse_cells(const Ray& ray, const Visit& visit) const;

 private:
  /// The part [t, end) of a line through cells of unit size, `from` + t `along`: calls visit(begin, end,
  /// cell) until it returns true, and returns whether it did.
  template <typename Visit>
  static bool walk(const glm::vec3& from, const glm::vec3& along, const glm::ivec3& size, float t, float end,
                   const Visit& visit);
  /// visit(begin, end, bound) for the voxels of a divided cell.
  template <typename Visit>
  bool traverse_voxels(const Ray& ray, std::uint32_t cell, float begin, float end, const Visit& visit) const;

  glm::ivec3 place(std::uint32_t cell) const {
    const glm::uvec3 size(size_);
    return glm::ivec3(cell % size.x, cell / size.x % size.y, cell / size.x / size.y);
  }
  std::size_t index(const glm::ivec3& cell) const {
    return static_cast<std::size_t>(cell.x) +
           static_cast<std::size_t>(size_.x) *
               (static_cast<std::size_t>(cell.y) +
                static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(cell.z));
  }

  glm::mat4 voxel_from_world_{1}, world_from_voxel_{1};
  glm::ivec3 low_voxel_{0}, size_{0};
  int cell_ = 1;
  float cell_volume_ = 0;
  std::vector<float> bounds_, least_;
  std::vector<std::uint32_t>
      divided_;  // by cell, where it ends in voxel_bounds_ [cells]; 0: it is not divided
  std::vector<float> voxel_bounds_;
};

template <typename Visit>
bool Majorants::walk(const glm::vec3& from, const glm::vec3& along, const glm::ivec3& size, float t,
                     float end, const Visit& visit) {
  glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(from + t * along)), glm::ivec3(0), size - 1);
  glm::ivec3 step;
  glm::vec3 next, width;
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / along[axis];
    step[axis] = along[axis] < 0 ? -1 : 1;
    width[axis] = glm::abs(inverse);
    next[axis] = along[axis] == 0
                     ? std::numeric_limits<float>::infinity()
                     : (static_cast<float>(cell[axis] + (step[axis] > 0)) - from[axis]) * inverse;
  }
  while (true) {
    // Without branches, whose outcome nothing foretells.
    const int of_two = next.y < next.x ? 1 : 0;
    const int axis = next.z < glm::min(next.x, next.y) ? 2 : of_two;
    const float leave = glm::min(next[axis], end);
    if (leave > t && visit(t, leave, cell)) return true;
    if (!(next[axis] < end)) return false;
    t = glm::max(t, leave);
    cell[axis] += step[axis];
    if (cell[axis] < 0 || cell[axis] >= size[axis]) return false;
    next[axis] += width[axis];
  }
}

template <typename Visit>
void Majorants::traverse_cells(const Ray& ray, const Visit& visit) const {
  // The part of the ray inside of the box of all cells.
  const float per_cell = 1 / static_cast<float>(cell_);
  const glm::vec3 from = (voxel_from_world(ray.origin) - glm::vec3(low_voxel_)) * per_cell;
  const glm::vec3 along = glm::vec3(voxel_from_world_ * glm::vec4(ray.direction, 0)) * per_cell;
  float t = 0, end = ray.end;
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / along[axis];
    if (along[axis] == 0) {
      if (from[axis] < 0 || from[axis] >= static_cast<float>(size_[axis])) return;
      continue;
    }
    const float a = -from[axis] * inverse, b = (static_cast<float>(size_[axis]) - from[axis]) * inverse;
    t = glm::max(t, glm::min(a, b));
    end = glm::min(end, glm::max(a, b));
  }
  if (!(t < end)) return;

  walk(from, along, size_, t, end, [&](float begin, float leave, const glm::ivec3& cell) {
    return visit(begin, leave, static_cast<std::uint32_t>(index(cell)));
  });
}

template <typename Visit>
bool Majorants::traverse_voxels(const Ray& ray, std::uint32_t cell, float begin, float end,
                                const Visit& visit) const {
  const glm::vec3 from = voxel_from_world(ray.origin) - glm::vec3(low_voxel_ + cell_ * place(cell));
  const glm::vec3 along(voxel_from_world_ * glm::vec4(ray.direction, 0));
  const std::size_t count = static_cast<std::size_t>(cell_ * cell_ * cell_);
  const float* const bounds = voxel_bounds_.data() + (divided_[cell] - 1) * count;
  return walk(from, along, glm::ivec3(cell_), begin, end, [&](float t, float leave, const glm::ivec3& voxel) {
    return visit(t, leave, bounds[voxel.x + cell_ * (voxel.y + cell_ * voxel.z)]);
  });
}

}  // namespace brume::reference
