// A light on the device, and the faces of its shadow cube.
#ifndef BRUME_LIGHT_H
#define BRUME_LIGHT_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindLights, 18u);
SHARED_BINDING(kBindSun, 19u);
SHARED_BINDING(kBindShadowMaps, 20u);
SHARED_BINDING(kBindSunMap, 77u);

SHARED_CONST uint kLightPoint = 0u;
SHARED_CONST uint kLightSpot = 1u;
SHARED_CONST uint kLightDirectional = 2u;
SHARED_CONST uint kNoShadow = 0xffffffffu;
SHARED_CONST uint kShadowByVoxels = 0xfffffffeu;  // by rays through the solid volume

struct Light {
  vec3 position_world;
  float range;      // [m]: no light beyond
  vec3 intensity;   // point, spot: [W/sr]; directional: irradiance
  uint kind;
  vec3 direction;   // of the emitted light, unit
  float cos_inner;
  float cos_outer;
  // The first of six layers in the shadow array; 0: a directional light with the sun's map; or a constant from above.
  uint shadow_layer;
  float radius;   // of a ball that shines like the point [m]: inside of it all is lit as at its edge, and nothing casts
                  // shadows
  uint glow_of;   // of what glows in a volume: VolumeInstance::number + 1; 0: of anything else
};
SHARED_SIZE(Light, 64);

/// Distance at which the irradiance of a light falls below 0.01, from its largest intensity [m].
SHARED_FUNCTION float light_range(float intensity) {
  return sqrt(100.0f * intensity);
}

/// Orthographic view of the sun's map: the shadows of a directional light.
struct ShadowView {
  mat4 clip_from_world;
  mat4 world_from_clip;
};
SHARED_SIZE(ShadowView, 128);

/// Irradiance below which a light is ignored in smoke.
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
