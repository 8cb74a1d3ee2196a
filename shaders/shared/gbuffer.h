// Inputs of draws into the G-buffer and into shadow maps.
#ifndef BRUME_GBUFFER_H
#define BRUME_GBUFFER_H
#include "shared/pane.h"
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindAlbedoRoughness, 23u);
SHARED_BINDING(kBindNormalMetallic, 24u);
SHARED_BINDING(kBindEmission, 25u);
SHARED_BINDING(kBindDepth, 26u);
SHARED_BINDING(kBindVertices, 32u);
SHARED_BINDING(kBindBaseColorMap, 33u);
SHARED_BINDING(kBindNormalMap, 34u);
SHARED_BINDING(kBindRoughnessMap, 35u);

/// A vertex, pulled by the vertex shader.
struct Vertex {
  PackedVec3 position;
  PackedVec3 normal;
  PackedVec4 tangent;
  vec2 uv;
  /// 1 - the vertex colour, as four unorm16. White is zero, which interpolation keeps exactly.
  uvec2 color_complement;
};
SHARED_SIZE(Vertex, 56);

struct MaterialConstants {
  vec3 base_color;
  float roughness;
  vec3 emission;
  float metallic;
  float alpha_cutoff;
  PaneMaterial pane;
};
SHARED_SIZE(MaterialConstants, 48);

/// The fourth channel of the normals: the metallic factor, and whether the surface moves over the level, by its sign.
SHARED_FUNCTION float metallic_and_moves(float metallic, float moves) {
  return moves > 0.0f ? -1.0f - metallic : metallic;
}
SHARED_FUNCTION float metallic_of(float stored) { return stored < 0.0f ? -1.0f - stored : stored; }
SHARED_FUNCTION bool moves_of(float stored) { return stored < 0.0f; }

struct DrawConstants {
  Affine world_from_mesh;
  MaterialConstants material;
  float moves;  // 1: it moves over the level, and decals do not darken it
};
SHARED_SIZE(DrawConstants, 100);

/// A draw into a shadow layer or the sun's map.
struct ShadowDraw {
  mat4 clip_from_mesh;
  float alpha_cutoff;
};
SHARED_SIZE(ShadowDraw, 68);

SHARED_END
#endif
