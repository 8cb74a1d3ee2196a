// Smoke of this frame and those before it: where the past still fits, their mean.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/camera.glsl"
#include "lib/upsample.glsl"
#include "shared/accumulate.h"
#include "shared/frame.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(binding = 1) uniform sampler2D depth;
layout(binding = 2) uniform sampler2D smoke;
layout(binding = 3) uniform sampler2D past_smoke;
layout(scalar, binding = 4) readonly buffer Past { AccumulatedPixel past[]; };
layout(binding = 5, rgba16f) uniform writeonly image2D gathered;
layout(scalar, binding = 6) writeonly buffer Kept { AccumulatedPixel kept[]; };
layout(push_constant, scalar) uniform Impulse { AccumulateParams params; };

/// Where the smoke of a pixel is, as a distance along the view axis: as far as light of an even medium between where
/// the ray enters the smoke's bounds and the surface comes from on average. Smoke moves slowly; its parallax is that of
/// this place, not that of the surface behind.
float smoke_distance(vec3 ray, float z_surface, float transmittance) {
  const VolumeLayout volume = frame.volume;
  const vec3 inverse = 1.0 / (ray + vec3(equal(ray, vec3(0.0))) * 1e-9);
  const vec3 to_low = volume.origin_world + volume.bounds_min * volume.voxel_size - frame.camera.eye_world;
  const vec3 to_high = volume.origin_world + volume.bounds_max * volume.voxel_size - frame.camera.eye_world;
  const vec3 t0 = to_low * inverse, t1 = to_high * inverse;
  const vec3 low = min(t0, t1), high = max(t0, t1);
  const float enter = max(max(low.x, low.y), max(low.z, 0.0));
  const float leave = min(min(high.x, high.y), min(high.z, z_surface));
  if (leave <= enter) return z_surface;
  // What is opaque is dense.
  const bool opaque = transmittance <= max(frame.look.opaque_transmittance, 1e-3);
  const float tau = opaque ? max(frame.look.extinction * (leave - enter), 7.0) : -log(transmittance);
  // The mean of a truncated exponential distribution.
  const float share = tau > 0.01 ? 1.0 / tau - exp(-tau) / (1.0 - exp(-tau)) : 0.5;
  return mix(enter, leave, share);
}

/// What the frame before knows of a pixel.
struct History {
  vec4 smoke;
  float frames;  // 0: nothing
};

History history_of(vec3 p_smoke, vec3 p_surface) {
  History history = History(vec4(0.0), 0.0);
  const vec4 clip = params.past_clip_from_world * vec4(p_smoke, 1.0);
  if (params.has_past == 0u || clip.w <= frame.camera.near_z) return history;
  const vec2 uv = clip.xy / clip.w * 0.5 + 0.5;
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) return history;
  const uvec2 px = min(uvec2(uv * vec2(frame.size_px)), frame.size_px - 1u);
  const AccumulatedPixel before = past[px.x + frame.size_px.x * px.y];
  // What stood behind the smoke must have stood as far away: other surfaces end rays elsewhere.
  const vec4 surface = params.past_clip_from_world * vec4(p_surface, 1.0);
  const float apart = abs(surface.w - before.distance_in_smoke) * frame.look.extinction;
  history.smoke = textureLod(past_smoke, uv, 0.0);
  history.frames = before.frames / (1.0 + 16.0 * apart * apart);
  return history;
}

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy), size = ivec2(frame.size_px);
  if (any(greaterThanEqual(px, size))) return;

  // This frame around the pixel: mean and standard deviation, premultiplied.
  const vec4 here = texelFetch(smoke, px, 0);
  vec4 mean = vec4(0.0), square = vec4(0.0);
  for (int i = 0; i < 9; ++i) {
    const vec4 s = texelFetch(smoke, clamp(px + ivec2(i % 3, i / 3) - 1, ivec2(0), size - 1), 0);
    mean += s / 9.0;
    square += s * s / 9.0;
  }
  const vec4 deviation = sqrt(max(square - mean * mean, vec4(0.0)));

  const vec3 ray = camera_ray(frame.camera, vec2(px) + 0.5, frame.size_px);
  const float z = distance_in_smoke(frame, texelFetch(depth, px, 0).r);
  const vec3 p_smoke = frame.camera.eye_world + smoke_distance(ray, z, here.a) * ray;
  const History history = history_of(p_smoke, frame.camera.eye_world + z * ray);

  // The past is moved into what is plausible now: a hole that has closed has nothing left to show (variance clipping,
  // Salvi 2016, "An Excursion in Temporal Supersampling"). What had to be moved far is forgotten soon.
  const vec4 low = min(mean - deviation, here), high = max(mean + deviation, here);
  const vec4 plausible = clamp(history.smoke, low, high);
  const vec4 moved = abs(plausible - history.smoke) / (high - low + 1.0 / 255.0);
  const float fits = 1.0 / (1.0 + max(max(moved.r, moved.g), max(moved.b, moved.a)));
  const float frames = min(history.frames * fits + 1.0, kAccumulatedFrames);
  imageStore(gathered, px, mix(plausible, here, 1.0 / frames));
  kept[uint(px.x) + frame.size_px.x * uint(px.y)] = AccumulatedPixel(z, frames);
}
