// Worlds with smoke, and the lights and holes that tests put into them.
#pragma once

#include <initializer_list>
#include <limits>
#include <vector>

#include "shared/hole.h"
#include "shared/light.h"
#include "sim/world.hpp"
#include "smoke/smoke_volume.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/voxelize.hpp"

namespace brume {

/// Smoke that detonates where it is thrown. Times are the usual ones.
inline sim::ThrowSmoke smoke_at(const glm::dvec3& p_world, std::uint32_t voxels, std::uint32_t tick = 0) {
  const sim::Position at = sim::position_from_metres(p_world);
  return {tick, at, at, {.voxels = voxels}};
}
/// As smoke_at, and no test waits until it dissolves.
inline sim::ThrowSmoke lasting_smoke_at(const glm::dvec3& p_world, std::uint32_t voxels,
                                        std::uint32_t tick = 0) {
  sim::ThrowSmoke thrown = smoke_at(p_world, voxels, tick);
  thrown.smoke.hold_ticks = 10000;
  return thrown;
}

/// A level, the simulation in it, and the volume of its smoke. At a fixed address: they refer to each other.
struct SmokeWorld {
  explicit SmokeWorld(const voxel::BitGrid& level, const std::vector<voxel::Triangle>& triangles = {})
      : grid(level),
        planes(voxel::SurfacePlanes::build(triangles, grid)),
        world(grid),
        volume(grid, planes) {}
  /// The level of these triangles.
  SmokeWorld(const std::vector<voxel::Triangle>& triangles, const voxel::GridLayout& layout)
      : SmokeWorld(voxel::voxelize(triangles, layout).value_or_throw(), triangles) {}
  SmokeWorld(const SmokeWorld&) = delete;
  SmokeWorld& operator=(const SmokeWorld&) = delete;

  void append(const sim::Event& event) { world.append(event).value_or_throw(); }
  void advance_to(std::uint32_t tick) {
    world.advance_to(tick);
    volume.update(world);
  }

  const voxel::BitGrid grid;
  const voxel::SurfacePlanes planes;
  sim::World world;
  smoke::SmokeVolume volume;
};

/// A yard of 40 x 8 x 16 m without walls, with a smoke at the height of 1 m at each x, which stays.
struct Yard : SmokeWorld {
  static constexpr float kVoxel = 0.5f;
  explicit Yard(std::initializer_list<double> smokes_x, std::uint32_t voxels = 400, std::uint32_t tick = 300)
      : SmokeWorld(voxel::BitGrid({{80, 16, 32}, kVoxel, glm::vec3(0)})) {
    for (const double x : smokes_x) append(lasting_smoke_at({x, 1, 8}, voxels));
    advance_to(tick);
  }
};

/// `layer`: Light::shadow_layer.
inline shared::Light point_light(const glm::vec3& p_world, const glm::vec3& intensity,
                                 std::uint32_t layer = shared::kNoShadow) {
  shared::Light light{};
  light.position_world = p_world;
  light.intensity = intensity;
  light.range = shared::light_range(std::max({intensity.r, intensity.g, intensity.b}));
  light.kind = shared::kLightPoint;
  light.direction = {0, 0, -1};
  light.shadow_layer = layer;
  return light;
}
inline shared::Light sun_light(const glm::vec3& direction, float irradiance,
                               std::uint32_t layer = shared::kNoShadow) {
  shared::Light light = point_light({}, glm::vec3(irradiance), layer);
  light.kind = shared::kLightDirectional;
  light.direction = glm::normalize(direction);
  return light;
}

/// A cylinder that opens at once and stays open for 100 s. `forward`: along z.
inline shared::Hole open_hole(const glm::vec3& from_world, const glm::vec3& forward, float radius,
                              float length, float time_start = 0) {
  shared::Hole hole{};
  hole.origin_world = from_world;
  hole.forward = forward;
  hole.right = {1, 0, 0};
  hole.up = {0, 1, 0};
  hole.radius = radius;
  hole.distance_to_far = length;
  hole.time_start = time_start;
  hole.time_to_stay_open = 100;
  return hole;
}

}  // namespace brume
