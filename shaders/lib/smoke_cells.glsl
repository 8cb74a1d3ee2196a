// The smoke in the cells of indirect light: the mean of its voxels, eroded by the noise on average and cut by holes.
#ifndef SMOKE_CELLS_GLSL
#define SMOKE_CELLS_GLSL
#include "lib/bricks.glsl"
#include "lib/cell_holes.glsl"
#include "lib/erosion.glsl"
#include "lib/indirect_cells.glsl"
#include "lib/low_discrepancy.glsl"
#include "lib/noise_tile.glsl"

layout(binding = kBindDensity) uniform sampler3D density_atlas;

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
  const uint slot = slot_at(frame.smoke.bricks, brick, empty_edge);
  if (slot == kNoSlot) return 0.0;
  const ivec3 local = voxel - brick * kBrickVoxels;
  const vec3 at = atlas_corner(frame.smoke.bricks, slot) + vec3(local) + 0.5;
  const float density = textureLod(density_atlas, at * frame.smoke.bricks.atlas_texel, 0.0).r;
  return eroded(density) * remaining_in_voxel(slot, local);
}

/// As media_in_cell.
vec4 smoke_in_cell(ivec3 cell) {
  const int edge = int(frame.indirect.cell_size / frame.smoke.voxel_size + 0.5);
  float sum = 0.0;
  for (int i = 0; i < edge * edge * edge; ++i)
    sum += density_at(cell * edge + ivec3(i % edge, i / edge % edge, i / (edge * edge)));
  return evenly_scattering(sum / float(edge * edge * edge) * frame.look.extinction,
                 frame.look.albedo * frame.look.multiple_scattering, mean_cosine(frame.look.phase));
}

#endif
