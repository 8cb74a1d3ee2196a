#include "scenario/body_sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace brume::scenario {
namespace {

using glm::dvec3;
using glm::ivec3;
using voxel::BitGrid;

dvec3 voxel_space(const BitGrid& grid, const dvec3& world) {
  return (world - dvec3(grid.layout().origin_world)) / double{grid.layout().voxel_size};
}

/// The voxels that a box [voxel space] overlaps.
Box<int> voxels_of(const dvec3& low, const dvec3& high) {
  return {ivec3(glm::floor(low)), ivec3(glm::ceil(high))};
}

Box<int> voxels_of(const BitGrid& grid, const Body& body) {
  return voxels_of(voxel_space(grid, body.low), voxel_space(grid, body.high));
}

/// The bits x + 8 y of a brick's word for [low, high) within it.
std::uint64_t bits_of(ivec3 low, ivec3 high) {
  const std::uint64_t row = ((1u << high.x) - 1u) & ~((1u << low.x) - 1u);
  std::uint64_t bits = 0;
  for (int y = low.y; y < high.y; ++y) bits |= row << (8 * y);
  return bits;
}

/// A summed-volume table: the number of solid voxels of any box within a region in 8 look-ups.
class SolidCount {
 public:
  SolidCount(const BitGrid& grid, const Box<int>& region)
      : low_(region.low), size_(region.high - region.low + 1), sums_(volume(size_), 0) {
    for_each_in(region, [&](ivec3 v) {
      const ivec3 at = v - low_ + 1;
      const bool solid = v.y < 0 || grid.solid(v);
      sums_[index(at)] = static_cast<std::uint32_t>(solid) + sums_[index(at - ivec3(1, 0, 0))] +
                         sums_[index(at - ivec3(0, 1, 0))] + sums_[index(at - ivec3(0, 0, 1))] -
                         sums_[index(at - ivec3(1, 1, 0))] - sums_[index(at - ivec3(1, 0, 1))] -
                         sums_[index(at - ivec3(0, 1, 1))] + sums_[index(at - ivec3(1, 1, 1))];
    });
  }
  /// The box must lie in the region.
  bool any(const Box<int>& box) const {
    const ivec3 a = box.low - low_, b = box.high - low_;
    const auto at = [&](int x, int y, int z) { return sums_[index({x, y, z})]; };
    return at(b.x, b.y, b.z) - at(a.x, b.y, b.z) - at(b.x, a.y, b.z) - at(b.x, b.y, a.z) + at(a.x, a.y, b.z) +
               at(a.x, b.y, a.z) + at(b.x, a.y, a.z) - at(a.x, a.y, a.z) !=
           0;
  }
  static std::size_t volume(ivec3 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
           static_cast<std::size_t>(size.z);
  }

 private:
  std::size_t index(ivec3 v) const {
    return static_cast<std::size_t>(v.x) +
           static_cast<std::size_t>(size_.x) *
               (static_cast<std::size_t>(v.y) +
                static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(v.z));
  }
  ivec3 low_, size_;
  std::vector<std::uint32_t> sums_;
};

/// Offsets along an axis [voxels] at which a body [low, high] touches a voxel face, and 0; shortest first.
/// Each component of the shortest displacement to free space is one of these: otherwise it could be shorter.
std::vector<double> touching_offsets(double low, double high, double farthest, double skin) {
  std::vector<double> offsets{0};
  for (double face = std::ceil(low - farthest); face <= low + farthest; face += 1)
    offsets.push_back(face + skin - low);
  for (double face = std::ceil(high - farthest); face <= high + farthest; face += 1)
    offsets.push_back(face - skin - high);
  std::sort(offsets.begin(), offsets.end(),
            [](double a, double b) { return std::pair(std::abs(a), a) < std::pair(std::abs(b), b); });
  return offsets;
}

}  // namespace

bool any_solid(const BitGrid& grid, const Box<int>& voxels) {
  if (voxels.empty()) return false;
  if (voxels.low.y < 0) return true;
  const Box<int> inside = intersection(voxels, {ivec3(0), grid.size()});
  if (inside.empty()) return false;
  const Box<int> bricks{inside.low >> 3, ((inside.high - 1) >> 3) + 1};
  bool found = false;
  for_each_in(bricks, [&](ivec3 b) {
    const BitGrid::Brick* brick = found ? nullptr : grid.find_brick(b);
    if (brick == nullptr) return;
    const ivec3 low = glm::max(inside.low - 8 * b, ivec3(0)), high = glm::min(inside.high - 8 * b, ivec3(8));
    const std::uint64_t bits = bits_of(low, high);
    for (int z = low.z; z < high.z; ++z) found |= ((*brick)[static_cast<unsigned>(z)] & bits) != 0;
  });
  return found;
}

bool is_stuck(const BitGrid& grid, const Body& body) {
  return any_solid(grid, voxels_of(grid, body));
}

double sweep(const BitGrid& grid, const Body& body, int axis, double distance) {
  if (distance == 0) return 0;
  const double edge = double{grid.layout().voxel_size}, skin = kSkin / edge;
  const Box<int> across = voxels_of(grid, body);
  const double front = voxel_space(grid, distance > 0 ? body.high : body.low)[axis];
  const double goal = front + distance / edge;
  const int step = distance > 0 ? 1 : -1;
  // Test the voxels ahead of the body layer by layer.
  for (int layer = static_cast<int>(distance > 0 ? std::ceil(front) : std::floor(front) - 1);;
       layer += step) {
    const double face = distance > 0 ? layer : layer + 1;  // towards the body
    if (distance > 0 ? face >= goal + skin : face <= goal - skin) return distance;
    Box<int> voxels = across;
    voxels.low[axis] = layer;
    voxels.high[axis] = layer + 1;
    if (!any_solid(grid, voxels)) continue;
    const double allowed = (face - step * skin - front) * edge;
    return distance > 0 ? std::max(0.0, allowed) : std::min(0.0, allowed);
  }
}

dvec3 offset_to_free_space(const BitGrid& grid, const Body& body, double farthest) {
  constexpr std::size_t kMostVoxels = std::size_t{1} << 26;
  const double edge = double{grid.layout().voxel_size}, skin = kSkin / edge;
  const dvec3 low = voxel_space(grid, body.low), high = voxel_space(grid, body.high);
  // Search ever larger neighbourhoods.
  for (double reach = std::min(std::max(0.25, 1.01 * edge), farthest);;
       reach = std::min(2 * reach, farthest)) {
    const double far = reach / edge;
    const Box<int> around = voxels_of(low - far - 1.0, high + far + 1.0);
    if (SolidCount::volume(around.high - around.low + 1) > kMostVoxels) break;
    const SolidCount solid(grid, around);
    std::array<std::vector<double>, 3> offsets;
    for (int axis = 0; axis < 3; ++axis)
      offsets[static_cast<std::size_t>(axis)] = touching_offsets(low[axis], high[axis], far, skin);

    // Try all that are shorter than the best so far. Beyond `far` the shortest one might be missed.
    double best = far * far;
    dvec3 found(0);
    bool is_found = false;
    for (const double x : offsets[0]) {
      if (x * x > best) break;
      for (const double z : offsets[2]) {
        if (x * x + z * z > best) break;
        for (const double y : offsets[1]) {
          const double square = x * x + y * y + z * z;
          if (square > best || (is_found && square == best)) break;
          if (solid.any(voxels_of(low + dvec3(x, y, z), high + dvec3(x, y, z)))) continue;
          best = square;
          found = {x, y, z};
          is_found = true;
          break;
        }
      }
    }
    if (is_found) return found * edge;
    if (reach >= farthest) break;
  }

  // Straight up, voxel by voxel: above the grid everything is free.
  dvec3 up(0);
  while (any_solid(grid, voxels_of(low + up, high + up))) up.y = std::floor(low.y + up.y) + 1 + skin - low.y;
  return up * edge;
}

}  // namespace brume::scenario
