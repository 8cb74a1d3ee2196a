// What every pass of a frame may know: camera, sky, smoke look. One buffer, written once a frame.
#ifndef BRUME_FRAME_H
#define BRUME_FRAME_H
#include "shared/hole_clusters.h"
#include "shared/phase.h"
#include "shared/shim.h"
#include "shared/smoke_volume.h"
#include "shared/solid_volume.h"
SHARED_BEGIN

/// A pinhole camera. A pixel's ray runs along forward + x right + y up, x and y in -1..1.
struct Camera {
  mat4 clip_from_world;  // reverse depth, infinite far plane: depth = near / distance along forward
  vec3 eye_world;
  float near_z;  // [m]
  vec3 forward;  // unit
  vec3 right;    // scaled by tan(half the horizontal field of view)
  vec3 up;       // scaled by tan(half the vertical field of view)
};
SHARED_SIZE(Camera, 116);

/// Light from far away: a gradient from horizon to zenith, and what surfaces get where no light shines.
struct Sky {
  vec3 zenith;   // radiance
  vec3 horizon;  // radiance
  vec3 ambient;  // irradiance / pi, from everywhere
  float stars;   // radiance of the brightest star
  float bounce;  // share of ambient that comes, from surface to surface, to where no sky is seen, [0, 1]
};
SHARED_SIZE(Sky, 44);

/// How the smoke looks.
struct SmokeLook {
  vec3 albedo;             // single-scattering albedo, [0, 1]
  float extinction;        // at density 1 [1/m]
  float step_length;       // of the march [m]
  float opaque_transmittance;              // transmittance at which a ray is opaque
  float erosion;           // how much noise eats from the rim inwards, [0, 1]
  float noise_period;      // edge of one tile of the noise [m]
  float rise;       // upward [m/s]
  float swirl;             // how far the noise rolls around its place [m]
  float swirl_width;        // of one roll [m], > 0
  float multiple_scattering;  // share of the light scattered more than once, 1: all of it, 0: single scattering
  float hole_rim;          // how far noise moves the rim of a hole [m]
  Phase phase;             // where scattered light goes
};
SHARED_SIZE(SmokeLook, 68);

struct FrameConstants {
  Camera camera;
  Sky sky;
  SmokeLook look;
  VolumeLayout volume;
  vec3 caster_bounds_min;  // where the smoke may be that dims light on its way to what is in view [voxel space]
  vec3 caster_bounds_max;
  SolidLayout solid;
  uvec2 size_px;
  uint light_count;
  HoleClusterLayout holes;
  uint frame_index;  // moves the dither and the jitter
  float time;        // [s]
  float exposure;    // multiplies radiance before the tone curve
  uint march_scale;  // edge of the block of pixels that share a ray, 1, 2 or 4
  float resolve_error;  // of a pixel, between 0 and 1 on the screen: more is not left to interpolation
};
SHARED_SIZE(FrameConstants, 404);

SHARED_END
#endif
