#include "spheres/brick_lists.hpp"

#include <algorithm>
#include <atomic>

#include "core/error.hpp"
#include "core/tasks.hpp"

namespace brume::spheres {
namespace {

constexpr std::size_t kGrain = 4096;  // spheres of a task

glm::ivec3 brick_of(const glm::vec3& voxel, const glm::ivec3& bricks) {
  const glm::vec3 brick = glm::floor(voxel / static_cast<float>(shared::kSphereBrick));
  return glm::clamp(glm::ivec3(brick), glm::ivec3(0), bricks - 1);
}

// Calls visit(brick) for the bricks that a sphere touches. A voxel more around it: rounding of its bounds.
template <typename Visit>
void for_each_brick(const Sphere& sphere, const glm::ivec3& bricks, const Visit& visit) {
  constexpr float kEdge = static_cast<float>(shared::kSphereBrick);
  const glm::ivec3 low = brick_of(sphere.center - sphere.radius - 1.0f, bricks);
  const glm::ivec3 high = brick_of(sphere.center + sphere.radius + 1.0f, bricks);
  glm::ivec3 brick;
  for (brick.z = low.z; brick.z <= high.z; ++brick.z)
    for (brick.y = low.y; brick.y <= high.y; ++brick.y)
      for (brick.x = low.x; brick.x <= high.x; ++brick.x) {
        const glm::vec3 corner = kEdge * glm::vec3(brick);
        if (shared::sphere_touches(packed(sphere), corner, corner + kEdge)) visit(brick);
      }
}

}  // namespace

BrickLists list_bricks(const Tank& tank) {
  BrickLists lists;
  lists.bricks = (glm::ivec3(tank.size) + (shared::kSphereBrick - 1)) / shared::kSphereBrick;
  const std::size_t bricks =
      std::size_t(lists.bricks.x) * std::size_t(lists.bricks.y) * std::size_t(lists.bricks.z);

  // Count.
  std::vector<std::atomic<std::uint32_t>> ends(bricks);
  std::atomic<std::uint64_t> all{0};
  parallel_for(tank.spheres.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::uint64_t count = 0;
    for (std::size_t i = begin; i < end; ++i)
      for_each_brick(tank.spheres[i], lists.bricks, [&](const glm::ivec3& brick) {
        ends[lists.index(brick)].fetch_add(1, std::memory_order_relaxed);
        ++count;
      });
    all += count;
  });
  if (all > UINT32_MAX)
    throw Error(ErrorCode::resource_limit,
                "the tank's spheres touch " + std::to_string(all) +
                    " bricks in all, more than 2^32 - 1; have fewer or smaller spheres");

  // Ranges one after the other.
  lists.ranges.resize(bricks);
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < bricks; ++i) {
    lists.ranges[i] = {first, ends[i]};
    first += ends[i];
    ends[i] = lists.ranges[i].first;
  }

  // Fill, in any order, then sort.
  lists.spheres.resize(all);
  parallel_for(tank.spheres.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for_each_brick(tank.spheres[i], lists.bricks, [&](const glm::ivec3& brick) {
        const std::uint32_t at = ends[lists.index(brick)].fetch_add(1, std::memory_order_relaxed);
        lists.spheres[at] = static_cast<std::uint32_t>(i);
      });
  });
  parallel_for(bricks, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto from = lists.spheres.begin() + lists.ranges[i].first;
      std::sort(from, from + lists.ranges[i].count);
    }
  });
  return lists;
}

}  // namespace brume::spheres
