// Constants of a frame for every pass: camera, sky, smoke look. One buffer, written once per frame.
#ifndef BRUME_FRAME_H
#define BRUME_FRAME_H
#include "shared/hole_clusters.h"
#include "shared/phase.h"
#include "shared/shim.h"
#include "shared/smoke_volume.h"
#include "shared/solid_volume.h"
#include "shared/tone.h"
SHARED_BEGIN

SHARED_BINDING(kBindFrame, 0u);

/// With s = (x + shift.x) right + (y + shift.y) up, x and y in [-1, 1], the ray of a pixel begins at eye_world +
/// parallel s and points along forward + (1 - parallel) s. The depth is near_z / distance along forward.
struct Camera {
  mat4 clip_from_world;  // infinite far plane; in a parallel view x, y and w alone
  vec3 eye_world;
  float near_z;    // [m]
  vec3 forward;    // unit
  float parallel;  // 1: a parallel view; 0: a pinhole
  vec3 right;      // scaled by tan(half the horizontal field of view), or half of the picture's width [m]
  vec3 up;         // scaled by tan(half the vertical field of view), or half of its height [m]
  vec2 shift;
};
SHARED_SIZE(Camera, 128);

/// Distant light: a gradient from horizon to zenith, and ambient light.
struct Sky {
  vec3 zenith;   // radiance
  vec3 horizon;  // radiance
  vec3 ambient;  // radiance, times sky_shape (shared/sky_light.h)
  float stars;   // radiance of the brightest star
  float bounce;  // fraction of ambient that surfaces reflect to where no sky is visible, [0, 1]
};
SHARED_SIZE(Sky, 44);

/// How the smoke looks.
struct SmokeLook {
  vec3 albedo;                 // single-scattering albedo, [0, 1]
  float extinction;            // at density 1 [1/m]
  float step_length;           // of a march through smoke alone, at most [m]
  float opaque_transmittance;  // below it a ray is opaque
  float erosion;               // strength of the noise, [0, 1]
  float noise_frequency;       // tiles of the noise per metre
  float detail;                // strength of the octaves below the tile (erosion.h), [0, 1]
  float rise;                  // upward speed of the noise [m/s]
  float swirl;                 // amplitude of the rolling displacement of the noise [m]
  float swirl_width;           // width of one roll [m], > 0
  float multiple_scattering;   // weight of light scattered more than once; 0: single scattering only
  float hole_rim;              // amplitude of the noise on the rims of holes [m]
  Phase phase;                 // phase function
};
SHARED_SIZE(SmokeLook, 72);

/// The most boxes around the media of a frame.
SHARED_CONST uint kMaxMediaBoxes = 4u;
struct MediaBox {
  vec3 low, high;  // in the world [m]
};
SHARED_SIZE(MediaBox, 24);

/// All media of a frame together.
struct FrameMedia {
  vec3 bounds_min;             // where any medium can be, in the world [m]
  vec3 bounds_max;
  float extinction;            // upper limit [1/m]
  float step_length;           // of the march, at most [m]
  float smooth_length;         // over less, densities change little [m]
  float opaque_transmittance;  // below it a ray is opaque
  float coarse_transmittance;  // below it, and again below a quarter of it, steps through smoke alone are twice as long
  uint volume_count;           // besides the smoke, in view
  uint caster_count;           // all that cast shadows, in view or not; those in view come first
  vec3 to_sun;                 // unit
  vec3 sun_irradiance;         // on the volumes; 0: no sun
  uint box_count;              // at least one, whose
  MediaBox box_0, box_1, box_2, box_3;  // union holds all that the bounds hold: smaller where media are far apart
};
SHARED_SIZE(FrameMedia, 176);

/// Placement of the cells of indirect light (indirect_light.h).
struct IndirectLayout {
  vec3 origin_world;  // low corner of cell (0, 0, 0) [m]
  float cell_size;    // [m]
  ivec3 size;         // cells
  uint bounces;       // 0: there is no indirect light
};
SHARED_SIZE(IndirectLayout, 32);

struct FrameConstants {
  Camera camera;
  Sky sky;
  SmokeLook look;
  VolumeLayout smoke;
  FrameMedia media;
  vec3 caster_bounds_min;  // bounds of the smoke that may dim light on its path to visible smoke [voxel space]
  vec3 caster_bounds_max;
  SolidLayout solid;
  uvec2 size_px;
  uint light_count;
  HoleClusterLayout holes;
  uint frame_index;  // moves the dither and the jitter
  float time;        // [s]
  float pixel_width; // at a distance of 1 m, in the middle of the image; in a parallel view anywhere [m]
  float exposure;    // multiplies radiance before the tone curve
  uint tone;         // kToneNeutral or kToneStandard
  uint march_scale;  // edge of the tile of pixels that share a ray, 1, 2 or 4
  float texture_bias;   // of the mip level that surfaces are sampled at
  float resolve_error;  // largest error of an interpolated pixel, in display units [0, 1]
  IndirectLayout indirect;
};
SHARED_SIZE(FrameConstants, 684);

SHARED_END
#endif
