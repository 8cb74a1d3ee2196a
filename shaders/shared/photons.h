// Light that comes to the spheres of a tank through its glass: photons in cells of space, for C++ and GLSL.
//
// The photons of a cell lie one after the other; `photon_cells` has where those of each hash begin, and one more
// entry. A query at a point reads the cells within the radius around it, photon_corner + (0 or 1) along each axis:
//
//   for each cell: for each photon i of its hash: if the photon is in that cell and counts at the point, add its flux
//   irradiance = sum * photon_per_area(...), or fluence = sum * photon_per_volume(...) in a medium
//
// All lengths are in voxels of the tank.
#ifndef BRUME_PHOTONS_H
#define BRUME_PHOTONS_H
#include "shared/hash.h"
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindPhotons, 80u);
SHARED_BINDING(kBindPhotonCells, 81u);

/// Light that arrives at the surface of a sphere, or collides in its medium.
struct Photon {
  vec3 position;
  uint id;    // of the sphere
  vec3 flux;  // [W] times the squared voxels of a metre; over the squared index of refraction inside of the glass
};
SHARED_SIZE(Photon, 28);

/// What a query reads besides the buffers.
struct PhotonGrid {
  float radius;  // of the gathering, half the edge of a cell; 0: there are no photons
  uint mask;     // the number of hashes less one, which is a power of two
};
SHARED_SIZE(PhotonGrid, 8);

/// Most photons, so that their buffer has at most 128 MiB.
SHARED_CONST uint kMostPhotons = 4194304u;

SHARED_FUNCTION ivec3 photon_cell(PhotonGrid grid, vec3 at) {
  return ivec3(floor(at * (0.5f / grid.radius)));
}

/// The lowest of the eight cells within the radius around a point.
SHARED_FUNCTION ivec3 photon_corner(PhotonGrid grid, vec3 at) {
  return photon_cell(grid, at - vec3(grid.radius));
}

/// Index into photon_cells.
SHARED_FUNCTION uint photon_hash(PhotonGrid grid, ivec3 cell) {
  return pcg3d(uvec3(cell)).x & grid.mask;
}

/// Whether a photon that was found under the hash of `cell` counts at a point of a sphere: cells may have one hash.
SHARED_FUNCTION bool photon_counts(PhotonGrid grid, Photon photon, ivec3 cell, uint id, vec3 at) {
  vec3 apart = photon.position - at;
  return photon.id == id && dot(apart, apart) <= grid.radius * grid.radius &&
         photon_cell(grid, photon.position) == cell;
}

/// One over the area of the part of a sphere's surface within `radius` of a point of it, along the chord: a cap of
/// pi radius^2, whatever the sphere's radius (Archimedes), or all of the sphere.
SHARED_FUNCTION float photon_per_area(float radius, float sphere_radius) {
  float reach = min(radius, 2.0f * sphere_radius);
  return 1.0f / (3.14159265f * reach * reach);
}

/// The volume in which a ball of `radius` around a point overlaps a sphere whose middle is `apart` from it (Weisstein,
/// "Sphere-Sphere Intersection", MathWorld).
SHARED_FUNCTION float photon_volume(float radius, float sphere_radius, float apart) {
  const float kBall = 4.18879020f;
  float less = min(radius, sphere_radius);
  if (apart <= abs(sphere_radius - radius)) return kBall * less * less * less;
  float deep = max(0.0f, radius + sphere_radius - apart), difference = radius - sphere_radius;
  return 0.261799388f * deep * deep *
         (apart + 2.0f * (radius + sphere_radius) - 3.0f * difference * difference / apart);
}

/// The fluence [radiance times solid angle] of a sum of fluxes of collisions: their density is fluence * extinction.
SHARED_FUNCTION float photon_per_volume(float radius, float sphere_radius, float apart, float extinction) {
  return 1.0f / (photon_volume(radius, sphere_radius, apart) * extinction);
}

SHARED_END
#endif
