// Marches a ray through the media of a frame (lib/media.glsl): equal steps with one jitter, span by span, until the ray
// is opaque.
#ifndef MARCH_GLSL
#define MARCH_GLSL
#include "lib/media.glsl"

/// Result of a ray so far.
struct Gathered {
  vec3 radiance;  // per unit of media_albedo
  float transmittance;
  uint texture_samples, steps;
};

/// Marches the part [begin, end) of a ray in equal steps no longer than the media's. Each sample is at `jitter` in its
/// step, [0, 1). What the samples of a span have in common is computed once per span; little is carried from step to
/// step, because registers limit how many rays run at a time.
void march(WorldRay ray, MediaRay media, float jitter, float begin, float end, inout Gathered gathered) {
  const float count = ceil((end - begin) / frame.media.step_length), ds = (end - begin) / max(count, 1.0);
  const float after_last = begin + (count - 0.5 + jitter) * ds;
  for (float t = begin + jitter * ds; t < after_last;) {
    const MediaSpan span = media_span(ray, media, t, ds);
    const float t_stop = min(span.t_stop, after_last);
    for (t = span.t_first; t < t_stop; t += ds) {
      const vec3 p_world = ray.origin + ray.direction * t;
      const MediaSample here = sample_media(media, span, p_world, t, gathered.texture_samples);
      ++gathered.steps;
      const float passed_log2 = log2_transmittance(here, ds);
      if (kHasHeat) gathered.radiance += gathered.transmittance * media_glow(here, passed_log2, ds);
      if (passed_log2 < 0.0) {
        // In-scatter is constant over the step, so its integral is exact: the energy does not depend on the step
        // length.
        const float passed = exp2(passed_log2);
        const vec3 light = media_inscatter(media, here, gathered.texture_samples);
        gathered.radiance += gathered.transmittance * (1.0 - passed) * light;
        gathered.transmittance *= passed;
        if (gathered.transmittance < frame.media.opaque_transmittance) {
          gathered.transmittance = 0.0;
          return;
        }
      }
    }
    t = span.t_next;
  }
}

#endif
