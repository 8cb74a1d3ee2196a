// Light in volumes besides the smoke (docs/guides/volumes.md): a grid of light in each volume's bounds, from grids of
// optical depth along the sun's rays and along the axes of the world.
//
//   depths   cubes of optical depths in half floats, whose z axis runs along the light, in two images: one cube per
//            volume for the sun, six for the axes. Cube s of volume v begins at texel (s, 0, v) times its edge
//   light    per volume in view a cube of half floats in its bounds, likewise along z. rgb: radiance that the medium
//            scatters towards any eye, per extinction. a: fraction of the sun that the level lets through; in dense
//            volumes that arrives
//
// The march reads the sun's depths itself: they are finer than the light, since what is scattered once shows every
// fold. In dense volumes all light ends within a voxel of their surface, which depths between two cells do not show:
// they have a cell per voxel, with light that is found along rays of its own.
#ifndef BRUME_VOLUME_LIGHT_H
#define BRUME_VOLUME_LIGHT_H
#include "shared/volume.h"
SHARED_BEGIN

SHARED_BINDING(kBindSweeps, 48u);
SHARED_BINDING(kBindSunDepths, 49u);
SHARED_BINDING(kBindSkyDepths, 50u);
SHARED_BINDING(kBindDepths, 51u);
SHARED_BINDING(kBindVolumeLightTarget, 52u);

/// Directions in which light is swept through a volume: the sun, then +x, -x, +y, -y, +z, -z.
SHARED_CONST uint kSkySweeps = 6u;
SHARED_CONST uint kSweepsOfVolume = 7u;
/// Edge of a cube of sky depths: the light of the sky is blurred.
SHARED_CONST uint kSkyEdge = 32u;
SHARED_CONST uint kNoSun = 0xffffffffu;
/// Samples per cell of a sweep.
SHARED_CONST uint kSweepSamples = 2u;

/// Parallel rays through the bounds of a volume.
struct VolumeSweep {
  Affine sweep_from_world;  // to [0, 1]^3, z along the light
  Affine world_from_sweep;
  float length_m;  // of the sweep's z axis
  vec3 padding SHARED_ZERO;
};
SHARED_SIZE(VolumeSweep, 112);

struct VolumeLightParams {
  uint edge;           // of the cubes that are written
  uint first_sweep;    // of each volume
  uint sweeps;         // of each volume
  uint sun;            // number of the light in the frame's list, kNoSun: none
  uint is_alone;       // nothing else casts shadows into the volume
};
SHARED_SIZE(VolumeLightParams, 20);

SHARED_END
#endif
