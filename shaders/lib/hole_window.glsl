// What holes leave of the smoke at the next samples of a ray: exactly, sample by sample, but a hole is asked only from where
// the ray enters it to where the ray leaves it.
//
// Light is too coarse for the noise of rims. The includer has `frame`, a workgroup of 64 threads, `vec4 hole_rows[]` and
// `sampler2D hole_masks`.
#ifndef HOLE_WINDOW_GLSL
#define HOLE_WINDOW_GLSL
#include "shared/frame.h"
#include "lib/hole_mask.glsl"
#include "lib/hole_rows.glsl"
#include "lib/ray_samples.glsl"

const uint kAhead = 48u;
// What is left at the samples ahead of each thread: four numbers of 8 bits a word. Little memory, for it is taken from
// the textures' cache.
shared uint left_ahead[kAhead / 4u * 64u];

/// Where along the ray a hole can take anything away, as numbers of samples: the first, and one past the last.
uvec2 samples_in(Hole hole, RaySamples ray, float begin) {
  const vec3 apart = ray.origin_world - hole.origin_world;
  const vec3 at = vec3(dot(apart, hole.right), dot(apart, hole.up), dot(apart, hole.forward));
  const vec3 step = vec3(dot(ray.direction, hole.right), dot(ray.direction, hole.up), dot(ray.direction, hole.forward));
  const float radius = hole.radius;
  const vec3 safe = step + vec3(lessThan(abs(step), vec3(1e-9))) * 2e-9;
  const float z0 = -at.z / safe.z, z1 = (hole.distance_to_far - at.z) / safe.z;
  float enter = min(z0, z1), leave = max(z0, z1);
  if (hole.shape == kHoleCylinder) {
    const float a = max(dot(step.xy, step.xy), 1e-12), b = dot(at.xy, step.xy), c = dot(at.xy, at.xy) - radius * radius;
    const float discriminant = b * b - a * c;
    if (discriminant <= 0.0) return uvec2(0u);
    const float root = sqrt(discriminant);
    enter = max(enter, (-b - root) / a);
    leave = min(leave, (-b + root) / a);
  } else {
    const vec2 x0 = (-radius - at.xy) / safe.xy, x1 = (radius - at.xy) / safe.xy;
    const vec2 low = min(x0, x1), high = max(x0, x1);
    enter = max(enter, max(low.x, low.y));
    leave = min(leave, min(high.x, high.y));
  }
  if (enter >= leave) return uvec2(0u);
  const float to_first = begin + ray.jitter * ray.ds;
  const float first = clamp(ceil((enter - to_first) / ray.ds - 1e-3), 0.0, float(kAhead));
  float last = clamp(floor((leave - to_first) / ray.ds + 1e-3) + 1.0, 0.0, float(kAhead));
  // The last segment of the ray is cut, and its sample lies nearer.
  const float cut = floor((ray.end - begin) / ray.ds);
  if (first <= cut && last == cut && leave + 1e-3 * ray.ds >= mix(begin + cut * ray.ds, ray.end, ray.jitter)) last += 1.0;
  return uvec2(uint(first), uint(min(last, float(kAhead))));
}

/// Share of the density that the holes leave at sample k, counted from where the ray looked ahead.
float left_at(uint k) { return unpackUnorm4x8(left_ahead[(k >> 2u) * 64u + gl_LocalInvocationIndex])[k & 3u]; }

/// Before the first hole.
void begin_ahead() {
  for (uint i = 0u; i < kAhead / 4u; ++i) left_ahead[i * 64u + gl_LocalInvocationIndex] = 0xffffffffu;
}

/// Takes a hole out of the ray's next kAhead samples.
void look_ahead(RaySamples ray, float begin, Hole hole) {
  const uvec2 run = samples_in(hole, ray, begin);
  for (uint k = run.x; k < run.y; ++k) {
    const float t = begin + float(k) * ray.ds;
    const vec3 p_world = ray.origin_world + (t + ray.jitter * min(ray.ds, ray.end - t)) * ray.direction;
    const uint at = (k >> 2u) * 64u + gl_LocalInvocationIndex;
    vec4 four = unpackUnorm4x8(left_ahead[at]);
    four[k & 3u] *= 1.0 - hole_strength_masked(hole, p_world, frame.time, 0.0);
    left_ahead[at] = packUnorm4x8(four);
  }
}

#endif
