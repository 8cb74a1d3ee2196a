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
  float padding SHARED_ZERO;
  vec3 up;         // scaled by tan(half the vertical field of view), or half of its height [m]
  float padding_1 SHARED_ZERO;
  vec2 shift;
  vec2 padding_2 SHARED_ZERO;
};
SHARED_SIZE(Camera, 144);

/// Distant light: a gradient from horizon to zenith, and ambient light.
struct Sky {
  vec3 zenith;   // radiance
  float stars;   // radiance of the brightest star
  vec3 horizon;  // radiance
  float bounce;  // fraction of ambient that surfaces reflect to where no sky is visible, [0, 1]
  vec3 ambient;  // radiance, times sky_shape (shared/sky_light.h)
  float padding SHARED_ZERO;
};
SHARED_SIZE(Sky, 48);

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
  Phase phase;                 // phase function
  float multiple_scattering;   // weight of light scattered more than once; 0: single scattering only
  float hole_rim;              // amplitude of the noise on the rims of holes [m]
  vec2 padding SHARED_ZERO;
};
SHARED_SIZE(SmokeLook, 80);

/// The most boxes around the media of a frame.
SHARED_CONST uint kMaxMediaBoxes = 4u;
struct MediaBox {
  vec3 low;  // in the world [m]
  float padding SHARED_ZERO;
  vec3 high;
  float padding_1 SHARED_ZERO;
};
SHARED_SIZE(MediaBox, 32);

/// All media of a frame together.
struct FrameMedia {
  vec3 bounds_min;             // where any medium can be, in the world [m]
  float extinction;            // upper limit [1/m]
  vec3 bounds_max;
  float step_length;           // of the march, at most [m]
  float smooth_length;         // over less, densities change little [m]
  float opaque_transmittance;  // below it a ray is opaque
  float coarse_transmittance;  // below it, and again below a quarter of it, steps through smoke alone are twice as long
  uint volume_count;           // besides the smoke, in view
  vec3 to_sun;                 // unit
  uint caster_count;           // all that cast shadows, in view or not; those in view come first
  vec3 sun_irradiance;         // on the volumes; 0: no sun
  uint box_count;              // at least one, whose
  MediaBox box_0, box_1, box_2, box_3;  // union holds all that the bounds hold: smaller where media are far apart
};
SHARED_SIZE(FrameMedia, 208);

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
  uint light_count;
  vec3 caster_bounds_max;
  uint frame_index;  // moves the dither and the jitter
  SolidLayout solid;
  IndirectLayout indirect;
  HoleClusterLayout holes;
  uvec2 size_px;
  float time;        // [s]
  float pixel_width; // at a distance of 1 m, in the middle of the image; in a parallel view anywhere [m]
  float exposure;    // multiplies radiance before the tone curve
  uint tone;         // kToneNeutral or kToneStandard
  uint march_scale;  // edge of the tile of pixels that share a ray, 1, 2 or 4
  float texture_bias;   // of the mip level that surfaces are sampled at
  float resolve_error;  // largest error of an interpolated pixel, in display units [0, 1]
};
SHARED_SIZE(FrameConstants, 756);

SHARED_END
#endif
