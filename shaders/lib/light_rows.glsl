// Lights and the faces of their smoke shadows in rows of 16 bytes: six loads instead of 22.
#ifndef LIGHT_ROWS_GLSL
#define LIGHT_ROWS_GLSL
#include "shared/light.h"
#include "shared/smoke_shadow.h"

layout(binding = kBindLights) readonly buffer Lights { vec4 light_rows[]; };
layout(binding = kBindSmokeShadowFaces) readonly buffer Faces { vec4 face_rows[]; };

Light light_from_rows(uint i) {
  const vec4 a = light_rows[4u * i], b = light_rows[4u * i + 1u];
  const vec4 c = light_rows[4u * i + 2u], d = light_rows[4u * i + 3u];
  return Light(a.xyz, a.w, b.xyz, floatBitsToUint(b.w), c.xyz, c.w, d.x, floatBitsToUint(d.y), d.z,
               floatBitsToUint(d.w));
}

SmokeShadowFace face_from_rows(uint i) {
  const vec4 a = face_rows[2u * i];
  const uvec4 b = floatBitsToUint(face_rows[2u * i + 1u]);
  return SmokeShadowFace(a.x, a.yz, floatBitsToUint(a.w), b.xy, b.zw);
}

#endif
