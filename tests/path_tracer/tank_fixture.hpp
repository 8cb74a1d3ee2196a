// Small tanks for tests of their path tracer and of their light paths.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <random>

#include "reference/tank_tracer.hpp"
#include "tests/path_tracer/statistics.hpp"

namespace brume::reference {

constexpr double kPi = std::numbers::pi;
constexpr spheres::Color kWhite = 0xffffffff;

inline spheres::Color grey(std::uint32_t level, std::uint32_t opacity = 255) {
  return level | level << 8 | level << 16 | opacity << 24;
}

/// An empty tank.
inline spheres::Tank tank_of(const glm::uvec3& size, float voxel = 0.01f) {
  return {size, voxel, {}, {}};
}
inline void put(spheres::Tank& tank, const glm::vec3& center, float radius, spheres::Color color) {
  tank.spheres.push_back({center, radius});
  tank.colors.push_back(color);
}

/// No light at all, one bounce.
inline scene::TankScene dark_scene() {
  scene::TankScene scene;
  scene.sky.zenith = scene.sky.horizon = scene.sky.ambient = glm::vec3(0);
  scene.bounces = 1;
  return scene;
}

/// Balls in random places until so many tries have failed; every third is a medium where `opacity` is below
/// 255.
inline void pack_at_random(spheres::Tank& tank, int tries, const glm::vec2& radius, std::uint32_t level,
                           std::uint32_t opacity, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0, 1);
  for (int i = 0; i < tries; ++i) {
    const float r = glm::mix(radius.x, radius.y, share(random) * share(random));
    const glm::vec3 u(share(random), share(random), share(random));
    const glm::vec3 center = r + (glm::vec3(tank.size) - 2 * r) * u;
    bool is_free = true;
    for (const spheres::Sphere& other : tank.spheres)
      is_free = is_free && glm::distance(other.center, center) > other.radius + r;
    if (is_free) put(tank, center, r, grey(level, i % 3 == 0 ? opacity : 255));
  }
}

/// A sampler of independent numbers for path i.
inline Sampler path_sampler(std::uint32_t i) {
  return Sampler({i & 1023, i >> 10 & 1023}, i >> 20);
}

/// A ray from a point of the world to another.
inline Ray ray_between(const glm::vec3& from, const glm::vec3& to) {
  return {from, glm::normalize(to - from)};
}

inline glm::vec3 all_of(const PathSample& sample) {
  return sample.seen + sample.single + sample.multiple;
}

}  // namespace brume::reference
