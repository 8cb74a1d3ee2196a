// Exact holes at the samples of a ray to a light: each hole is evaluated only between the samples where the ray enters
// and leaves it. Without noise on the rims, for which light is too coarse.
//
// The includer has a workgroup of kWindowThreads threads, kRayParts per ray, each with up to kPartSteps samples.
#ifndef HOLE_WINDOW_GLSL
#define HOLE_WINDOW_GLSL
#include "lib/frame.glsl"
#include "lib/hole_mask.glsl"
#include "lib/hole_reaches.glsl"
#include "lib/packed_holes.glsl"

/// The samples of a ray: sample k lies at t = begin + (k + 0.5) ds. A thread takes every kRayParts-th, from `part` on.
struct RaySteps {
  vec3 origin_world, direction;
  float begin, ds;
  uint count;  // at most kRayParts * kPartSteps
  uint part;
};

// Remaining fraction at each thread's samples, four numbers of 8 bits per word: shared memory is taken from the texture
// cache.
shared uint remaining_words[kPartSteps / 4u * kWindowThreads];

/// The samples of the ray that may lie in a hole: the first, and one past the last.
uvec2 samples_in(Hole hole, RaySteps ray) {
  const vec3 offset = ray.origin_world - hole.origin_world;
  const vec3 at = vec3(dot(offset, hole.right), dot(offset, hole.up), dot(offset, hole.forward));
  const vec3 direction = ray.direction;
  const vec3 step = vec3(dot(direction, hole.right), dot(direction, hole.up), dot(direction, hole.forward));
  const float radius = hole.radius;
  const vec3 safe = step + vec3(lessThan(abs(step), vec3(1e-9))) * 2e-9;
  const float z0 = -at.z / safe.z, z1 = (hole.distance_to_far - at.z) / safe.z;
  float enter = min(z0, z1), leave = max(z0, z1);
  if (hole.shape == kHoleCylinder) {
    const float a = max(dot(step.xy, step.xy), 1e-12), b = dot(at.xy, step.xy);
    const float c = dot(at.xy, at.xy) - radius * radius;
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
  const vec2 samples = (vec2(enter, leave) - ray.begin) / ray.ds - 0.5;
  return uvec2(clamp(vec2(ceil(samples.x - 1e-3), floor(samples.y + 1e-3) + 1.0), 0.0, float(ray.count)));
}

/// Fraction of the density that the holes leave at the thread's sample i.
float remaining_at(uint i) {
  return unpackUnorm4x8(remaining_words[(i >> 2u) * kWindowThreads + gl_LocalInvocationIndex])[i & 3u];
}

/// Resets the samples to 1.
void fill_window() {
  for (uint i = 0u; i < kPartSteps / 4u; ++i)
    remaining_words[i * kWindowThreads + gl_LocalInvocationIndex] = 0xffffffffu;
}

/// Whether the ray misses a hole because their lines are too far apart.
bool misses(HoleReach reach, RaySteps ray) {
  const vec3 across = cross(ray.direction, reach.forward);
  const float distance = max(abs(dot(ray.origin_world - reach.from_world, across)) - 1e-5, 0.0);
  const float least = 1.001 * reach.radius;
  return distance * distance > least * least * dot(across, across);
}

/// Cuts a hole out of the thread's samples.
void cut_hole(RaySteps ray, uint index) {
  const Hole hole = hole_at(index);
  const uvec2 run = samples_in(hole, ray);
  for (uint i = (run.x + kRayParts - 1u - ray.part) / kRayParts; kRayParts * i + ray.part < run.y; ++i) {
    const float t = ray.begin + (float(kRayParts * i + ray.part) + 0.5) * ray.ds;
    const vec3 p_world = ray.origin_world + t * ray.direction;
    const uint at = (i >> 2u) * kWindowThreads + gl_LocalInvocationIndex;
    vec4 four = unpackUnorm4x8(remaining_words[at]);
    four[i & 3u] *= 1.0 - hole_strength_masked(hole, p_world, frame.time, 0.0);
    remaining_words[at] = packUnorm4x8(four);
  }
}

#endif
