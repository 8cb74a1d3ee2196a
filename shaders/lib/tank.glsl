// A tank of spheres: its constants and buffers.
#ifndef TANK_GLSL
#define TANK_GLSL
#include "shared/tank.h"

// No uniform buffer: lavapipe compiles a shader again for new values of one that it branches by.
layout(scalar, binding = kBindTank) readonly buffer Tank { TankConstants tank; };
layout(scalar, binding = kBindTankLights) readonly buffer TankLights { TankLight tank_lights[]; };
layout(scalar, binding = kBindSphereBricks) readonly buffer SphereBricks { SphereBrick sphere_bricks[]; };

/// Whether all spheres are opaque surfaces.
layout(constant_id = 0) const bool kOpaque = true;

uint brick_index(ivec3 brick) { return uint((brick.z * tank.bricks.y + brick.y) * tank.bricks.x + brick.x); }

/// Linear colour of a Color (src/spheres/tank.hpp).
vec3 albedo_of(uint color) {
  const vec3 srgb = unpackUnorm4x8(color).rgb;
  return mix(srgb / 12.92, pow((srgb + 0.055) / 1.055, vec3(2.4)), step(0.04045, srgb));
}

bool is_opaque(uint color) { return color >= 0xff000000u; }

/// Of a Color that is not opaque, per voxel's length.
float extinction_of(uint color) { return -log(1.0 - float(color >> 24u) / 255.0); }

/// Where a ray is inside of the tank: x where it enters, not before its origin, and y where it leaves; y <= x:
/// nowhere.
vec2 tank_crossings(vec3 origin, vec3 inverse) {
  const vec3 low = -origin * inverse, high = (vec3(tank.size) - origin) * inverse;
  const vec3 enter = min(low, high), leave = max(low, high);
  return vec2(max(0.0, max(enter.x, max(enter.y, enter.z))), min(leave.x, min(leave.y, leave.z)));
}

/// 1 / direction without infinities.
vec3 inverse_of(vec3 direction) {
  return 1.0 / mix(direction, mix(vec3(-1e-30), vec3(1e-30), greaterThanEqual(direction, vec3(0.0))),
                   lessThan(abs(direction), vec3(1e-30)));
}

/// The camera's ray through a point of the image and a point of the lens.
void tank_camera_ray(vec2 position_px, vec2 on_lens, out vec3 origin, out vec3 direction) {
  const TankCamera camera = tank.camera;
  const vec2 ndc = position_px / vec2(tank.size_px) * 2.0 - 1.0;
  const vec3 along =
      camera.forward + (camera.shift.x + ndc.x) * camera.right + (camera.shift.y - ndc.y) * camera.up;
  const vec3 apart = camera.aperture * (on_lens.x * normalize(camera.right) + on_lens.y * normalize(camera.up));
  origin = camera.eye + apart;
  direction = normalize(camera.focus * along - apart);
}

#endif
