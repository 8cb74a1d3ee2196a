// The media of a frame as rays from the eye meet them: their extinctions add up. The includer defines the constants
// kMedia, the set of those that are present, and kHoles.
//
// A medium is a lib/medium_*.glsl with
//
//   struct XRay, XRay x_ray(...)     what the samples of a ray have in common
//   struct XSpan, XSpan x_span(...)  what the samples before t_next have in common; those outside of [t_first, t_stop)
//                                    are empty
//   struct XSample, sample_x(...)    of a point: its extinction
//   x_inscatter(...)                 radiance towards the eye where the extinction is above 0
//   x_glow                           of a sample: radiance per metre, for a medium that glows without an extinction
//
// and a line in each function here, and in lib/media_block.glsl. As light meets it, it has
//
//   x_depth                          optical depth along a ray       a line in lib/media_light.glsl
//   x_extinction                     at a point                      a line in lib/media_extinction.glsl
//   x_in_cell                        mean of a cell                  a line in lib/media_cells.glsl
//
// and a constant in lib/media_set.glsl. Rays and boxes are in the world; a medium transforms them to its own voxels. No
// other shader asks which media there are. See CONTRIBUTING.md, "Add a medium".
#ifndef MEDIA_GLSL
#define MEDIA_GLSL
#include "lib/media_block.glsl"
#include "lib/media_set.glsl"
#include "lib/medium_smoke.glsl"
#include "lib/medium_volumes.glsl"

const bool kSmokeAlone = (kMedia & ~kMediaOfAnySmoke) == kMediumSmoke;
const bool kVolumesAlone = (kMedia & kMediaPresent) == kMediumVolumes;

/// They neither scatter nor glow.
const bool kMediaAbsorb = kVolumesAlone && !kIsLit && !kHasGlow;
/// One may glow without an extinction.
const bool kMediaGlow = kHasGlow;
/// Holes may be in one.
const bool kMayHaveHoles = (kMedia & kMediaWithHoles) != 0u;
/// Steps may be longer behind what lets little light through.
const bool kLengthensSteps = kSmokeAlone;

struct MediaRay {
  WorldRay world;
  SmokeRay smoke;
  VolumesRay volumes;
};

MediaRay media_ray(WorldRay world, vec2 position_px) {
  MediaRay ray;
  ray.world = world;
  if (kHasSmoke) ray.smoke = smoke_ray(world.direction, position_px);
  if (kHasVolumes && !kHasSeveral) ray.volumes = volumes_ray(world);
  return ray;
}

/// From one sample to another; samples outside of [t_first, t_stop) are empty.
struct MediaSpan {
  SmokeSpan smoke;
  VolumesSpan volumes;
  float t_first, t_stop, t_next;
};

void join_span(inout MediaSpan span, float t_first, float t_stop, float t_next) {
  span.t_first = min(span.t_first, t_first);
  span.t_stop = max(span.t_stop, t_stop);
  span.t_next = min(span.t_next, t_next);
}

MediaSpan media_span(WorldRay ray, MediaRay media, float t, float ds) {
  MediaSpan span;
  span.t_first = span.t_next = 1e30;
  span.t_stop = t;
  if (kHasSmoke) {
    span.smoke = smoke_span(ray, t, ds);
    join_span(span, span.smoke.bricks.t_first, span.smoke.bricks.t_stop, span.smoke.bricks.t_next);
  }
  if (kHasVolumes) {
    span.volumes = volumes_span(media.volumes, t, ds);
    join_span(span, span.volumes.t_first, span.volumes.t_stop, span.volumes.t_next);
  }
  if (!kSmokeAlone) span.t_stop = min(span.t_stop, span.t_next - 0.5 * ds);
  return span;
}

/// Whether all samples of a span are alike.
bool is_constant(MediaSpan span) { return kVolumesAlone && is_constant(span.volumes); }

struct MediaSample {
  SmokeSample smoke;
  VolumesSample volumes;
};

/// `transmittance`: from the eye to the sample.
MediaSample sample_media(MediaRay ray, MediaSpan span, vec3 p_world, float t, float transmittance,
                         inout uint texture_samples) {
  MediaSample here;
  if (kHasSmoke) {
    here.smoke.density = 0.0;
    if (kSmokeAlone || (t >= span.smoke.bricks.t_first && t < span.smoke.bricks.t_stop))
      here.smoke = sample_smoke(ray.smoke, span.smoke, p_world, t, transmittance, texture_samples);
  }
  if (kHasVolumes) {
    here.volumes = VolumesSample(0.0, vec3(0.0), vec3(0.0));
    if (kVolumesAlone || span.volumes.present)
      here.volumes = sample_volumes(span.volumes, ray.volumes, p_world, t, texture_samples);
  }
  return here;
}

/// Base-2 logarithm of the transmittance of a step; for smoke alone, one above 0 stands for 0.
float log2_transmittance(MediaSample here, float ds) {
  if (kSmokeAlone) return -1.44269504 * frame.look.extinction * ds * here.smoke.density;
  float sum = kHasSmoke ? frame.look.extinction * max(here.smoke.density, 0.0) : 0.0;
  if (kHasVolumes) sum += here.volumes.extinction;
  return -1.44269504 * ds * sum;
}

/// Radiance towards the eye, per unit of media_albedo, where the transmittance of a sample is below 1.
vec3 media_inscatter(MediaSpan span, MediaSample here, inout uint texture_samples) {
  if (kSmokeAlone) return smoke_inscatter(span.smoke, here.smoke, texture_samples);
  vec3 sum = vec3(0.0);
  float extinction = 0.0;
  if (kHasSmoke && here.smoke.density > 0.0) {
    const float smoke = frame.look.extinction * here.smoke.density;
    sum += smoke * frame.look.albedo * smoke_inscatter(span.smoke, here.smoke, texture_samples);
    extinction += smoke;
  }
  if (kHasVolumes) {
    sum += here.volumes.light;
    extinction += here.volumes.extinction;
  }
  return sum / extinction;
}

/// Radiance that leaves a step towards the eye from what glows, whether or not it has an extinction. It is constant
/// over the step and dimmed by what lies before it: (1 - exp(-x)) / x of its length, x the step's optical depth.
vec3 media_glow(VolumesSample here, float passed_log2, float ds) {
  const float x = -0.693147181 * passed_log2;
  return here.glow * (x > 1e-2 ? ds * (1.0 - exp(-x)) / x : ds * (1.0 - 0.5 * x));
}

vec3 media_glow(MediaSample here, float passed_log2, float ds) { return media_glow(here.volumes, passed_log2, ds); }

/// The factor that all in-scatter has in common.
vec3 media_albedo() { return kSmokeAlone ? frame.look.albedo : vec3(1.0); }

#endif
