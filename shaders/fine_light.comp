// In-scatter at the texels of the fine pages (shared/fine_light.h): interpolated between the texels of the smoke, times
// the shadows of the noise around each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
#include "lib/boundary_cells.glsl"
#include "lib/bricks.glsl"
#include "lib/erosion.glsl"
#include "lib/noise_tile.glsl"
#include "shared/fine_light.h"
#include "shared/light_side.h"

layout(scalar, binding = kBindSlotBricks) readonly buffer SlotBricks { PackedIvec3 slot_bricks[]; };
layout(scalar, binding = kBindFineSlots) readonly buffer Slots { uint slots[]; };
layout(binding = kBindDensityDisplacement) uniform sampler3D density_displacement_atlas;
layout(binding = kBindInscatter) uniform sampler3D inscatter_atlas;
layout(binding = kBindLightSide) uniform sampler3D light_side_atlas;
layout(binding = kBindFineLight, rgba16f) uniform writeonly image3D fine_light;

/// So far beyond its voxels the texels of a brick reach, less the resolution of the texture unit [voxels].
const float kInside = 0.5 - 1.0 / 64.0;

/// A point of a brick.
struct BrickPoint {
  vec3 p_world, local_voxel;
  vec3 corner;  // of the brick in the atlas [texels]
};

/// Density and displacement of the noise at an offset from a point [voxels]. Beyond the texels of the brick, as at
/// their border; not on it, where rounding would meet other bricks.
vec4 texel_at(BrickPoint here, vec3 offset) {
  const vec3 local = clamp(here.local_voxel + offset, vec3(-kInside), vec3(float(kBrickVoxels) + kInside));
  return textureLod(density_displacement_atlas, (here.corner + local) * frame.smoke.bricks.atlas_texel, 0.0);
}

/// Density before erosion at a point that a surface may run beside.
float density_at(BrickPoint here, uint slot) {
  const float density = texel_at(here, vec3(0.0)).r;
  if (density >= 0.0) return density;
  return max(boundary_sample(slot, here.local_voxel).density, 0.0);
}

/// Optical depth from a point towards the light, over the path of shared/light_side.h, without holes.
float depth_towards(BrickPoint here, float density, vec3 towards) {
  float sum = 0.0;
  for (uint i = 0u; i < kSideSamples; ++i) {
    const vec3 offset = towards * side_sample(i);
    const vec4 texel = texel_at(here, offset);
    const vec3 p_world = here.p_world + offset * frame.smoke.voxel_size;
    const vec4 noise = smoke_noise(noise_tile, frame.look, p_world + texel.gba, frame.time);
    sum += effective_erode(frame.look, texel.r < 0.0 ? density : texel.r, noise);
  }
  return sum * side_depth(frame.look.extinction, frame.smoke.voxel_size);
}

vec3 light_at(BrickPoint here, uint slot, vec4 inscatter) {
  const vec4 side = textureLod(light_side_atlas, (here.corner + here.local_voxel) * frame.smoke.bricks.atlas_texel,
                               0.0) / inscatter.a;
  const float fraction = length(side.xyz);
  const vec3 light = inscatter.rgb / inscatter.a;
  if (fraction < kLeastSide) return light;
  const float depth = depth_towards(here, density_at(here, slot), side.xyz / fraction);
  return light * exp(fraction * (side.a - depth));
}

void main() {
  // Groups of the page, one behind the other along x.
  const uint groups = uint(kFinePageTexels + 3) / 4u;
  const ivec3 texel = ivec3(uvec3(gl_WorkGroupID.x % groups, gl_WorkGroupID.x / groups, gl_WorkGroupID.y) * 4u +
                            gl_LocalInvocationID);
  if (any(greaterThanEqual(texel, ivec3(kFinePageTexels)))) return;
  const uint page = gl_WorkGroupID.z, slot = slots[page];
  BrickPoint here;
  here.local_voxel = fine_texel_position(texel);
  here.corner = atlas_corner(frame.smoke.bricks, slot);
  here.p_world = frame.smoke.origin_world +
                 (vec3(unpacked(slot_bricks[slot]) * kBrickVoxels) + here.local_voxel) * frame.smoke.voxel_size;
  const vec4 inscatter =
      textureLod(inscatter_atlas, (here.corner + here.local_voxel) * frame.smoke.bricks.atlas_texel, 0.0);
  // What the interpolation of eight bits of weight may leave of nothing.
  const bool known = inscatter.a > 1.0 / 128.0;
  imageStore(fine_light, fine_page_corner(page) + texel,
             known ? vec4(light_at(here, slot, inscatter), 1.0) : vec4(0.0));
}
