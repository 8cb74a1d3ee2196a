// Marches a ray through the media of a frame (lib/media.glsl): equal steps with one jitter, until the ray is opaque.
// The includer defines the constants kCount, what is recorded of a ray (shared/resolve.h), and kByBlocks: whether rays
// march block by block, through several volumes.
#ifndef MARCH_GLSL
#define MARCH_GLSL
#include "lib/media.glsl"
#include "shared/resolve.h"

/// Infinity: a ray that does not enter the media.
float no_entry() { return uintBitsToFloat(0x7f800000u); }

/// Result of a ray so far.
struct Gathered {
  vec3 radiance;  // per unit of media_albedo
  float transmittance;
  uint texture_samples, steps;
  float entry;  // distance at which the transmittance falls to kEntryTransmittance [m]; no_entry() so far
};

Gathered nothing_gathered() { return Gathered(vec3(0.0), 1.0, 0u, 0u, no_entry()); }

/// Notes the entry if it lies in the step [begin, begin + ds), in which the extinction is constant.
void note_entry(float begin, float ds, float passed_log2, inout Gathered gathered) {
  const float to_entry_log2 = log2(kEntryTransmittance / gathered.transmittance);
  if (to_entry_log2 <= 0.0 && to_entry_log2 > passed_log2) gathered.entry = begin + ds * to_entry_log2 / passed_log2;
}

/// Adds a step [t_begin, t_begin + ds) with the logarithm of its transmittance and the radiance of opaque media there;
/// true where nothing behind it is seen. In-scatter is constant over the step, so its integral is exact: the energy
/// does not depend on the step length.
bool add_step(float t_begin, float ds, float passed_log2, vec3 light, inout Gathered gathered) {
  if (kCount == kCountEntries) note_entry(t_begin, ds, passed_log2, gathered);
  const float passed = exp2(passed_log2);
  gathered.radiance += gathered.transmittance * (1.0 - passed) * light;
  gathered.transmittance *= passed;
  if (gathered.transmittance >= frame.media.opaque_transmittance) return false;
  gathered.transmittance = 0.0;
  return true;
}

/// A ray has nothing but a transmittance.
const bool kOnlyAbsorbs = kMediaAbsorb && kCount != kCountEntries;

/// Length of the steps behind a transmittance, relative to the first: what they add to the image, and what they may be
/// off by, counts that much less.
float step_factor(float transmittance) {
  if (!kLengthensSteps) return 1.0;
  const float coarse = frame.media.coarse_transmittance;
  return transmittance < 0.25 * coarse ? 4.0 : transmittance < coarse ? 2.0 : 1.0;
}

/// Equal steps along a ray, each with its sample at `jitter`.
struct Steps {
  float ds, after_last;  // between the last sample and one more
};

/// Divides [begin, end) into steps no longer than the media's, times `factor`.
Steps steps_between(float begin, float end, float jitter, float factor) {
  const float count = ceil((end - begin) / (factor * frame.media.step_length));
  const float ds = (end - begin) / max(count, 1.0);
  return Steps(ds, end + (jitter - 0.5) * ds);
}

/// Marches span by span. What the samples of a span have in common is computed once per span; little is carried from
/// step to step, because registers limit how many rays run at a time.
void march_spans(WorldRay ray, MediaRay media, float jitter, float begin, float end, inout Gathered gathered) {
  float factor = step_factor(gathered.transmittance);
  Steps steps = steps_between(begin, end, jitter, factor);
  for (float t = begin + jitter * steps.ds; t < steps.after_last;) {
    MediaSpan span = media_span(ray, media, t, steps.ds);
    float t_stop = min(span.t_stop, steps.after_last);
    bool lengthened = false;
    // Steps that are all alike are one.
    const float alike = is_constant(span) ? max(ceil((t_stop - span.t_first) / steps.ds), 1.0) : 1.0;
    float absorbed_log2 = 0.0;
    for (t = span.t_first; t < t_stop; t += alike * steps.ds) {
      const float dt = alike * steps.ds;
      const vec3 p_world = ray.origin + ray.direction * t;
      const MediaSample here = sample_media(media, span, p_world, t, gathered.transmittance, gathered.texture_samples);
      ++gathered.steps;
      const float passed_log2 = log2_transmittance(here, dt);
      if (kOnlyAbsorbs) {
        absorbed_log2 += passed_log2;
        continue;
      }
      if (kMediaGlow) gathered.radiance += gathered.transmittance * media_glow(here, passed_log2, dt);
      if (passed_log2 < 0.0) {
        const vec3 light = media_inscatter(span, here, gathered.texture_samples);
        if (add_step(t - jitter * steps.ds, dt, passed_log2, light, gathered)) return;
        // From the end of this step on they may be longer; more than rounding must remain.
        const float longer = step_factor(gathered.transmittance), rest = t + (1.0 - jitter) * steps.ds;
        if (longer > factor && end - rest > 0.01 * frame.media.step_length) {
          factor = longer;
          steps = steps_between(rest, end, jitter, factor);
          t = rest + (jitter - 1.0) * steps.ds;
          t_stop = min(span.t_stop, steps.after_last);
          lengthened = true;
        }
      }
    }
    if (kOnlyAbsorbs && add_step(span.t_first, alike * steps.ds, absorbed_log2, vec3(0.0), gathered)) return;
    if (!lengthened) t = span.t_next;
  }
}

/// Marches block by block through several volumes.
void march_blocks(WorldRay ray, MediaRay media, float jitter, float begin, float ds, float after_last,
                  inout Gathered gathered) {
  restart_blocks();
  for (float t = begin + jitter * ds; t < after_last;) {
    const float t_next = next_block(t);
    if (t_next > t + 0.5 * ds) {
      t = t_next;
      continue;
    }
    const uint count = steps_before(after_last + 0.5 * ds, t, ds, kBlockSteps);
    const MediaBlock block = sum_block(ray, media.smoke, t, ds, count, gathered.texture_samples);
    [[unroll]] for (uint step = 0u; step < kMostBlockSteps; ++step) {
      if (step >= kBlockSteps || step >= count) continue;
      const VolumesSample here = block.steps[step];
      ++gathered.steps;
      const float passed_log2 = -1.44269504 * ds * here.extinction;
      if (kMediaGlow) gathered.radiance += gathered.transmittance * media_glow(here, passed_log2, ds);
      if (passed_log2 < 0.0 && add_step(t + (float(step) - jitter) * ds, ds, passed_log2,
                                        here.light / here.extinction, gathered))
        return;
    }
    t += float(count) * ds;
  }
}

/// Marches the part [begin, end) of a ray. Each sample is at `jitter` in its step, [0, 1).
void march(WorldRay ray, MediaRay media, float jitter, float begin, float end, inout Gathered gathered) {
  if (kByBlocks) {
    const Steps steps = steps_between(begin, end, jitter, 1.0);
    march_blocks(ray, media, jitter, begin, steps.ds, steps.after_last, gathered);
  } else {
    march_spans(ray, media, jitter, begin, end, gathered);
  }
}

#endif
