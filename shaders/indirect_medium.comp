// The media in each cell: the mean of the smoke's voxels, eroded by the noise on average and cut by holes, and of
// points in volumes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/indirect_cells.glsl"
#include "lib/bricks.glsl"
#include "lib/cell_holes.glsl"
#include "lib/erosion.glsl"
#include "lib/low_discrepancy.glsl"
#include "shared/media.h"
#include "shared/noise.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(constant_id = 0) const uint kMedia = kMediumSmoke;
layout(binding = kBindDensity) uniform sampler3D density_atlas;
layout(binding = kBindNoiseTile) uniform sampler3D noise_tile;
layout(binding = kBindIndirectTarget, rgba16f) uniform writeonly image3D target;
layout(scalar, push_constant) uniform Push { IndirectParams params; };
#include "lib/volume_transfer.glsl"

/// Density after erosion: that of even smoke that lets as much light through as the noise does on average. Its noise is
/// that of places spread over the tile.
float eroded(float density) {
  if (density <= 0.0 || frame.look.erosion <= 0.0) return density;
  vec4 remaining[2];
  for (int i = 0; i < 8; ++i) {
    const vec3 place = lattice_point(uint(i), vec3(0.5));
    const vec4 noise = textureLod(noise_tile, place, 0.0);
    remaining[i >> 2][i & 3] = effective_erode(frame.look, density, noise);
  }
  // Along half a billow (shared/noise_functions.h) the noise hardly changes.
  const float k = frame.look.extinction * 0.125 / frame.look.noise_frequency;
  return effective_density(vec2(effective_density(remaining[0], k), effective_density(remaining[1], k)).xyxy, k);
}

/// Mean fraction of the density of a voxel of a brick that the holes leave.
float remaining_in_voxel(uint slot, ivec3 local) {
  if (frame.holes.count == 0u || hole_cells[slot] == 0u) return 1.0;
  float sum = 0.0;
  for (int i = 0; i < 8; ++i)
    sum += remaining_in_cell(slot, vec3(local) + 0.25 + 0.5 * vec3(i & 1, i >> 1 & 1, i >> 2));
  return sum / 8.0;
}

float density_at(ivec3 voxel) {
  const ivec3 brick = voxel >> 3;
  int empty_edge;
  const uint slot = slot_at(frame.volume.bricks, brick, empty_edge);
  if (slot == kNoSlot) return 0.0;
  const ivec3 local = voxel - brick * kBrickVoxels;
  const vec3 at = atlas_corner(frame.volume.bricks, slot) + vec3(local) + 0.5;
  const float density = textureLod(density_atlas, at * frame.volume.bricks.atlas_texel, 0.0).r;
  return eroded(density) * remaining_in_voxel(slot, local);
}

/// Scattering coefficient and extinction of a medium, as of a similar one that scatters evenly.
vec4 similar(float extinction, vec3 albedo, float g) {
  const float mean = dot(albedo, vec3(1.0 / 3.0));
  return extinction * vec4(albedo * (1.0 - g), 1.0 - mean * g);
}

vec4 smoke_in(ivec3 cell) {
  const int edge = int(frame.indirect.cell_size / frame.volume.voxel_size + 0.5);
  float sum = 0.0;
  for (int i = 0; i < edge * edge * edge; ++i)
    sum += density_at(cell * edge + ivec3(i % edge, i / edge % edge, i / (edge * edge)));
  return similar(sum / float(edge * edge * edge) * frame.look.extinction,
                 frame.look.albedo * frame.look.multiple_scattering, mean_cosine(frame.look.phase));
}

/// The mean of 4^3 points.
vec4 volumes_in(ivec3 cell) {
  vec4 sum = vec4(0.0);
  for (uint v = 0u; v < frame.media.caster_count; ++v) {
    const VolumeLook look = volumes[v].look;
    for (int i = 0; i < 64; ++i) {
      const vec3 at = (vec3(cell) + (vec3(i & 3, i >> 2 & 3, i >> 4) + 0.5) / 4.0) * frame.indirect.cell_size;
      const vec3 p = volumes[v].voxel_from_world * vec4(frame.indirect.origin_world + at, 1.0);
      if (any(lessThan(p, volumes[v].bounds_min)) || any(greaterThan(p, volumes[v].bounds_max))) continue;
      const VolumeMatter matter = matter_around(volumes[v], v, p, vec3(0.125));
      sum += similar(matter.density * look.extinction / 64.0, matter.albedo * look.multiple_scattering,
                     look.anisotropy);
    }
  }
  return sum;
}

void main() {
  const ivec3 cell = params.media_low + ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(cell, params.media_high))) return;
  vec4 matter = vec4(0.0);
  if ((kMedia & kMediumSmoke) != 0u) matter += smoke_in(cell);
  if ((kMedia & kMediumVolumes) != 0u) matter += volumes_in(cell);
  imageStore(target, cell, matter);
}
