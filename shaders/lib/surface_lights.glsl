// A light on a surface, past what shadows it. The includer defines the constant kVoxelShadows, 0 where no light is
// shadowed by voxels.
#ifndef SURFACE_LIGHTS_GLSL
#define SURFACE_LIGHTS_GLSL
#include "lib/light_visibility.glsl"

struct LightOnSurface {
  vec3 to_light;       // unit
  float received;      // irradiance per intensity, if nothing shadows it
  vec4 on_face;        // place on the light's faces
  vec3 off_world;      // a point off the surface
  bool by_voxels;      // how it is shadowed
};

LightOnSurface light_on_surface(Light light, vec3 position_world, vec3 normal) {
  const Incident incident = light_at(light, position_world);
  LightOnSurface on;
  on.to_light = incident.to_light;
  on.received = max(dot(normal, on.to_light), 0.0) * incident.falloff;
  // Against self-shadowing the lookup is one texel of the shadow off the surface.
  on.by_voxels = kVoxelShadows != 0u && light.shadow_layer == kShadowByVoxels;
  const float off = on.by_voxels ? frame.solid.texel_size : 0.01 + 0.006 * min(incident.distance, 10.0);
  on.off_world = position_world + off * normal;
  // The smoke's shadow has no surfaces of its own: off the surface, a light close to it would be on the other side.
  on.on_face = face_coordinates(light, sun.clip_from_world, on.by_voxels ? position_world : on.off_world);
  return on;
}

/// Fraction of the light that surfaces let through.
float visibility_on_surface(Light light, LightOnSurface on) {
  return on.by_voxels ? segment_visibility(on.off_world, light.position_world)
                      : shadow_at(shadow_maps, sun_map, light, on.on_face);
}

#endif
