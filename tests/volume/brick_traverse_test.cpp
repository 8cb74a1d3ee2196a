// The traversal of shaders/shared/dda.h in two levels, over the page table of a sparse volume as shaders read
// it (shaders/shared/volume.h), against all bricks of the volume and all voxels on the ray.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "shared/dda.h"
#include "tests/sanitized.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::volume {
namespace {

using glm::ivec3;
using glm::vec3;

constexpr int kNodeVoxels = shared::kNodeBricks * shared::kBrickVoxels;

struct Ray {
  vec3 origin, direction;  // [voxels]
  float t_end = 0;
};

struct Crossing {
  ivec3 brick;
  float enter, leave;
};

/// A page table in one buffer, behind other entries, as passes::BrickAtlas uploads it.
class DevicePages {
 public:
  explicit DevicePages(const SparseVolume& volume) : layout_(volume.layout().bricks) {
    layout_.first_page = 77;
    pages_.assign(layout_.first_page, 12345);
    pages_.insert(pages_.end(), volume.pages().root().begin(), volume.pages().root().end());
    pages_.insert(pages_.end(), volume.pages().nodes().begin(), volume.pages().nodes().end());
  }
  const shared::BrickLayout& layout() const { return layout_; }
  std::uint32_t node_of(ivec3 brick) const {
    const std::uint32_t root = shared::root_page(layout_, brick);
    return root == shared::kNoPage || pages_[root] < shared::kFirstNode ? 0 : pages_[root];
  }
  bool has(std::uint32_t node, ivec3 brick) const {
    return pages_[shared::node_page(layout_, node, brick)] != 0;
  }

 private:
  shared::BrickLayout layout_;
  std::vector<std::uint32_t> pages_;
};

/// Nodes of 64^3 voxels along the ray, and in those that exist bricks of 8^3: as lib/voxel_rays.glsl nests
/// its cells.
std::vector<Crossing> two_level_walk(const DevicePages& pages, const Ray& ray) {
  std::vector<Crossing> crossings;
  const ivec3 first = pages.layout().window_origin, last = first + pages.layout().window_size;
  shared::Dda outer = shared::dda_begin(ray.origin, ray.direction, first, last, kNodeVoxels, 0, ray.t_end);
  for (; outer.t < outer.t_end; outer = shared::dda_step(outer)) {
    const ivec3 low = outer.cell * shared::kNodeBricks;
    const std::uint32_t node = pages.node_of(low);
    if (node == 0) continue;
    const float leave = std::min(shared::dda_min(shared::dda_leave(outer)), outer.t_end);
    shared::Dda inner = shared::dda_begin(ray.origin, ray.direction, low, low + shared::kNodeBricks,
                                          shared::kBrickVoxels, outer.t, leave);
    for (; inner.t < inner.t_end; inner = shared::dda_step(inner))
      if (pages.has(node, inner.cell))
        crossings.push_back(
            {inner.cell, inner.t, std::min(shared::dda_min(shared::dda_leave(inner)), inner.t_end)});
  }
  return crossings;
}

/// Where a ray is in a cube of voxels, plane by plane as dda.h defines a crossing.
std::pair<float, float> interval_in(const Ray& ray, ivec3 low, int edge) {
  float enter = 0, leave = ray.t_end;
  for (int axis = 0; axis < 3; ++axis) {
    const float o = ray.origin[axis], inverse = shared::dda_inverse(ray.direction[axis]);
    const float a = (static_cast<float>(low[axis]) - o) * inverse;
    const float b = (static_cast<float>(low[axis] + edge) - o) * inverse;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return {enter, leave};
}

/// Bricks of the volume that hold a voxel on the ray, by a walk over single voxels.
std::set<std::uint32_t> slots_by_voxels(const SparseVolume& volume, const Ray& ray) {
  const shared::BrickLayout& layout = volume.layout().bricks;
  const ivec3 low = layout.window_origin * kNodeVoxels, high = low + layout.window_size * kNodeVoxels;
  std::set<std::uint32_t> slots;
  shared::Dda d = shared::dda_begin(ray.origin, ray.direction, low, high, 1, 0, ray.t_end);
  for (; d.t < d.t_end; d = shared::dda_step(d))
    if (const std::uint32_t slot = volume.slot_at(d.cell >> 3); slot != SparseVolume::kNoSlot)
      slots.insert(slot);
  return slots;
}

SparseVolume random_volume(std::mt19937& random, int bricks) {
  SparseVolume volume({{}, 1, {{2}}});
  volume.begin_update();
  std::uniform_int_distribution<int> near(-4, 4), far(-24, 23);
  for (int i = 0; i < bricks; ++i) {
    const ivec3 at = i % 2 ? ivec3(near(random), near(random), near(random))
                           : ivec3(far(random), far(random), far(random));
    if (volume.slot_at(at) == SparseVolume::kNoSlot) volume.acquire(at);
  }
  volume.end_update();
  return volume;
}

/// From anywhere, or a point of the lattice of voxels, bricks or nodes, so that rays run along planes and
/// through edges; in any direction, along an axis, across one, diagonal, or nearly parallel to a plane.
Ray random_ray(std::mt19937& random) {
  std::uniform_real_distribution<float> place(-260, 260), side(-1, 1);
  Ray ray{{place(random), place(random), place(random)}, {side(random), side(random), side(random)}, 0};
  const std::array lattice{0.0f, 0.0f, 1.0f, 8.0f, 64.0f};
  const float snap = lattice[random() % lattice.size()];
  for (int axis = 0; axis < 3 && snap > 0; ++axis)
    if (random() % 3 != 0) ray.origin[axis] = snap * std::round(ray.origin[axis] / snap);
  const int axis = static_cast<int>(random() % 3);
  switch (random() % 6) {
    case 0:
      for (int other = 0; other < 3; ++other)
        if (other != axis) ray.direction[other] = random() % 2 ? 0.0f : -0.0f;
      break;
    case 1:
      ray.direction[axis] = 0;
      break;
    case 2:
      for (int other = 0; other < 3; ++other) ray.direction[other] = static_cast<float>(random() % 3) - 1;
      break;
    case 3:  // grazing
      ray.direction[axis] *= 1e-6f;
      break;
    default:
      // Through the middle, where bricks are dense.
      ray.direction = 0.02f * vec3(place(random), place(random), place(random)) - ray.origin;
  }
  if (ray.direction == vec3(0)) ray.direction[axis] = 1;
  ray.t_end = random() % 4 ? std::numeric_limits<float>::infinity()
                           : std::abs(place(random)) / glm::length(ray.direction);
  return ray;
}

TEST(BrickTraverse, VisitsTheBricksOfAllVoxelsOnTheRayAndNoOthers) {
  std::mt19937 random(3);
  int crossed = 0;
  for (int round = 0; round < 20; ++round) {
    const SparseVolume volume = random_volume(random, 10 + 40 * round);
    const DevicePages pages(volume);
    for (int i = 0; i < (kSanitized ? 100 : 1500); ++i) {
      const Ray ray = random_ray(random);
      const std::vector<Crossing> walk = two_level_walk(pages, ray);

      // Every brick whose planes the ray crosses, with the same times, in order.
      std::size_t expected = 0;
      for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
        const ivec3 brick = volume.brick_of(slot);
        const auto [enter, leave] = interval_in(ray, brick * shared::kBrickVoxels, shared::kBrickVoxels);
        if (!(enter < leave)) continue;
        ++expected;
        const auto found = std::ranges::find(walk, brick, &Crossing::brick);
        ASSERT_NE(found, walk.end()) << "ray " << i << " misses " << brick.x << ' ' << brick.y << ' '
                                     << brick.z;
        ASSERT_EQ(found->enter, enter);
        ASSERT_EQ(found->leave, leave);
      }
      ASSERT_EQ(walk.size(), expected) << "ray " << i;
      for (std::size_t k = 1; k < walk.size(); ++k) ASSERT_LE(walk[k - 1].leave, walk[k].enter);

      // The same bricks by all voxels on the ray.
      if (i % 10 == 0) {
        std::set<std::uint32_t> slots;
        for (const Crossing& crossing : walk) slots.insert(volume.slot_at(crossing.brick));
        ASSERT_EQ(slots, slots_by_voxels(volume, ray)) << "ray " << i;
      }
      crossed += static_cast<int>(walk.size());
    }
  }
  EXPECT_GT(crossed, kSanitized ? 2000 : 30000);
}

}  // namespace
}  // namespace brume::volume
