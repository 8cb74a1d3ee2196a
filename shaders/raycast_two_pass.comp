// Two-pass raycasting: marches the ray of each pixel between two interval surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/raycast_march.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindRayEntries) uniform sampler2D entries;
layout(binding = kBindRayExits) uniform sampler2D exits;
layout(binding = kBindRaycastTarget, rgba16f) uniform image2D target;
layout(scalar, push_constant) uniform Push { RaycastDraw draw; };

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(pixel), view.size_px))) return;
  const vec4 entry = texelFetch(entries, pixel, 0), exit = texelFetch(exits, pixel, 0);
  if (entry == exit) return;

  // Where only a back face is drawn the eye is inside the box: the ray begins there.
  const RaycastRay ray = raycast_ray(draw.volume, pixel);
  const vec3 per_metre = ray.voxel.per_metre / dot(ray.voxel.per_metre, ray.voxel.per_metre);
  const float enter = entry.w > 0.0 ? dot(entry.xyz - ray.voxel.origin, per_metre) : 0.0;
  const float leave = dot(exit.xyz - ray.voxel.origin, per_metre);

  const vec4 volume = raycast_march(draw.volume, ray, vec2(enter, leave)), behind = imageLoad(target, pixel);
  imageStore(target, pixel, vec4(volume.rgb + volume.a * behind.rgb, volume.a * behind.a));
}
