// Motion vectors and distances of the marched media, for a host's upscaler.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/camera.glsl"
#include "lib/smoke_distance.glsl"
#include "shared/gbuffer.h"
#include "shared/resolve.h"
#include "shared/smoke_motion.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindDepth) uniform sampler2D depth;
layout(binding = kBindSmoke) uniform sampler2D smoke;
layout(scalar, binding = kBindMotionEntries) readonly buffer Entries {
  uint samples;
  float entries[];  // along the unit ray [m]
};
layout(binding = kBindSmokeMotion, rgba16f) uniform writeonly image2D motion_image;
layout(scalar, push_constant) uniform Push { SmokeMotionParams params; };

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  const float transmittance = texelFetch(smoke, px, 0).a;
  vec4 found = vec4(0.0, 0.0, kNoSmoke, kNoSmoke);
  if (transmittance < 1.0) {
    const vec3 origin = camera_origin(frame.camera, vec2(px) + 0.5, frame.size_px);
    const vec3 ray = camera_ray(frame.camera, vec2(px) + 0.5, frame.size_px);
    const float z_surface = view_distance(frame.camera, texelFetch(depth, px, 0).r);
    const float z = smoke_distance(origin, ray, z_surface, transmittance);
    const vec4 past = params.past_from_world * vec4(origin + z * ray, 1.0);
    if (params.has_past != 0u && past.w > frame.camera.near_z)
      found.xy = (past.xy / past.z * 0.5 + 0.5) * vec2(frame.size_px) - (vec2(px) + 0.5 + params.jitter_px);
    // Thin smoke has no entry.
    const float entry = entries[uint(px.x) + frame.size_px.x * uint(px.y)] / length(ray);
    found.zw = min(vec2(min(entry, z), z), kNoSmoke);
  }
  imageStore(motion_image, px, found);
}
