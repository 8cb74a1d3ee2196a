// Light that comes to spheres through the glass, from photons that were traced before.
#ifndef PHOTON_GATHER_GLSL
#define PHOTON_GATHER_GLSL
#include "lib/tank.glsl"

layout(scalar, binding = kBindPhotons) readonly buffer Photons { Photon photons[]; };
layout(scalar, binding = kBindPhotonCells) readonly buffer PhotonCells { uint photon_cells[]; };

/// Flux of the photons of a sphere within the grid's radius of a point.
vec3 gathered_flux(vec3 at, uint id) {
  const PhotonGrid grid = tank.photons;
  const ivec3 corner = photon_corner(grid, at);
  vec3 sum = vec3(0.0);
  for (uint k = 0u; k < 8u; ++k) {
    const ivec3 cell = corner + ivec3(k & 1u, (k >> 1u) & 1u, k >> 2u);
    const uint hash = photon_hash(grid, cell);
    for (uint i = photon_cells[hash]; i < photon_cells[hash + 1u]; ++i)
      if (photon_counts(grid, photons[i], cell, id, at)) sum += photons[i].flux;
  }
  return sum;
}

/// Irradiance at a point of an opaque sphere's surface.
vec3 photon_irradiance(vec3 at, uint id, float sphere_radius) {
  return gathered_flux(at, id) * photon_per_area(tank.photons.radius, sphere_radius);
}

/// Fluence at a point of a sphere of medium.
vec3 photon_fluence(vec3 at, uint id, vec4 sphere, float extinction) {
  return gathered_flux(at, id) *
         photon_per_volume(tank.photons.radius, sphere.w, distance(at, sphere.xyz), extinction);
}

#endif
