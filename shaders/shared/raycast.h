// Raycasting of single volumes, in two forms: between interval surfaces, and from a ray/box intersection.
//
// Object space is the volume's voxel space; its box is that of the volume's bounds. View space has its origin in the
// eye, x to the right, y up, z backwards, in metres.
#ifndef BRUME_RAYCAST_H
#define BRUME_RAYCAST_H
#include "shared/phase.h"
#include "shared/volume.h"
SHARED_BEGIN

SHARED_BINDING(kBindRaycastView, 32u);
SHARED_BINDING(kBindRaycastVolumes, 33u);
SHARED_BINDING(kBindRayEntries, 34u);
SHARED_BINDING(kBindRayExits, 35u);
SHARED_BINDING(kBindRaycastTarget, 36u);

/// Vertices of the box of a volume: two triangles a face.
SHARED_CONST uint kBoxVertices = 36u;

/// What all volumes of a frame share.
struct RaycastView {
  vec3 sun_direction;          // towards the sun, unit [view space]
  float focal_length;          // 1 / tan(half the vertical field of view)
  vec3 sun_irradiance;         // on a surface that faces the sun
  float near_z;                // of the depth image [m]
  vec3 ambient;                // mean radiance from all directions
  float opaque_transmittance;  // below it a ray is opaque
  Phase phase;
  uvec2 size_px;
  vec2 shift;                  // Camera::shift
};
SHARED_SIZE(RaycastView, 80);

/// A volume of a frame. What the march reads of its density and look is its VolumeInstance.
struct RaycastVolume {
  mat4 clip_from_voxel;
  Affine voxel_from_view;   // [voxels/m]; the eye is its origin
  vec3 to_sun;              // [voxels/m]
  float step_length;        // of the march along view rays [m]
  vec3 bounds_min;          // the box [voxel space]
  float light_step_length;  // of the march towards the sun [m]
  vec3 bounds_max;
  float padding SHARED_ZERO;
};
SHARED_SIZE(RaycastVolume, 160);

/// A draw of a volume's box.
struct RaycastDraw {
  uint volume;
  uint reversed;  // 1: each triangle is wound the other way round
};
SHARED_SIZE(RaycastDraw, 8);

SHARED_END
#endif
