// Shapes of fog by formula, in C++ and GLSL: the pyroclastic cloud, and a sphere, slab and torus to test with.
#ifndef BRUME_CLOUD_H
#define BRUME_CLOUD_H
#include "shared/hash.h"
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindCloudBricks, 32u);
SHARED_BINDING(kBindCloudValues, 33u);

SHARED_CONST uint kCloudPyroclastic = 0u;
SHARED_CONST uint kCloudSphere = 1u;
SHARED_CONST uint kCloudSlab = 2u;
SHARED_CONST uint kCloudTorus = 3u;

/// Limit of |lattice_noise|: eight corners with weights that sum to 1 contribute two components of their offset each,
/// and the mean distance to the corners is at most half a cell along each of the three axes.
SHARED_CONST float kLatticeNoiseLimit = 1.5f;

/// A shape centred at the origin, and how its density rises behind its surface.
struct CloudShape {
  uint kind;
  float radius;      // of the sphere before its displacement; largest distance of the other shapes along x and z [m]
  float per_edge;    // 1 / width of the soft edge [1/m]; 0: binary
  float amplitude;   // displacement where |fBm| is 1 [m]
  float frequency;   // lattice cells of the first octave [1/m]
  float gain;        // weight of an octave relative to the previous one
  float lacunarity;  // frequency of an octave relative to the previous one
  uint octaves;
  uint seed;
};
SHARED_SIZE(CloudShape, 36);

/// A cube of voxels around the origin, of which bricks are evaluated.
struct CloudParams {
  CloudShape shape;
  int edge;          // voxels
  float voxel_size;  // [m]
  uint brick_count;
};
SHARED_SIZE(CloudParams, 48);

/// Ramp along one of the 12 directions to the edges of a cube, chosen by four bits (Perlin 2002).
SHARED_FUNCTION float edge_ramp(uint hash, vec3 offset) {
  uint h = hash >> 28u;
  float u = h < 8u ? offset.x : offset.y;
  float v = h < 4u ? offset.y : (h == 12u || h == 14u ? offset.x : offset.z);
  return ((h & 1u) != 0u ? -u : u) + ((h & 2u) != 0u ? -v : v);
}

/// Gradient noise on the integer lattice with quintic weights (Perlin 2002, "Improving Noise"). A hash of the lattice
/// point replaces the permutation table, so that it does not repeat. Mean 0; 0 at lattice points, and so from 2^23
/// cells on, where floats are whole numbers.
SHARED_FUNCTION float lattice_noise(vec3 p, uint seed) {
  if (max(abs(p.x), max(abs(p.y), abs(p.z))) >= 8388608.0f) return 0.0f;
  vec3 cell = floor(p), f = p - cell;
  vec3 w = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
  uvec3 first = uvec3(ivec3(cell)) + seed * uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du);
  float sum = 0.0f;
  for (uint i = 0u; i < 8u; ++i) {
    uvec3 corner = uvec3(i & 1u, (i >> 1u) & 1u, i >> 2u);
    vec3 c = vec3(corner);
    vec3 weight = mix(vec3(1.0f) - w, w, c);
    sum += weight.x * weight.y * weight.z * edge_ramp(pcg3d(first + corner).x, f - c);
  }
  return sum;
}

/// Octaves of noise, octave i with weight gain^i at frequency lacunarity^i.
SHARED_FUNCTION float cloud_fbm(CloudShape shape, vec3 p) {
  vec3 at = p * shape.frequency;
  float sum = 0.0f, weight = 1.0f;
  for (uint i = 0u; i < shape.octaves; ++i) {
    sum += weight * lattice_noise(at, shape.seed + i);
    weight *= shape.gain;
    at = at * shape.lacunarity;
  }
  return sum;
}

/// How deep a point lies behind the surface [m]; below 0 outside.
///
/// Pyroclastic: a sphere displaced outwards by the absolute value of fBm, which folds the noise into billows with
/// creases between them (SIGGRAPH 2010 course "Volumetric Methods in Visual Effects"; J. Tessendorf and M. Kowalski,
/// "Resolution Independent Volumes"). The noise is that of the point itself, not of the sphere's surface below it, as
/// in the demo of P. Rideout, "Single-Pass Raycasting", 2011: billows overhang, and small ones may float.
SHARED_FUNCTION float cloud_depth(CloudShape shape, vec3 p) {
  if (shape.kind == kCloudSlab) {
    vec3 inside = shape.radius * vec3(1.0f, 0.25f, 1.0f) - abs(p);
    return min(inside.x, min(inside.y, inside.z));
  }
  if (shape.kind == kCloudTorus) {
    float from_circle = length(vec2(p.x, p.z)) - 0.75f * shape.radius;
    return 0.25f * shape.radius - length(vec2(from_circle, p.y));
  }
  float displacement = 0.0f;
  if (shape.kind == kCloudPyroclastic) displacement = shape.amplitude * abs(cloud_fbm(shape, p));
  return shape.radius + displacement - length(p);
}

/// Density at a point: 0 outside; inside it rises to 1 across the soft edge.
SHARED_FUNCTION float cloud_density(CloudShape shape, vec3 p) {
  float depth = cloud_depth(shape, p);
  if (depth <= 0.0f) return 0.0f;
  return shape.per_edge > 0.0f ? min(depth * shape.per_edge, 1.0f) : 1.0f;
}

/// Density of a voxel of the cube, by its index from 0 to edge - 1; 0 behind its end.
SHARED_FUNCTION float cloud_voxel(CloudParams params, ivec3 index) {
  if (max(index.x, max(index.y, index.z)) >= params.edge) return 0.0f;
  vec3 p = (vec3(index) - 0.5f * float(params.edge - 1)) * params.voxel_size;
  return cloud_density(params.shape, p);
}

SHARED_END
#endif
