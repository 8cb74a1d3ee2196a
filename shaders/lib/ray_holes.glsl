// What holes leave of the smoke at the samples of a ray from the eye: exactly, sample by sample, but a ray asks only the
// holes of its group of pixels, and only from where it enters them to where it leaves them.
//
// The includer has `frame`, `noise_tile`, a workgroup of 64 threads and the constant kHoles, and defines BINDING_HOLES,
// BINDING_HOLE_LISTS and BINDING_HOLE_MASKS.
#ifndef RAY_HOLES_GLSL
#define RAY_HOLES_GLSL
#include "shared/frame.h"

layout(binding = BINDING_HOLES) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = BINDING_HOLE_LISTS) readonly buffer HoleLists { uint hole_lists[]; };
layout(binding = BINDING_HOLE_MASKS) uniform sampler2D hole_masks;
#include "lib/hole_mask.glsl"
#include "lib/hole_rows.glsl"

const uint kAhead = 32u;
// What is left at the samples ahead of each thread: four numbers of 8 bits a word. Little memory, for it is taken from
// the textures' cache; none for frames without holes.
shared uint left_ahead[kHoles == kHolesListed ? kAhead / 4u * 64u : 1u];

/// The samples of a ray: number k lies at t = begin + k ds + jitter * (its segment, ds or what is left of it up to end).
struct RaySamples {
  vec3 origin_world, direction;
  float begin, end, ds, jitter;
};

float sample_t(RaySamples ray, uint k) {
  const float t = ray.begin + float(k) * ray.ds;
  return t + ray.jitter * min(ray.ds, ray.end - t);
}

/// Where along the ray a hole can take anything away, as numbers of samples: the first, and one past the last.
uvec2 samples_in(Hole hole, RaySamples ray, float begin, float rim) {
  const vec3 apart = ray.origin_world - hole.origin_world;
  const vec3 at = vec3(dot(apart, hole.right), dot(apart, hole.up), dot(apart, hole.forward));
  const vec3 step = vec3(dot(ray.direction, hole.right), dot(ray.direction, hole.up), dot(ray.direction, hole.forward));
  const float radius = hole.radius + hole_rim(hole, rim);
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

float left_by_hole(Hole hole, vec3 p_world) {
  const float noise = 2.0 * smoke_noise(noise_tile, frame.look, p_world, frame.time).g - 1.0;
  return 1.0 - hole_strength_masked(hole, p_world, frame.time, noise * hole_rim(hole, frame.look.hole_rim));
}

/// Share of the density that the holes leave at sample k, counted from where the ray looked ahead.
float left_at(uint k) { return unpackUnorm4x8(left_ahead[(k >> 2u) * 64u + gl_LocalInvocationIndex])[k & 3u]; }

/// Takes a hole out of the ray's next kAhead samples.
void look_ahead(RaySamples ray, float begin, Hole hole) {
  const uvec2 run = samples_in(hole, ray, begin, frame.look.hole_rim);
  for (uint k = run.x; k < run.y; ++k) {
    const float t = begin + float(k) * ray.ds;
    const vec3 p_world = ray.origin_world + (t + ray.jitter * min(ray.ds, ray.end - t)) * ray.direction;
    const uint at = (k >> 2u) * 64u + gl_LocalInvocationIndex;
    vec4 four = unpackUnorm4x8(left_ahead[at]);
    four[k & 3u] *= left_by_hole(hole, p_world);
    left_ahead[at] = packUnorm4x8(four);
  }
}

/// Finds what holes leave at the next kAhead samples, from `begin` on, of a ray through a point of the picture; false
/// when that is all.
bool look_ahead(RaySamples ray, float begin, vec2 position_px) {
  const uvec2 group = uvec2(position_px) / kHoleGroupPixels;
  const uint list = 2u * (group.x + frame.holes.groups_across * group.y);
  const uint first = hole_lists[list], count = hole_lists[list + 1u];
  if (count == 0u) return false;
  for (uint i = 0u; i < kAhead / 4u; ++i) left_ahead[i * 64u + gl_LocalInvocationIndex] = 0xffffffffu;
  for (uint i = 0u; i < min(count, frame.holes.count); ++i) {
    look_ahead(ray, begin, hole_from_rows(count == kAskAllHoles ? i : hole_lists[first + i]));
  }
  return true;
}

/// The plain loop over all holes, which the above is measured against.
float left_by_all_holes(vec3 p_world) {
  float left = 1.0;
  for (uint i = 0u; i < frame.holes.count && left > 0.0; ++i) left *= left_by_hole(hole_from_rows(i), p_world);
  return left;
}

#endif
