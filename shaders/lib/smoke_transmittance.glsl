// A look into the atlas of smoke shadows (shared/smoke_shadow.h). Requires `smoke_shadows` and light_rows.glsl.
#ifndef SMOKE_TRANSMITTANCE_GLSL
#define SMOKE_TRANSMITTANCE_GLSL

/// Transmittance of the smoke between a light and a surface. `texel_uv`: the size of a texel of the atlas.
float smoke_transmittance(uint index, vec4 on_face, vec2 texel_uv) {
  const SmokeShadowFace face = face_from_rows(index * kFacesPerLight + uint(on_face.z));
  const vec2 texel = on_face.xy * face.scale + face.offset;
  const vec2 inside = clamp(texel, vec2(face.first_texel) + 0.5, vec2(face.first_texel + face.size) - 0.5);
  if (face.size.x == 0u || texel != inside) return 1.0;
  return textureLod(smoke_shadows, texel * texel_uv, 0.0).r;
}

#endif
