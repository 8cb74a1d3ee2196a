// Shadows of the media on surfaces that a host drew: what each of up to four lights keeps of its light on the way to
// the surface of a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/camera.glsl"
#include "lib/lights.glsl"
#include "shared/gbuffer.h"
#include "shared/smoke_shadow.h"
#include "shared/surface_import.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindDepth) uniform sampler2D depth;
layout(binding = kBindSmokeShadows) uniform sampler2D smoke_shadows;
layout(scalar, binding = kBindSun) uniform Sun { ShadowView sun; };
layout(binding = kBindSurfaceShadows, rgba16f) uniform writeonly image2D shadows_image;
layout(scalar, push_constant) uniform Push { SurfaceShadowParams params; };
#include "lib/light_rows.glsl"
#include "lib/smoke_transmittance.glsl"

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  const float d = texelFetch(depth, px, 0).r;
  vec4 transmittances = vec4(1.0);
  if (d > 0.0) {
    const vec3 position_world =
        camera_point(frame.camera, vec2(px) + 0.5, frame.size_px, view_distance(frame.camera, d));
    const vec2 texel_uv = 1.0 / vec2(textureSize(smoke_shadows, 0));
    for (uint i = 0u; i < kMaxSurfaceShadows; ++i) {
      if (params.lights[i] == kNoLight) continue;
      const vec4 on_face = face_coordinates(light_from_rows(params.lights[i]), sun.clip_from_world, position_world);
      transmittances[i] = smoke_transmittance(params.lights[i], on_face, texel_uv);
    }
  }
  imageStore(shadows_image, px, transmittances);
}
