// Light that comes to the spheres of a tank through its glass: photons in cells of space, for C++ and GLSL.
//
// The photons of a cell lie one after the other; `photon_cells` has where those of each hash begin, and one more
// entry. A query at a point of a sphere reads the cells within the radius around it:
//
//   for each cell photon_corner + (0 or 1) along each axis: for each photon of the cell's hash:
//     if photon_counts: sum += flux * photon_per_area(...), or photon_per_volume(...) in a medium
//
// The sum is the irradiance, or the fluence in a medium. All lengths are in voxels of the tank.
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
  uint direction;  // in which it arrives: packed_direction
};
SHARED_SIZE(Photon, 32);

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

/// The lower half of an octahedron to the corners around the upper one, and back.
SHARED_FUNCTION vec2 folded_octahedron(vec2 p) {
  return vec2((1.0f - abs(p.y)) * (p.x < 0.0f ? -1.0f : 1.0f), (1.0f - abs(p.x)) * (p.y < 0.0f ? -1.0f : 1.0f));
}

/// A unit vector in 16 bits for each of two coordinates on an octahedron (Cigolle et al. 2014, "A Survey of Efficient
/// Representations for Independent Unit Vectors").
SHARED_FUNCTION uint packed_direction(vec3 v) {
  vec2 p = vec2(v.x, v.y) / (abs(v.x) + abs(v.y) + abs(v.z));
  return packSnorm2x16(v.z < 0.0f ? folded_octahedron(p) : p);
}
SHARED_FUNCTION vec3 unpacked_direction(uint bits) {
  vec2 p = unpackSnorm2x16(bits);
  float z = 1.0f - abs(p.x) - abs(p.y);
  return normalize(vec3(z < 0.0f ? folded_octahedron(p) : p, z));
}

/// The integral of max(0, cosine of the angle to an axis) over a cap of the unit sphere, at most half of it, by the
/// squared sine of its half angle and the cosine between its middle and the axis (Lagarde and de Rousiers 2014, "Moving
/// Frostbite to PBR", listing 7, after Snyder 1996).
SHARED_FUNCTION float cosine_over_small_cap(float squared_sine, float cosine) {
  const float kPi = 3.14159265f;
  if (cosine * cosine >= squared_sine) return kPi * squared_sine * max(cosine, 0.0f);
  float sine = sqrt(1.0f - cosine * cosine), x = sqrt(1.0f / squared_sine - 1.0f);
  float y = clamp(-x * cosine / sine, -1.0f, 1.0f), height = sine * sqrt(1.0f - y * y);
  float lit = (cosine * acos(y) - x * height) * squared_sine;
  return max(0.0f, lit + (x > 0.0f ? atan(height / x) : 0.5f * kPi));
}

/// What a photon adds to the irradiance at a point of a sphere for its flux, if it counts there; `cosine`: between the
/// normal there and where the photon comes from. Those that count lie on the part of the sphere within `radius` of the
/// point, along the chord. Of parallel light, it takes in what its area across the light is; the cosine over that
/// area makes the mean of the estimate the irradiance of parallel light everywhere on the sphere, however large the
/// radius is.
SHARED_FUNCTION float photon_per_area(float radius, float sphere_radius, float cosine) {
  const float kPi = 3.14159265f;
  if (cosine <= 0.0f) return 0.0f;
  // The squared sine of a quarter of the part's angle.
  float q = min(1.0f, 0.25f * radius * radius / (sphere_radius * sphere_radius));
  float squared_sine = 4.0f * q * (1.0f - q), area = sphere_radius * sphere_radius;
  // So flat that all of it is lit.
  if (q < 1e-4f) return 1.0f / (area * kPi * squared_sine);
  // More than half of a sphere: all of it but the rest. All of it is pi.
  float across = q <= 0.5f ? cosine_over_small_cap(squared_sine, cosine) : kPi;
  if (q > 0.5f && squared_sine > 0.0f) across -= cosine_over_small_cap(squared_sine, -cosine);
  return cosine / (area * across);
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

/// What a photon adds to the fluence [radiance times solid angle] at a point of a medium for its flux: collisions have
/// the density fluence * extinction.
SHARED_FUNCTION float photon_per_volume(float radius, float sphere_radius, float apart, float extinction) {
  return 1.0f / (photon_volume(radius, sphere_radius, apart) * extinction);
}

SHARED_END
#endif
