// Light in the smoke, finer than its texels: in-scatter times the shadows of noise within a voxel (light_side.h).
//
// What the eye sees of smoke is lit by what is within a voxel or two of it, and the noise is finer than that. Once a
// frame, the bricks near the eye get a page each of kFinePageTexels^3 texels. They cost the same at any resolution of
// the image, and the march then takes one fetch of light per sample.
//
//   fine_light   half floats, RGB: radiance scattered towards the eye, per unit of albedo, times A; A: 1, or 0 where
//                the in-scatter around the texel is unknown, far from smoke
//   fine_pages   per slot the page of its brick + 1, or 0: none
//   fine_slots   per page its slot
#ifndef BRUME_FINE_LIGHT_H
#define BRUME_FINE_LIGHT_H
#include "shared/smoke_volume.h"
SHARED_BEGIN

SHARED_BINDING(kBindFineLight, 103u);
SHARED_BINDING(kBindFinePages, 104u);
SHARED_BINDING(kBindFineSlots, 105u);

/// Texels per voxel along an axis, and of a page: the voxels of a brick, and one texel around them.
SHARED_CONST int kFineTexels = 4;
SHARED_CONST int kFinePageTexels = 34;
SHARED_CONST uint kFineTexelsPerPage = 39304u;
/// Pages lie in the image in rows of as many, one row above the other.
SHARED_CONST uint kFinePagesAcross = 8u;

/// First texel of a page in the image.
SHARED_FUNCTION ivec3 fine_page_corner(uint page) {
  return kFinePageTexels * ivec3(int(page % kFinePagesAcross), int(page / kFinePagesAcross), 0);
}
/// Centre of a texel of a page [voxels from the low corner of the brick].
SHARED_FUNCTION vec3 fine_texel_position(ivec3 texel) { return (vec3(texel) - 0.5f) / float(kFineTexels); }
/// Where in its page a point of the brick is [texels]. Beyond the centres of the outer texels, as on them.
SHARED_FUNCTION vec3 fine_page_position(vec3 local_voxel) {
  return clamp(float(kFineTexels) * local_voxel + 1.0f, vec3(0.5f), vec3(float(kFinePageTexels) - 0.5f));
}

SHARED_END
#endif
