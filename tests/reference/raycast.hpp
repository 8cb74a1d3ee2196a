// A raycast of one volume in double precision, every step sampled, with a bound of what floats may make of
// it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

#include "shared/phase.h"
#include "shared/volume.h"
#include "volume/sparse_volume.hpp"

namespace brume::reference {

struct RaycastScene {
  const volume::SparseVolume& volume;  // densities in half floats
  glm::dmat4 voxel_from_world;
  shared::VolumeLook look;
  glm::dvec3 to_sun;  // unit
  glm::dvec3 sun_irradiance, ambient;
  shared::Phase phase;
  double step, light_step;  // [m]
  double opaque_transmittance;
};

struct RaycastResult {
  glm::dvec3 radiance{0};
  double transmittance = 1;
  glm::dvec3 radiance_error{0};
  double transmittance_error = 0;
};

/// Density at a point, and how far a device may be from it.
struct DensityHere {
  double value = 0, error = 0;
};

/// Devices filter with weights of 8 fractional bits per axis; `rounding` is that of the position [voxels].
inline DensityHere density_at(const volume::SparseVolume& volume, glm::dvec3 p_voxel, double rounding) {
  const glm::dvec3 brick = glm::floor(p_voxel / 8.0);
  if (const auto texel = volume.uniform_at(glm::ivec3(brick)))
    return {double{glm::unpackHalf1x16(*texel)}, 1e-6 * double{glm::unpackHalf1x16(*texel)}};
  const std::uint32_t slot = volume.slot_at(glm::ivec3(brick));
  if (slot == volume::SparseVolume::kNoSlot) return {};
  const auto texels = volume.texels<std::uint16_t>(volume::ChannelId{0}, slot);
  const glm::dvec3 at = p_voxel - 8.0 * brick + 0.5;  // texel centres are at whole numbers
  const glm::ivec3 first = glm::min(glm::ivec3(glm::floor(at)), glm::ivec3(8));
  double value = 0, low = 1e30, high = -1e30;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2), texel = first + corner;
    const auto density = double{
        glm::unpackHalf1x16(texels[static_cast<std::size_t>(texel.x + 10 * (texel.y + 10 * texel.z))])};
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double f = at[axis] - first[axis];
      weight *= corner[axis] ? f : 1 - f;
    }
    value += weight * density;
    low = std::min(low, density);
    high = std::max(high, density);
  }
  return {value, 3 * (1.0 / 256 + rounding) * (high - low) + 1e-6 * high};
}

/// Where a ray is inside the volume's bounds: x >= y where it is not.
inline glm::dvec2 chord(const RaycastScene& scene, glm::dvec3 origin_voxel, glm::dvec3 per_metre) {
  double enter = 0, leave = 1e30;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (double{scene.volume.layout().bounds_min[axis]} - origin_voxel[axis]) / per_metre[axis];
    const double b = (double{scene.volume.layout().bounds_max[axis]} - origin_voxel[axis]) / per_metre[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return {enter, leave};
}

/// Integral of density from a point to the sun.
inline DensityHere density_towards_sun(const RaycastScene& scene, glm::dvec3 p_voxel, double rounding) {
  const glm::dvec3 per_metre(scene.voxel_from_world * glm::dvec4(scene.to_sun, 0));
  const double end = chord(scene, p_voxel, per_metre).y;
  DensityHere sum;
  for (double begin = 0; begin < end; begin += scene.light_step) {
    const double length = std::min(scene.light_step, end - begin);
    const DensityHere here = density_at(scene.volume, p_voxel + (begin + 0.5 * length) * per_metre, rounding);
    sum.value += length * here.value;
    sum.error += length * here.error;
  }
  return sum;
}

/// The ray from the eye along a unit direction, up to the surface at t_scene. The errors of each step's
/// density are carried through products and sums to first order; `rounding` is that of positions [voxels].
inline RaycastResult raycast(const RaycastScene& scene, glm::dvec3 eye_world, glm::dvec3 direction,
                             double t_scene, double rounding) {
  const glm::dvec3 origin(scene.voxel_from_world * glm::dvec4(eye_world, 1));
  const glm::dvec3 per_metre(scene.voxel_from_world * glm::dvec4(direction, 0));
  glm::dvec2 inside = chord(scene, origin, per_metre);
  inside.y = std::min(inside.y, t_scene);
  const auto sigma = double{scene.look.extinction};
  const glm::dvec3 albedo(scene.look.albedo), emission(scene.look.emission);
  const glm::dvec3 sun =
      scene.sun_irradiance *
      double{shared::phase_value(scene.phase, static_cast<float>(glm::dot(direction, scene.to_sun)))};
  RaycastResult result;
  for (double n = std::floor(inside.x / scene.step); n * scene.step < inside.y; ++n) {
    const double begin = std::max(n * scene.step, inside.x), end = std::min((n + 1) * scene.step, inside.y);
    if (begin >= end) continue;
    const glm::dvec3 p = origin + 0.5 * (begin + end) * per_metre;
    const DensityHere here = density_at(scene.volume, p, rounding);
    if (here.value + here.error <= 0) continue;
    const DensityHere above = density_towards_sun(scene, p, rounding);
    const double passed = std::exp(-sigma * here.value * (end - begin)), lit = std::exp(-sigma * above.value);
    const double off = sigma * here.error * (end - begin);
    const glm::dvec3 source = albedo * (scene.ambient + lit * sun) + emission;
    const glm::dvec3 source_error = albedo * sun * (lit * std::expm1(sigma * above.error));
    double& t = result.transmittance;
    double& t_error = result.transmittance_error;
    result.radiance += t * (1 - passed) * source;
    result.radiance_error +=
        source * (t_error * (1 - passed) + t * passed * off) + source_error * (t + t_error) * (1 - passed);
    t_error = t_error * passed + t * passed * off;
    t *= passed;
    if (t < scene.opaque_transmittance) break;
  }
  // A ray may end as opaque here and not there.
  if (result.transmittance - result.transmittance_error < scene.opaque_transmittance) {
    result.transmittance_error += result.transmittance;
    result.radiance_error += 2 * scene.opaque_transmittance * (albedo * (scene.ambient + sun) + emission);
  }
  return result;
}

}  // namespace brume::reference
