// A light as the passes read it, and the faces of its shadow cube.
#ifndef BRUME_LIGHT_H
#define BRUME_LIGHT_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST uint kLightPoint = 0u;
SHARED_CONST uint kLightSpot = 1u;
SHARED_CONST uint kLightDirectional = 2u;
SHARED_CONST uint kNoShadow = 0xffffffffu;
SHARED_CONST uint kShadowByVoxels = 0xfffffffeu;  // rays through the solid volume

struct Light {
  vec3 position_world;
  float range;      // [m]: beyond it the light is not seen
  vec3 intensity;   // point, spot: [W/sr]; directional: irradiance
  uint kind;
  vec3 direction;   // where the light goes, unit
  float cos_inner;
  float cos_outer;
  // First layer in the shadow array: six faces, or one of a directional light; or one of the constants above.
  uint shadow_layer;
  vec2 padding;  // to whole rows of 16 bytes
};
SHARED_SIZE(Light, 64);

/// Where what a light sends is below 1/100 of unit irradiance, from the greatest of its intensities [m].
SHARED_FUNCTION float light_range(float intensity) {
  return sqrt(100.0f * intensity);
}

/// Where a directional light's shadow layer looks: clip space of an orthographic view.
struct ShadowView {
  mat4 clip_from_world;
  mat4 world_from_clip;
};
SHARED_SIZE(ShadowView, 128);

/// Of a light in smoke: less is not seen.
SHARED_CONST float kLeastIrradiance = 1e-4f;

SHARED_CONST float kShadowNear = 0.05f;  // [m]

SHARED_FUNCTION vec3 cube_forward(uint face) {
  float s = (face & 1u) == 0u ? 1.0f : -1.0f;
  return face < 2u ? vec3(s, 0.0f, 0.0f) : face < 4u ? vec3(0.0f, s, 0.0f) : vec3(0.0f, 0.0f, s);
}
SHARED_FUNCTION vec3 cube_right(uint face) { return face < 2u ? vec3(0.0f, 0.0f, 1.0f) : vec3(1.0f, 0.0f, 0.0f); }
SHARED_FUNCTION vec3 cube_up(uint face) {
  return face >= 2u && face < 4u ? vec3(0.0f, 0.0f, 1.0f) : vec3(0.0f, 1.0f, 0.0f);
}

SHARED_END
#endif
