// Paints the voxels of a tank with the spheres that they lie in, and finds the ids of the spheres that touch them:
// one workgroup per brick, whose spheres it tries.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/tank.h"

layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
layout(scalar, binding = kBindSpheres) readonly buffer Spheres { vec4 spheres[]; };
layout(scalar, binding = kBindSphereColors) readonly buffer SphereColors { uint sphere_colors[]; };
layout(scalar, binding = kBindSphereBricks) readonly buffer SphereBricks { SphereBrick sphere_bricks[]; };
layout(scalar, binding = kBindSphereList) readonly buffer SphereList { uint sphere_list[]; };
layout(binding = kBindVoxelColors, r32ui) uniform writeonly uimage3D voxel_colors;
layout(binding = kBindVoxelIds, rg32ui) uniform writeonly uimage3D voxel_ids;
layout(binding = kBindWideVoxelIds, rgba32ui) uniform writeonly uimage3D wide_voxel_ids;
layout(push_constant, scalar) uniform Params { SphereVoxelsParams params; };

layout(constant_id = 0) const bool kWideIds = false;

/// Spheres that a workgroup tries at a time.
const uint kChunk = 64u;
shared vec4 chunk_spheres[kChunk];
shared uint chunk_ids[kChunk];

struct Voxel {
  NearestIds nearest;
  uint color;
};

void try_sphere(inout Voxel voxel, ivec3 cell, vec4 sphere, uint id) {
  const float power = sphere_power(sphere, voxel_middle(cell));
  if (power < 0.0 && params.painted != 0u && voxel.color == 0u) voxel.color = sphere_colors[id - 1u];
  if (params.has_ids != 0u && sphere_touches_voxel(sphere, cell))
    voxel.nearest = nearest_add(voxel.nearest, id, power);
}

void write_voxel(Voxel voxel, ivec3 cell) {
  if (any(greaterThanEqual(cell, params.size))) return;
  if (params.painted != 0u) imageStore(voxel_colors, cell, uvec4(voxel.color));
  if (params.has_ids == 0u) return;
  const uvec4 ids = ids_to_store(voxel.nearest);
  if (kWideIds)
    imageStore(wide_voxel_ids, cell, ids);
  else
    imageStore(voxel_ids, cell, uvec4(pack_short_ids(ids), 0u, 0u));
}

void main() {
  const ivec3 bricks = (params.size + (kSphereBrick - 1)) / kSphereBrick, at = ivec3(gl_WorkGroupID);
  const SphereBrick brick = sphere_bricks[(at.z * bricks.y + at.y) * bricks.x + at.x];
  const ivec3 near_cell = at * kSphereBrick + ivec3(gl_LocalInvocationID), far_cell = near_cell + ivec3(0, 0, 4);
  Voxel near_voxel = Voxel(nearest_none(), 0u), far_voxel = near_voxel;

  for (uint done = 0u; done < brick.count; done += kChunk) {
    const uint count = min(kChunk, brick.count - done);
    if (gl_LocalInvocationIndex < count) {
      const uint index = sphere_list[brick.first + done + gl_LocalInvocationIndex];
      chunk_spheres[gl_LocalInvocationIndex] = spheres[index];
      chunk_ids[gl_LocalInvocationIndex] = index + 1u;
    }
    barrier();
    for (uint i = 0u; i < count; ++i) {
      try_sphere(near_voxel, near_cell, chunk_spheres[i], chunk_ids[i]);
      try_sphere(far_voxel, far_cell, chunk_spheres[i], chunk_ids[i]);
    }
    barrier();
  }
  write_voxel(near_voxel, near_cell);
  write_voxel(far_voxel, far_cell);
}
