// Volumes displayed by particles: quads across the view, each fragment of which samples the volume at its own place.
//
// The estimator. N quads of one footprint K(o) = (1 - |o|^2 / R^2)^2, |o| <= R, whose integral is A = pi R^2 / 3,
// stand across the view axis; their centres are uniform in a region of volume V. A ray that makes the angle theta with
// the view axis meets each at a point p, and weighs what the volume has there by the length K w / cos(theta),
// w = V / (N A). Integrated over the centres, that is the line integral of the volume along the ray, whatever N and R:
// - A quad adds no blur, since fragments sample at p: its size changes the variance only.
// - The region is the box grown by R on all sides. A quad whose centre is farther from the box has no part in it, so
//   that the density of quads is the same throughout the box, and quads that wrap around do so where they show nothing.
// - Centres that are independent of each other give the variance 9 V / (5 pi R^2 N) times the integral of the squared
//   value along the ray: it falls with the number of quads on the ray. The lattice is better than that.
// - With extinction, each quad is a homogeneous slab of its length. The transmittance of n slabs is exp(-sum), whose
//   mean exceeds that of the exact sum by half the variance of the sum, to first order: a bias that falls as the
//   variance does.
#ifndef BRUME_PARTICLES_H
#define BRUME_PARTICLES_H
#include "shared/hash.h"
#include "shared/slice_texture.h"
SHARED_BEGIN

SHARED_BINDING(kBindParticleSystems, 56u);
SHARED_BINDING(kBindParticles, 57u);
SHARED_BINDING(kBindParticleOrder, 58u);
SHARED_BINDING(kBindParticleLayer, 59u);

/// The most systems of a frame, and particles of a system.
SHARED_CONST uint kMaxParticleSystems = 32u;
SHARED_CONST uint kMaxParticles = 65536u;

/// A volume and its particles.
struct ParticleSystem {
  Affine world_from_uvw;  // the box is [0, 1]^3
  Affine uvw_from_world;
  Affine tints;       // a column per channel: radiance per metre where it is 1
  SliceTexture slices;
  float radius;       // R [m]
  float weight;       // w [m]
  vec3 margin;        // by how much the region of the centres exceeds the box on each side [uvw]
  float extinction;   // where the largest channel is 1 [1/m]; 0: emission only
  vec2 swirl;         // amplitude of the swirl, a fraction of the region
  float swirl_turns;  // phase of the swirl, in [0, 1)
  float softness;     // distance over which quads fade before a surface, and from the eye [m]; 0: none
  float drift;        // how far all have moved along the slices, a fraction of the region in [0, 1)
  uint seed;
  uint first;         // place of its first particle among those of all systems
  uint count;         // N
};
SHARED_SIZE(ParticleSystem, 240);

/// A particle of a frame.
struct Particle {
  PackedVec3 centre_world;
  float view_m;  // distance of its quad along the view axis [m]; behind the eye: not above 0
  uint system;
};
SHARED_SIZE(Particle, 20);

/// What the shaders that move and sort particles need to know.
struct ParticleList {
  uint system_count;
  uint count;         // of all particles
  uint padded_count;  // a power of two, at least count and kParticleBlock
  uint first_span;    // of a bitonic network: spans that are made sorted, from this
  uint last_span;     // to this,
  uint stride;        // and how far apart compared entries are at first
};
SHARED_SIZE(ParticleList, 24);

/// Entries that a workgroup sorts by itself.
SHARED_CONST uint kParticleBlock = 1024u;

/// Centre of a particle, in the space of the volume.
///
/// Particle i is at s + (i + 1) (1/g, 1/g^2, 1/g^3) mod 1 in the region, g the root of g^4 = g + 1: the R3 sequence
/// (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"), well spread for any count. s is uniform
/// over seeds. The drift moves all along the slices. The swirl moves each layer across them, in a circle whose phase
/// follows from the layer. A translation of layers keeps volumes, so that each particle stays uniform; all wrap around.
SHARED_FUNCTION vec3 particle_uvw(ParticleSystem system, uint i) {
  uvec3 turns = pcg3d(uvec3(system.seed, 1u, 2u)) + (i + 1u) * uvec3(0xd1b54a33u, 0xabc98389u, 0x8cb92ba7u);
  vec3 at = vec3(turns >> 8u) / 16777216.0f;
  at.z = fract(at.z + system.drift);
  float angle = 6.28318531f * (at.z - system.swirl_turns);
  at.x = fract(at.x + system.swirl.x * cos(angle));
  at.y = fract(at.y + system.swirl.y * sin(angle));
  return at * (vec3(1.0f) + 2.0f * system.margin) - system.margin;
}

/// K of a point at this distance from the centre.
SHARED_FUNCTION float particle_footprint(float distance_m, float radius) {
  float inside = max(1.0f - distance_m * distance_m / (radius * radius), 0.0f);
  return inside * inside;
}

/// What remains of a quad before a surface and close to the eye, by their distances along the view axis.
SHARED_FUNCTION float particle_fade(float view_m, float surface_m, float softness) {
  if (softness <= 0.0f) return view_m < surface_m ? 1.0f : 0.0f;
  return clamp((surface_m - view_m) / softness, 0.0f, 1.0f) * clamp(view_m / softness, 0.0f, 1.0f);
}

/// The mean transmittance inside of a slab of this optical depth, from its face: (1 - exp(-depth)) / depth.
SHARED_FUNCTION float slab_transmittance(float optical_depth) {
  if (optical_depth < 0.01f) return 1.0f - optical_depth * (0.5f - optical_depth / 6.0f);
  return (1.0f - exp(-optical_depth)) / optical_depth;
}

SHARED_END
#endif
