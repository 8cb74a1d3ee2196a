// Visibility of a light through the scene, by its shadow map or by rays through voxels.
#ifndef LIGHT_VISIBILITY_GLSL
#define LIGHT_VISIBILITY_GLSL
#include "lib/lights.glsl"
#include "lib/solid.glsl"

layout(scalar, binding = kBindSun) uniform Views { ShadowView sun; };
layout(binding = kBindShadowMaps) uniform sampler2DArrayShadow shadow_maps;
layout(binding = kBindSunMap) uniform sampler2DShadow sun_map;

/// Fraction of the light that the scene lets through to a point. For a surface pass a point slightly off its plane.
float light_visibility(Light light, vec3 position_world) {
  if (light.shadow_layer == kShadowByVoxels) return segment_visibility(position_world, light.position_world);
  return shadow_at(shadow_maps, sun_map, light, face_coordinates(light, sun.clip_from_world, position_world));
}

#endif
