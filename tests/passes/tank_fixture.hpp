// Small tanks for tests, and a device that holds them.
#pragma once

#include <random>

#include "passes/sphere_voxels.hpp"
#include "spheres/brick_lists.hpp"
#include "tests/gpu/gpu_test.hpp"

namespace brume::passes {

/// Spheres thrown into a tank until `tries` are used up: those that overlap none of those before stay.
inline spheres::Tank random_tank(const glm::uvec3& size, glm::vec2 radius, int tries, std::uint32_t opacity,
                                 std::uint32_t seed) {
  spheres::Tank tank;
  tank.size = size;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int i = 0; i < tries; ++i) {
    spheres::Sphere sphere;
    sphere.radius = glm::mix(radius.x, radius.y, unit(random) * unit(random));
    const glm::vec3 room = glm::vec3(size) - 2 * sphere.radius;
    if (std::min({room.x, room.y, room.z}) < 0) continue;
    sphere.center = sphere.radius + room * glm::vec3(unit(random), unit(random), unit(random));
    const bool is_free = std::ranges::none_of(tank.spheres, [&](const spheres::Sphere& other) {
      return glm::distance(sphere.center, other.center) < 1.0001f * (sphere.radius + other.radius);
    });
    if (!is_free) continue;
    tank.spheres.push_back(sphere);
    tank.colors.push_back((random() & 0xffffffu) | opacity << 24);
  }
  return tank;
}

/// A tank on the device, its voxels found.
struct DeviceTank {
  spheres::BrickLists lists;
  TankVolume volume;

  DeviceTank(gpu::Context& context, gpu::CommandRunner& runner, const spheres::Tank& tank)
      : lists(spheres::list_bricks(tank)), volume(context, tank, lists) {
    volume.upload(runner, tank, lists);
    volume.add_ids(context);
    volume.add_colors(context);
    const SphereVoxelsPass pass(context);
    runner.run([&](gpu::Recorder& recorder) { pass.record(recorder, volume); });
  }
};

/// Texels of an image of unsigned integers, which are read by copies.
inline std::size_t voxel_index(const glm::ivec3& size, const glm::ivec3& voxel) {
  return (std::size_t(voxel.z) * std::size_t(size.y) + std::size_t(voxel.y)) * std::size_t(size.x) +
         std::size_t(voxel.x);
}

}  // namespace brume::passes
