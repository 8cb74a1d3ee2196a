// Light that comes to the spheres of a tank through its glass: as LightPaths::gather (src/spheres/light_paths.hpp).
#ifndef PHOTON_GATHER_GLSL
#define PHOTON_GATHER_GLSL
#include "shared/photons.h"

layout(scalar, binding = kBindPhotons) readonly buffer Photons { Photon photons[]; };
layout(scalar, binding = kBindPhotonCells) readonly buffer PhotonCells { uint photon_cells[]; };

/// Irradiance at a point of an opaque sphere (`extinction` 0), or fluence at a point of a medium of so much extinction
/// per voxel's length. An event scatters albedo / pi of the first, albedo / (4 pi) of the second.
vec3 gather_photons(PhotonGrid grid, vec3 at, uint id, vec4 sphere, float extinction) {
  vec3 sum = vec3(0.0);
  if (grid.radius <= 0.0) return sum;
  const bool is_medium = extinction > 0.0;
  const vec3 normal = normalize(at - sphere.xyz);
  const ivec3 corner = photon_corner(grid, at);
  for (int i = 0; i < 8; ++i) {
    const ivec3 cell = corner + ivec3(i & 1, (i >> 1) & 1, i >> 2);
    const uint hash = photon_hash(grid, cell);
    const uint end = photon_cells[hash + 1u];
    for (uint k = photon_cells[hash]; k < end; ++k) {
      const Photon photon = photons[k];
      if (!photon_counts(grid, photon, cell, id, at)) continue;
      const float cosine = -dot(normal, unpacked_direction(photon.direction));
      sum += photon.flux * (is_medium ? 1.0 : photon_per_area(grid.radius, sphere.w, cosine));
    }
  }
  return is_medium ? sum * photon_per_volume(grid.radius, sphere.w, distance(at, sphere.xyz), extinction) : sum;
}

#endif
