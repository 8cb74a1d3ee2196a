// What each cell of a volume's cube emits, absorbs and scatters, on average (shared/glow_field.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/frame.glsl"
#include "shared/glow_field.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kMedia = 0u;
layout(binding = kBindGlowMatterTarget, rgba16f) uniform writeonly image3D matter_target;
layout(binding = kBindGlowAlbedoTarget, rgba16f) uniform writeonly image3D albedo_target;
layout(scalar, push_constant) uniform Push { GlowFieldParams params; };
#include "lib/volume_extinction.glsl"
#include "lib/volume_glow.glsl"

/// Points of a cell along an axis, two voxels apart; at most this many.
const float kMostPoints = 4.0;
const float kMostHalf = 65504.0;

struct CellSum {
  vec3 emission, scattering;
  float extinction;
};

/// Adds a point of the volume's voxel space, which stands for p_voxel - half_voxels to p_voxel + half_voxels.
void add_point(uint i, vec3 p_voxel, vec3 half_voxels, inout CellSum sum) {
  VolumeMatter matter = matter_around(volumes[i], i, p_voxel, half_voxels);
  const float extinction = volumes[i].look.extinction * density_left(volumes[i], matter.density);
  sum.extinction += extinction;
  sum.scattering += extinction * matter.albedo;
  sum.emission += extinction * matter.emission;
  if (kHasHeat && volumes[i].heat_per_value > 0.0)
    sum.emission +=
        volumes[i].look.extinction * volume_glow(i, matrix_of(volumes[i].world_from_voxel) * vec4(p_voxel, 1.0));
  if (kHasMasks && volumes[i].color_kind >= kColorsMasks) {
    const BrickAt brick = volume_brick(volumes[i].bricks, p_voxel);
    if (brick.slot == kNoSlot) return;
    const vec3 corner = atlas_corner(volumes[i].color_bricks, brick.slot);
    const vec3 uvw = (corner + p_voxel - brick.low) * volumes[i].color_bricks.atlas_texel;
    sum.emission += matrix_of(volume_effects[i].tints) * masks_at(i, uvw);
  }
}

void main() {
  const uint i = params.volume;
  const vec3 size = (volumes[i].bounds_max - volumes[i].bounds_min) / float(kGlowEdge);
  const vec3 low = volumes[i].bounds_min + vec3(gl_GlobalInvocationID) * size;
  const uvec3 points = uvec3(clamp(ceil(0.5 * size), vec3(1.0), vec3(kMostPoints)));
  CellSum sum = CellSum(vec3(0.0), vec3(0.0), 0.0);
  for (uint z = 0u; z < points.z; ++z)
    for (uint y = 0u; y < points.y; ++y)
      for (uint x = 0u; x < points.x; ++x)
        add_point(i, low + (vec3(x, y, z) + 0.5) / vec3(points) * size, 0.5 * size / vec3(points), sum);
  const float count = float(points.x * points.y * points.z);
  const vec3 albedo = sum.extinction > 0.0 ? sum.scattering / sum.extinction : vec3(0.0);
  imageStore(matter_target, ivec3(gl_GlobalInvocationID),
             min(vec4(sum.emission, sum.extinction) / count, vec4(kMostHalf)));
  imageStore(albedo_target, ivec3(gl_GlobalInvocationID), vec4(albedo, 1.0));
}
