// What holes leave of the smoke at the samples of a ray from the eye: exactly, sample by sample, but a ray asks only the
// holes that it meets, and only from where it enters them to where it leaves them.
//
// The workgroup finds the holes that any of its rays may meet; then each ray looks kAhead samples ahead. The includer
// has `frame`, `noise_tile`, a workgroup of 64 threads and the constant kHoles, and defines BINDING_HOLES,
// BINDING_HOLE_TILES and BINDING_HOLE_MASKS.
#ifndef RAY_HOLES_GLSL
#define RAY_HOLES_GLSL
#include "lib/ray_cone.glsl"

layout(binding = BINDING_HOLES) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = BINDING_HOLE_TILES) readonly buffer HoleTiles { uint hole_tiles[]; };
layout(binding = BINDING_HOLE_MASKS) uniform sampler2D hole_masks;
#include "lib/hole_mask.glsl"
#include "lib/hole_rows.glsl"

const uint kAhead = 64u;
// Frames without holes pay for none of it.
const uint kShared = kHoles == kHolesListed ? 1u : 0u;

shared uint group_bits[kShared * (kMaxHoles / 32u - 1u) + 1u];  // one a hole
// One a word of those that is not 0.
shared uint group_words[kShared * (kMaxHoles / 32u / 32u - 1u) + 1u];
// What is left at each sample and thread: two half floats a word. At first the candidates of the whole group.
shared uint left_ahead[kShared * (kAhead / 2u * 64u - 1u) + 1u];
shared uint candidate_count;
shared uvec4 group_px;  // the rectangle of the picture that the group's rays run through: low, high
shared uint group_length;

/// Enters those of a tile's holes that rays of the cone may meet. All threads of the workgroup.
void find_holes_of_tile(RayCone cone, uint tile) {
  const uint lane = gl_LocalInvocationIndex;
  for (uint first = 0u; first < frame.holes.tile_words; first += 64u) {
    if (lane == 0u) candidate_count = 0u;
    barrier();
    uint bits = first + lane < frame.holes.tile_words ? hole_tiles[tile + first + lane] : 0u;
    uint at = bits != 0u ? atomicAdd(candidate_count, uint(bitCount(bits))) : 0u;
    for (; bits != 0u; bits &= bits - 1u) left_ahead[at++] = 32u * (first + lane) + uint(findLSB(bits));
    barrier();
    for (uint i = lane; i < candidate_count; i += 64u) {
      const uint hole = left_ahead[i];
      if (!cone_meets_hole(cone, hole_reach(hole_from_rows(hole), frame.time, frame.look.hole_rim))) continue;
      atomicOr(group_bits[hole >> 5u], 1u << (hole & 31u));
      atomicOr(group_words[hole >> 10u], 1u << (hole >> 5u & 31u));
    }
    barrier();
  }
}

/// Finds the holes that the group's rays may meet: those of its threads for which `is_ray`, each through a point of the
/// picture and of a length. All threads of the workgroup take part.
void find_group_holes(bool is_ray, vec2 position_px, float length_m) {
  const uint lane = gl_LocalInvocationIndex;
  for (uint i = lane; i < frame.holes.tile_words; i += 64u) group_bits[i] = 0u;
  if (lane < kMaxHoles / 1024u) group_words[lane] = 0u;
  if (lane == 0u) {
    group_px = uvec4(frame.size_px, 0u, 0u);
    group_length = 0u;
  }
  barrier();
  if (is_ray) {
    const uvec2 px = uvec2(position_px);
    atomicMin(group_px.x, px.x);
    atomicMin(group_px.y, px.y);
    atomicMax(group_px.z, px.x + 1u);
    atomicMax(group_px.w, px.y + 1u);
    atomicMax(group_length, floatBitsToUint(max(length_m, 0.0)));
  }
  barrier();
  if (group_length == 0u) return;
  const RayCone cone = cone_of_pixels(vec2(group_px.xy), vec2(group_px.zw), uintBitsToFloat(group_length));
  const uvec2 first = group_px.xy / kHoleTilePixels, last = (group_px.zw - 1u) / kHoleTilePixels;
  for (uint y = first.y; y <= last.y; ++y)
    for (uint x = first.x; x <= last.x; ++x) find_holes_of_tile(cone, frame.holes.tile_words * (x + frame.holes.tiles_across * y));
}

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
float left_at(uint k) {
  const vec2 two = unpackHalf2x16(left_ahead[(k >> 1u) * 64u + gl_LocalInvocationIndex]);
  return (k & 1u) == 0u ? two.x : two.y;
}

/// Finds what the group's holes leave at the ray's next kAhead samples from `begin` on.
void look_ahead(RaySamples ray, float begin) {
  const uint lane = gl_LocalInvocationIndex;
  for (uint i = 0u; i < kAhead / 2u; ++i) left_ahead[i * 64u + lane] = 0x3c003c00u;  // 1, 1
  for (uint w = 0u; 1024u * w < frame.holes.count; ++w) {
    for (uint some = group_words[w]; some != 0u; some &= some - 1u) {
      const uint word = 32u * w + uint(findLSB(some));
      for (uint bits = group_bits[word]; bits != 0u; bits &= bits - 1u) {
        const Hole hole = hole_from_rows(32u * word + uint(findLSB(bits)));
        const uvec2 run = samples_in(hole, ray, begin, frame.look.hole_rim);
        for (uint k = run.x; k < run.y; ++k) {
          const float t = begin + float(k) * ray.ds;
          const vec3 p_world = ray.origin_world + (t + ray.jitter * min(ray.ds, ray.end - t)) * ray.direction;
          const uint at = (k >> 1u) * 64u + lane;
          const float left = left_by_hole(hole, p_world);
          left_ahead[at] = packHalf2x16(unpackHalf2x16(left_ahead[at]) * ((k & 1u) == 0u ? vec2(left, 1.0) : vec2(1.0, left)));
        }
      }
    }
  }
}

/// The plain loop over all holes, which the above is measured against.
float left_by_all_holes(vec3 p_world) {
  float left = 1.0;
  for (uint i = 0u; i < frame.holes.count && left > 0.0; ++i) left *= left_by_hole(hole_from_rows(i), p_world);
  return left;
}

#endif
