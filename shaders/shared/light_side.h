// From which side the light in the smoke comes, for its finest shadows: those of noise within a voxel or two.
//
// A texel of the smoke knows the noise by one value alone, so billows have no side in shadow. Fine light (fine_light.h)
// therefore replaces the first kSideVoxels of the shadow ray of each point: exp(-depth) of what the ray met there,
// through texels, by the transmittance of the noise itself. Behind that the texel's own ray counts.
#ifndef BRUME_LIGHT_SIDE_H
#define BRUME_LIGHT_SIDE_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindLightSide, 94u);

/// The replaced path [voxels], and its samples. Of one sample smoke is 7 to 12 % too bright; three change nothing.
SHARED_CONST float kSideVoxels = 1.5f;
SHARED_CONST uint kSideSamples = 2u;
/// Below this fraction of light from one side it casts no fine shadows, and its direction counts as unknown.
SHARED_CONST float kLeastSide = 0.02f;
/// Optical depth of the smoke per density and sample.
SHARED_FUNCTION float side_depth(float extinction, float voxel_size) {
  return kSideVoxels / float(kSideSamples) * extinction * voxel_size;
}
/// Distance of a sample from the point that is lit [voxels].
SHARED_FUNCTION float side_sample(uint i) {
  return kSideVoxels * (float(i) + 0.5f) / float(kSideSamples);
}

SHARED_END
#endif
