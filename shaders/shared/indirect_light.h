// Indirect light: what surfaces reflect and media scatter onto each other, on a grid of cells over the level. Cell
// (x, y, z) has the index x + size.x (y + size.y z).
//
//   patches   a SurfacePatch for each face between a free cell and a solid one
//   probes    indices of the free cells
//   hits      per ray of each probe what it meets (pack_hit): ray * probe_count + probe
//   emitter_samples    places on emitters that these rays would miss or meet by chance
//   emitter_rays       per probe kEmitterRays rays to such places: ray * probe_count + probe
//   patch_irradiance   per patch the irradiance / pi by the lights
//   patch_radiance     per patch the radiance that leaves it
//   cube      half floats, eight slabs of the grid's size along z: irradiance / pi of a surface that faces along
//             cube_forward(slab), and 1; then, in media, the means over the cell of what the formulas of scattering.h
//             find: scattered_sky, and the light of the lights that is scattered more than once. Solid cells beside
//             free ones have the mean of those times kSolidWeight, all others are 0
//   medium    half floats, a texel per cell: radiance that it scatters per metre, the same in all directions, and
//             extinction [1/m]
//   medium_direct       mean radiance of the lights alone, over all directions, and 1
//   medium_matter       scattering coefficient and extinction
// Extinction and scattering here are those of similar media that scatter evenly: of forward scattering, the part g, the
// mean cosine, counts as not scattered at all (van de Hulst 1980, "Multiple Light Scattering", similarity relations).
#ifndef BRUME_INDIRECT_LIGHT_H
#define BRUME_INDIRECT_LIGHT_H
#include "shared/frame.h"
SHARED_BEGIN

SHARED_BINDING(kBindIndirectCube, 82u);
SHARED_BINDING(kBindSurfacePatches, 83u);
SHARED_BINDING(kBindIndirectProbes, 84u);
SHARED_BINDING(kBindIndirectHits, 85u);
SHARED_BINDING(kBindPatchIrradiance, 86u);
SHARED_BINDING(kBindPatchRadiance, 87u);
SHARED_BINDING(kBindIndirectMedium, 88u);
SHARED_BINDING(kBindMediumDirect, 89u);
SHARED_BINDING(kBindMediumMatter, 90u);
SHARED_BINDING(kBindIndirectTarget, 91u);
SHARED_BINDING(kBindIndirectCubeTarget, 95u);
SHARED_BINDING(kBindEmitterSamples, 116u);
SHARED_BINDING(kBindEmitterRays, 117u);

/// A piece of surface that a free cell sees.
struct SurfacePatch {
  PackedVec3 position_world;
  PackedVec3 normal;    // unit, towards the cell
  PackedVec3 albedo;    // of diffuse reflection
  PackedVec3 emission;  // radiance; small emitters are left out
};
SHARED_SIZE(SurfacePatch, 48);

/// A place on a small emitter.
struct EmitterSample {
  PackedVec3 position_world;
  PackedVec3 normal;    // unit; it emits to both sides
  PackedVec3 radiance;
};
SHARED_SIZE(EmitterSample, 36);

/// A ray of a probe to a sample.
struct EmitterRay {
  uint emitter_sample;
  float weight;  // how many of the probe's rays its light counts for; 0: it does not arrive
};
SHARED_SIZE(EmitterRay, 8);

struct IndirectParams {
  ivec3 media_low;  // cells that may hold smoke
  uint patch_count;
  ivec3 media_high;
  uint probe_count;
  uint light_count;
  uint first_probe, end_probe;  // that gather in a dispatch
  float relaxation;  // how much of a bounce's change is applied; above 1 it is exaggerated
  float g;           // mean cosine of the phase function of media
};
SHARED_SIZE(IndirectParams, 52);

/// Slabs of the cube, those of light, and those of the formulas.
SHARED_CONST uint kIndirectSlabs = 8u;
SHARED_CONST uint kLightSlabs = 6u;
SHARED_CONST uint kSkySlab = 6u;
SHARED_CONST uint kFormulaSlab = 7u;
/// Alpha of solid cells beside free ones: they count only where there is nothing else, in corners.
SHARED_CONST float kSolidWeight = 0.015625f;

/// Rays of a probe. Neighbouring probes have different ones, kProbePhases sets of them.
SHARED_CONST uint kProbeRays = 64u;
SHARED_CONST uint kProbePhases = 8u;
SHARED_CONST uint kEmitterRays = 16u;
/// That which a ray of a probe stands for [sr].
SHARED_CONST float kRaySolidAngle = 12.566371f / 64.0f;

/// Ray i of a probe: of the points of a spherical Fibonacci lattice every eighth (Swinbank and Purser 2006).
SHARED_FUNCTION vec3 probe_direction(uint i, uint phase) {
  uint j = i * kProbePhases + phase;
  float height = 1.0f - (2.0f * float(j) + 1.0f) / float(kProbeRays * kProbePhases);
  float around = 2.39996323f * float(j), radius = sqrt(1.0f - height * height);
  return vec3(radius * cos(around), height, radius * sin(around));
}

/// Which of the sets of rays a probe has.
SHARED_FUNCTION uint probe_phase(ivec3 cell) {
  return uint((cell.x & 1) | (cell.y & 1) << 1 | (cell.z & 1) << 2);
}

/// The cell of an index.
SHARED_FUNCTION ivec3 cell_at(IndirectLayout layout_, uint index) {
  uint x = uint(layout_.size.x), y = uint(layout_.size.y);
  return ivec3(int(index % x), int(index / x % y), int(index / (x * y)));
}

/// What a ray meets: a patch, or kSkyPatch; and after how many cells, in steps of half a cell.
SHARED_CONST uint kSkyPatch = 0x3fffffu;
SHARED_CONST float kMostHitCells = 511.5f;
SHARED_FUNCTION uint pack_hit(uint patch_index, float cells) {
  return patch_index | uint(2.0f * min(cells, kMostHitCells) + 0.5f) << 22u;
}
SHARED_FUNCTION uint hit_patch(uint hit) {
  return hit & kSkyPatch;
}
SHARED_FUNCTION float hit_cells(uint hit) {
  return 0.5f * float(hit >> 22u);
}

SHARED_END
#endif
