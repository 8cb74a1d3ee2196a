// Light of one source in each voxel of a tank: a few layers of voxels towards the light one by one, then what the
// light's map says, or all of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/voxel_extinction.glsl"
#include "shared/tank_light.h"

layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
layout(binding = kBindLightMap) uniform sampler3D light_map;
layout(binding = kBindVoxelLight, r32ui) uniform uimage3D voxel_light;
layout(push_constant, scalar) uniform Params { TankLightParams params; };

const float kPi = 3.14159265;

/// Transmittance from the middle of a voxel to the light, without what the voxel itself blocks. `at`: in map axes,
/// from the light.
float transmittance(ivec3 voxel, vec3 at) {
  const LightMap map = params.map;
  const vec3 origin = vec3(voxel) + 0.5, direction = map.origin - origin;  // t: 1 at the light
  const vec3 inverse = 1.0 / mix(direction, vec3(1e-30), lessThan(abs(direction), vec3(1e-30)));
  const ivec3 ahead = ivec3(greaterThanEqual(direction, vec3(0.0)));
  const float far = length(direction), layers = abs(at.z);

  // Where the walk ends: at a layer of the map, at the light, or where the tank ends.
  const vec3 leave = max(-origin * inverse, (vec3(params.size) - origin) * inverse);
  float end = min(1.0, min(leave.x, min(leave.y, leave.z)));
  const float layer = floor((layers - float(params.near_layers) - map.first_depth + 0.25) / kMapLayerStep);
  const bool reads = params.near_layers > 0u && layer >= 0.0;
  if (reads) end = min(end, 1.0 - (map.first_depth + layer * kMapLayerStep) / layers);

  ivec3 cell = voxel;
  float t = 0.0, optical_depth = 0.0;
  bool first = true;
  while (t < end && optical_depth < 12.0) {
    const vec3 planes = (vec3(cell + ahead) - origin) * inverse;
    const float next = min(planes.x, min(planes.y, planes.z));
    if (!first)
      optical_depth += voxel_extinction(texelFetch(voxel_colors, cell, 0).r) * far * max(0.0, min(next, end) - t);
    first = false;
    cell += (2 * ahead - 1) * ivec3(lessThanEqual(planes, vec3(next)));
    t = next;
  }
  if (!reads || optical_depth >= 12.0) return exp(-optical_depth);
  const vec2 ray = (at.xy / layers - map.first_slope) / map.slope_step;
  const vec3 texel = vec3(ray, layer) + 0.5;
  return exp(-optical_depth) * textureLod(light_map, texel / vec3(textureSize(light_map, 0)), 0.0).r;
}

void main() {
  const ivec3 voxel = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(voxel, params.size))) return;
  const uint color = texelFetch(voxel_colors, voxel, 0).r;
  vec3 light = params.adds != 0u ? unpack_rgb9e5(imageLoad(voxel_light, voxel).r) : params.ambient;
  const vec3 apart = vec3(voxel) + 0.5 - params.map.origin, at = to_map_axes(params.map.axis, apart);
  // A map of slopes up to 1 is one of six: voxels between them belong to the one of the first axis.
  const float depth = at.z * params.map.sign, across = max(abs(at.x), abs(at.y));
  bool mine = params.map.whole != 0u || across < depth;
  if (params.map.whole == 0u && across == depth)
    mine = params.map.axis == 0u || (params.map.axis == 1u && abs(apart.x) < depth);
  if (color != 0u && mine) {
    // Light that an opaque voxel scatters leaves on the side that faces the viewer, half of all.
    const float phase = (color >= 0xff000000u ? 0.5 : 0.25) / kPi;
    light += params.intensity * (phase * transmittance(voxel, at) / max(dot(apart, apart), 0.25));
  } else if (params.adds != 0u) {
    return;
  }
  imageStore(voxel_light, voxel, uvec4(pack_rgb9e5(color != 0u ? light : vec3(0.0))));
}
