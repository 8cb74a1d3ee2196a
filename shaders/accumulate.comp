// Temporal accumulation: the mean of the smoke of this frame and of previous frames where they still match.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/camera.glsl"
#include "lib/image_part.glsl"
#include "lib/smoke_distance.glsl"
#include "lib/upsample.glsl"
#include "shared/accumulate.h"
#include "shared/gbuffer.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindDepth) uniform sampler2D depth;
layout(binding = kBindSmoke) uniform sampler2D smoke;
layout(binding = kBindPastSmoke) uniform sampler2D past_smoke;
layout(scalar, binding = kBindPastPixels) readonly buffer Past { AccumulatedPixel past[]; };
layout(binding = kBindMeanSmoke, rgba16f) uniform writeonly image2D mean_smoke;
layout(scalar, binding = kBindMeanPixels) writeonly buffer Pixels { AccumulatedPixel pixels[]; };
layout(scalar, push_constant) uniform Push { AccumulateParams params; };

/// Result of the previous frame for a pixel.
struct History {
  vec4 smoke;
  float frames;  // 0: none
};

History history_of(vec3 p_smoke, vec3 p_surface) {
  History history = History(vec4(0.0), 0.0);
  const vec4 seen = params.past_from_world * vec4(p_smoke, 1.0);
  if (params.has_past == 0u || seen.w <= frame.camera.near_z) return history;
  const vec2 uv = seen.xy / seen.z * 0.5 + 0.5;
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) return history;
  const uvec2 size_px = params.past_size_px, px = min(uvec2(uv * vec2(size_px)), size_px - 1u);
  const AccumulatedPixel before = past[px.x + size_px.x * px.y];
  // The surface behind the smoke must have been as far away, since it ends the ray.
  const vec4 surface = params.past_from_world * vec4(p_surface, 1.0);
  const float off = abs(surface.w - before.distance_in_smoke) * frame.media.extinction;
  history.smoke = textureLod(past_smoke, uv_of_part(uv, size_px, textureSize(past_smoke, 0)), 0.0);
  history.frames = before.frames / (1.0 + 16.0 * off * off);
  return history;
}

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy), size = ivec2(frame.size_px);
  if (any(greaterThanEqual(px, size))) return;

  // Mean and standard deviation of this frame around the pixel, premultiplied.
  const vec4 here = texelFetch(smoke, px, 0);
  vec4 mean = vec4(0.0), square = vec4(0.0);
  for (int i = 0; i < 9; ++i) {
    const vec4 s = texelFetch(smoke, clamp(px + ivec2(i % 3, i / 3) - 1, ivec2(0), size - 1), 0);
    mean += s / 9.0;
    square += s * s / 9.0;
  }
  const vec4 deviation = sqrt(max(square - mean * mean, vec4(0.0)));

  const vec3 origin = camera_origin(frame.camera, vec2(px) + 0.5, frame.size_px);
  const vec3 ray = camera_ray(frame.camera, vec2(px) + 0.5, frame.size_px);
  const float z = distance_in_smoke(frame, texelFetch(depth, px, 0).r);
  const vec3 p_smoke = origin + smoke_distance(origin, ray, z, here.a) * ray;
  const History history = history_of(p_smoke, origin + z * ray);

  // Clamps the past to plausible values, so that a closed hole disappears (variance clipping, Salvi 2016, "An Excursion
  // in Temporal Supersampling"). The further the clamp moves it, the less it counts.
  const vec4 low = min(mean - deviation, here), high = max(mean + deviation, here);
  const vec4 plausible = clamp(history.smoke, low, high);
  const vec4 moved = abs(plausible - history.smoke) / (high - low + 1.0 / 255.0);
  const float fits = 1.0 / (1.0 + max(max(moved.r, moved.g), max(moved.b, moved.a)));
  const float frames = min(history.frames * fits + 1.0, kAccumulatedFrames);
  imageStore(mean_smoke, px, mix(plausible, here, 1.0 / frames));
  pixels[uint(px.x) + frame.size_px.x * uint(px.y)] = AccumulatedPixel(z, frames);
}
