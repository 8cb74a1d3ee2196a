// Light of a light source at a point, and its shadow map.
#ifndef LIGHTS_GLSL
#define LIGHTS_GLSL
#include "shared/light.h"
#include "shared/spot.h"

struct Incident {
  vec3 irradiance;  // on a surface that faces the light
  float falloff;    // that per intensity of the light
  vec3 to_light;    // unit
  float distance;   // to the light, or to the edge of its ball [m]
};

/// Unshadowed light: the inverse square law, with a smooth window that reaches 0 at the light's range
/// (Karis 2013, "Real Shading in Unreal Engine 4").
Incident light_at(Light light, vec3 position_world) {
  Incident incident;
  if (light.kind == kLightDirectional) {
    incident.irradiance = light.intensity;
    incident.falloff = 1.0;
    incident.to_light = -light.direction;
    incident.distance = 1e4;
    return incident;
  }
  const vec3 to_light = light.position_world - position_world;
  const float d2 = max(dot(to_light, to_light), 1e-12), one_over = inversesqrt(d2);
  incident.distance = max(d2 * one_over - light.radius, 0.0);
  incident.to_light = to_light * one_over;
  const float x = d2 / (light.range * light.range);
  const float window = clamp(1.0 - x * x, 0.0, 1.0);
  const float nearest = light.radius > 0.0 ? light.radius * light.radius : 0.01;
  incident.falloff = window * window * (d2 > nearest ? one_over * one_over : 1.0 / nearest);
  if (light.kind == kLightSpot)
    incident.falloff *= spot_falloff(light.cos_inner, light.cos_outer, dot(-incident.to_light, light.direction));
  incident.irradiance = light.intensity * incident.falloff;
  return incident;
}

float strongest_of(Incident incident) {
  return max(incident.irradiance.r, max(incident.irradiance.g, incident.irradiance.b));
}

/// Irradiance below which a light is ignored in media: a hundredth of that at which it would end but for its window.
/// Lights reach farther, and are ignored later, where the exposure is high.
float least_irradiance(Light light) {
  const float brightest = max(light.intensity.r, max(light.intensity.g, light.intensity.b));
  return min(kLeastIrradiance, 0.01 * brightest / max(light.range * light.range, 1e-30));
}

bool is_negligible(Light light, Incident incident) { return strongest_of(incident) < least_irradiance(light); }

/// A box in world space.
struct TileBox {
  vec3 low, high;
};

/// False only where the light reaches no point of the box. Tests spots against the sphere around the box: Wronski 2017,
/// "Cull that cone!".
bool reaches_box(Light light, TileBox box) {
  if (max(light.intensity.r, max(light.intensity.g, light.intensity.b)) <= 0.0) return false;
  if (light.kind == kLightDirectional) return true;
  const vec3 gap = max(max(box.low - light.position_world, light.position_world - box.high), vec3(0.0));
  if (dot(gap, gap) >= light.range * light.range) return false;
  if (light.kind == kLightPoint || light.cos_outer <= 0.0) return true;
  const vec3 to_box = 0.5 * (box.low + box.high) - light.position_world;
  const float radius = 0.5 * length(box.high - box.low), along = dot(to_box, light.direction);
  const float aside = sqrt(max(dot(to_box, to_box) - along * along, 0.0));
  const float sin_outer = sqrt(1.0 - light.cos_outer * light.cos_outer);
  return light.cos_outer * aside - sin_outer * along <= radius * 1.001 && along >= -radius * 1.001;
}

/// Position of a direction on a light's shadow cube (shared/light.h): uv, face, distance along the face's axis.
vec4 cube_coordinates(vec3 d) {
  const vec3 a = abs(d);
  const bool x = a.x >= a.y && a.x >= a.z, y = !x && a.y >= a.z;
  const float along = x ? d.x : y ? d.y : d.z, right = x ? d.z : d.x, up = y ? d.z : d.y;
  const float face = (x ? 0.0 : y ? 2.0 : 4.0) + (along > 0.0 ? 0.0 : 1.0);
  return vec4(vec2(right, -up) * (0.5 / abs(along)) + 0.5, face, abs(along));
}

/// Position of a point on the faces of a light: uv, face, reverse depth.
vec4 face_coordinates(Light light, mat4 sun_clip_from_world, vec3 position_world) {
  if (light.kind == kLightDirectional) {
    const vec4 clip = sun_clip_from_world * vec4(position_world, 1.0);
    // A ground to the horizon reaches beyond the far side of the scene's bounds, and is behind all that casts shadows.
    return vec4(clip.xy * 0.5 + 0.5, 0.0, max(clip.z, 0.0));
  }
  const vec4 on_cube = cube_coordinates(position_world - light.position_world);
  return vec4(on_cube.xyz, kShadowNear / on_cube.w);
}

/// Fraction of the light that its shadow map lets through; 1 where it has none.
float shadow_at(sampler2DArrayShadow maps, sampler2DShadow sun_map, Light light, vec4 on_face) {
  const bool mapped = light.shadow_layer < kShadowByVoxels && on_face.xy == clamp(on_face.xy, 0.0, 1.0);
  if (!mapped) return 1.0;
  if (light.kind == kLightDirectional) return textureLod(sun_map, on_face.xyw, 0.0);
  return texture(maps, vec4(on_face.xy, float(light.shadow_layer) + on_face.z, on_face.w));
}

#endif
