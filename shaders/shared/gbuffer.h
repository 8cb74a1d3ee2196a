// What a draw into the G-buffer gets.
#ifndef BRUME_GBUFFER_H
#define BRUME_GBUFFER_H
#include "shared/shim.h"
SHARED_BEGIN

/// A vertex as the shaders pull it.
struct Vertex {
  vec3 position;
  vec3 normal;
  vec4 tangent;
  vec2 uv;
};
SHARED_SIZE(Vertex, 48);

struct MaterialConstants {
  vec3 base_color;
  float roughness;
  vec3 emission;
  float metallic;
  float alpha_cutoff;
};
SHARED_SIZE(MaterialConstants, 36);

/// Rows of world_from_mesh, so that it fits the push constants with the material.
struct DrawConstants {
  vec4 row0, row1, row2;
  MaterialConstants material;
};
SHARED_SIZE(DrawConstants, 84);

/// A draw into a shadow layer: clip_from_mesh.
struct ShadowDraw {
  mat4 clip_from_mesh;
};
SHARED_SIZE(ShadowDraw, 64);

SHARED_END
#endif
