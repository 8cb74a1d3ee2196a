// World normals of the surfaces that a host drew, as gbuffer.frag leaves them: from those of the host, or from the
// depth.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/camera.glsl"
#include "shared/gbuffer.h"
#include "shared/surface_import.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindDepth) uniform sampler2D depth;
layout(binding = kBindHostNormals) uniform sampler2D host_normals;
layout(binding = kBindImportedNormals, rgba16f) uniform writeonly image2D normal_image;
layout(scalar, push_constant) uniform Push { SurfaceNormalParams params; };

/// near_z / distance or, in a parallel view, -distance: on a plane affine in the x and y of the image. 0: no surface.
float depth_at(ivec2 px) {
  const float d = all(lessThan(uvec2(px), frame.size_px)) ? texelFetch(depth, px, 0).r : 0.0;
  return frame.camera.parallel != 0.0 && d > 0.0 ? -view_distance(frame.camera, d) : d;
}

/// How the depth changes from pixel to pixel: on a plane, as much everywhere. Of both sides, the one that this pixel
/// continues best.
float slope(ivec2 px, float here, ivec2 along) {
  float change = 0.0, least_bend = 1e30;
  for (int side = -1; side <= 1; side += 2) {
    const float next = depth_at(px + side * along), second = depth_at(px + 2 * side * along);
    if (next == 0.0) continue;
    const float bend = second != 0.0 ? abs(here - 2.0 * next + second) : abs(next - here);
    if (bend >= least_bend) continue;
    least_bend = bend;
    change = float(side) * (next - here);
  }
  return change;
}

/// On the plane n (p - eye) = near_z the depth is n (forward + x right + y up): its derivatives are the parts of n
/// along right and up. In a parallel view so they are of the n whose part along forward is 1.
vec3 normal_of_depth(ivec2 px, float here) {
  const Camera camera = frame.camera;
  const vec2 half_size = 0.5 * vec2(frame.size_px);
  const vec2 xy = camera.shift + vec2(1.0, -1.0) * ((vec2(px) + 0.5) / half_size - 1.0);
  const vec2 by_xy = half_size * vec2(slope(px, here, ivec2(1, 0)), -slope(px, here, ivec2(0, 1)));
  const float along = camera.parallel != 0.0 ? 1.0 : here - dot(xy, by_xy);
  const vec3 away = by_xy.x / dot(camera.right, camera.right) * camera.right +
                    by_xy.y / dot(camera.up, camera.up) * camera.up + along * camera.forward;
  return -normalize(away);
}

/// Of any length.
vec3 decoded(vec4 given) {
  if (params.encoding == kNormalsSigned) return given.xyz;
  if (params.encoding == kNormalsUnsigned) return 2.0 * given.xyz - 1.0;
  const vec2 on_square = params.encoding == kNormalsOctahedral ? given.xy : 2.0 * given.xy - 1.0;
  const float z = 1.0 - abs(on_square.x) - abs(on_square.y);
  const vec2 folded = on_square - max(-z, 0.0) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(on_square, vec2(0.0)));
  return vec3(folded, z);
}

vec3 from_view(vec3 n) {
  return n.x * normalize(frame.camera.right) + n.y * normalize(frame.camera.up) - n.z * frame.camera.forward;
}

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  const float here = depth_at(px);
  vec3 normal = vec3(0.0);
  bool receives = here != 0.0, has_normal = false;
  if (receives && params.encoding != kNormalsOfDepth) {
    const vec4 given = texelFetch(host_normals, px + ivec2(params.origin_px), 0);
    receives = params.alpha_receives == 0u || given.a != 0.0;
    const vec3 n = decoded(given);
    // False for what is not a number.
    const float size = dot(abs(n), vec3(1.0));
    has_normal = size > 1e-6 && size < 1e30;
    if (has_normal) normal = normalize(n / size);
    if (has_normal && params.of_view != 0u) normal = from_view(normal);
  }
  if (receives && !has_normal) normal = normal_of_depth(px, here);
  imageStore(normal_image, px, vec4(normal, metallic_and_moves(0.0, receives ? 0.0 : 1.0)));
}
