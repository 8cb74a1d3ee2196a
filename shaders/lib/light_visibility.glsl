// Shadows of every kind. Needs `frame`, `sun` and `shadows`; the includer defines BINDING_SOLID.
#ifndef LIGHT_SHARE_GLSL
#define LIGHT_SHARE_GLSL
#include "lib/lights.glsl"
#include "lib/solid.glsl"

/// Share of the light that the scene lets through to a point, whichever kind of shadow the light has. Of a surface,
/// ask for a point a little off its plane. `on_face`: its face_coordinates.
float light_visibility(Light light, vec4 on_face, vec3 position_world) {
  float share = shadow_at(shadows, light, on_face);
  // A loop that runs at most once: a software rasteriser pays for branches that it does not take, not for loops.
  for (bool by_voxels = light.shadow_layer == kShadowByVoxels; by_voxels; by_voxels = false)
    share = free_way(position_world, light.position_world);
  return share;
}

float light_visibility(Light light, vec3 position_world) {
  return light_visibility(light, face_coordinates(light, sun.clip_from_world, position_world), position_world);
}

#endif
