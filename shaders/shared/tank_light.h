// Light in the voxels of a tank, light by light: transmittance along rays from the light, kept where they cross the
// middle of each layer of voxels, then gathered by the voxels.
#ifndef BRUME_TANK_LIGHT_H
#define BRUME_TANK_LIGHT_H
#include "shared/shim.h"
#include "shared/tank.h"
SHARED_BEGIN

SHARED_BINDING(kBindLightMap, 76u);

/// Layers of voxels between those whose light a map keeps.
SHARED_CONST float kMapLayerStep = 2.0f;

/// Rays of a light in one direction along an axis: ray (i, j) leads to origin + depth * (slope, 1), where
/// slope = first_slope + (i, j) * slope_step, along the other two axes in their order x, y, z without `axis`. Layer
/// k of the map is where depth = first_depth + k * kMapLayerStep.
struct LightMap {
  vec3 origin;  // the light
  uint axis;    // 0, 1, 2
  vec2 first_slope;
  vec2 slope_step;  // > 0
  uvec2 rays;
  float sign;         // 1: depth grows along the axis; -1: against it
  float first_depth;  // > 0, to the middle of the first layer
  uint layers;
  uint whole;  // 1: the map's rays meet all voxels; 0: those within slopes of 1
  uvec2 padding SHARED_ZERO;
};
SHARED_SIZE(LightMap, 64);

struct TankLightParams {
  LightMap map;
  ivec3 size;        // of the tank
  uint near_layers;  // that a voxel walks by itself before it reads the map; 0: all, which is exact
  vec3 intensity;    // as TankLight
  uint adds;         // 0: what was there before is replaced
  vec3 ambient;
};
SHARED_SIZE(TankLightParams, 108);

/// Coordinates with the map's axis last.
SHARED_FUNCTION vec3 to_map_axes(uint axis, vec3 v) {
  return axis == 0u ? vec3(v.y, v.z, v.x) : axis == 1u ? vec3(v.x, v.z, v.y) : v;
}
SHARED_FUNCTION vec3 from_map_axes(uint axis, vec3 v) {
  return axis == 0u ? vec3(v.z, v.x, v.y) : axis == 1u ? vec3(v.x, v.z, v.y) : v;
}

/// Three floats with 9 bits each and a common exponent (as VK_FORMAT_E5B9G9R9_UFLOAT_PACK32), [0, 65408].
SHARED_FUNCTION uint pack_rgb9e5(vec3 v) {
  vec3 c = clamp(v, vec3(0.0f), vec3(65408.0f));
  float most = max(c.x, max(c.y, max(c.z, 1.52587890625e-5f)));
  int exponent = int(floatBitsToUint(most) >> 23u) - 127 + 16;  // of 2^-(24 - exponent) for the last bit
  float scale = uintBitsToFloat(uint(127 + 24 - exponent) << 23u);
  if (floor(most * scale + 0.5f) >= 512.0f) {
    exponent += 1;
    scale *= 0.5f;
  }
  uvec3 bits = uvec3(floor(c * scale + 0.5f));
  return bits.x | bits.y << 9u | bits.z << 18u | uint(exponent) << 27u;
}
SHARED_FUNCTION vec3 unpack_rgb9e5(uint bits) {
  float scale = uintBitsToFloat(uint(127 - 24 + int(bits >> 27u)) << 23u);
  return vec3(uvec3(bits & 511u, (bits >> 9u) & 511u, (bits >> 18u) & 511u)) * scale;
}

SHARED_END
#endif
