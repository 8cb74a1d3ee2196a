// Visibility of a light through the scene, by its shadow map or by rays through voxels.
#ifndef LIGHT_VISIBILITY_GLSL
#define LIGHT_VISIBILITY_GLSL
#include "lib/lights.glsl"
#include "lib/solid.glsl"

layout(scalar, binding = kBindSun) readonly buffer Views { ShadowView sun; };
layout(binding = kBindShadowMaps) uniform sampler2DArrayShadow shadow_maps;

/// Fraction of the light that the scene lets through to a point. For a surface pass a point slightly off its plane.
/// `on_face`: the point's face_coordinates.
float light_visibility(Light light, vec4 on_face, vec3 position_world) {
  float visibility = shadow_at(shadow_maps, light, on_face);
  // A loop that runs at most once: a software rasteriser skips loops, but pays for branches that it does not take.
  for (bool by_voxels = light.shadow_layer == kShadowByVoxels; by_voxels; by_voxels = false)
    visibility = segment_visibility(position_world, light.position_world);
  return visibility;
}

float light_visibility(Light light, vec3 position_world) {
  return light_visibility(light, face_coordinates(light, sun.clip_from_world, position_world), position_world);
}

#endif
