// Light of what glows in a volume that has been scattered before: a step of successive over-relaxation of the diffusion
// equation on every other cell (shared/glow_field.h).
//
// Of the mean radiance J: div(D grad J) - (extinction - scattering) J + scattering J0 = 0, J0 that which arrives
// straight, with D = 1 / (3 extinction'), extinction' = extinction - g scattering. At the borders nothing arrives, and
// what leaves is J / 2 (Marshak). As the matter ends before the cells do, the flux is limited to that everywhere: D is
// the inverse of the root of (3 extinction')^2 + (2 |grad J| / J)^2 (after Levermore and Pomraning 1981, "A
// flux-limited diffusion theory").
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/glow_field.h"
#include "shared/volume.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = kBindVolumes) uniform Volumes { VolumeInstance volumes[kMaxVolumes]; };
layout(binding = kBindGlowMatter) uniform sampler3D matter;
layout(binding = kBindGlowAlbedo) uniform sampler3D albedo;
layout(binding = kBindGlowField) uniform sampler3D field;
layout(scalar, binding = kBindGlowState) buffer State { vec3 state[]; };
layout(scalar, push_constant) uniform Push { GlowFieldParams params; };

/// Of a cube with N cells an edge the best is 2 / (1 + sin(pi / N)), for light that is not absorbed.
const float kRelaxations[kGlowLevels] = float[kGlowLevels](1.8, 1.67, 1.45);

int edge() { return int(kGlowEdge >> params.level); }

uint index_of(ivec3 cell) {
  return first_glow_cell(params.level) + uint(cell.x + edge() * (cell.y + edge() * cell.z));
}

/// The mean over a cell of the level, of a cube that begins at a texel.
vec4 mean_in(sampler3D cubes, ivec3 first, ivec3 cell) {
  if (params.level == 0u) return texelFetch(cubes, first + cell, 0);
  // A sample between eight texels is their mean.
  const int pairs = 1 << (params.level - 1u);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < pairs * pairs * pairs; ++i) {
    const ivec3 pair = pairs * cell + ivec3(i % pairs, i / pairs % pairs, i / (pairs * pairs));
    sum += textureLod(cubes, vec3(first + 2 * pair + 1) / vec3(textureSize(cubes, 0)), 0.0);
  }
  return sum / float(pairs * pairs * pairs);
}

/// What light meets in a cell.
struct CellMatter {
  float extinction;  // [1/m]
  vec3 scattering;
  vec3 transport;  // extinction for diffusing light
};

CellMatter matter_in(ivec3 cell, float g) {
  const float extinction = mean_in(matter, ivec3(0), cell).a;
  const vec3 scattering = extinction * mean_in(albedo, ivec3(0), cell).rgb;
  return CellMatter(extinction, scattering, extinction - g * scattering);
}

/// How much of the difference to its neighbour flows into a cell [1/m], whose centre is h metres away.
vec3 conductance(ivec3 neighbour, vec3 here, vec3 transport, float g, float h) {
  const vec3 there = state[index_of(neighbour)];
  const vec3 both = 0.5 * (transport + matter_in(neighbour, g).transport);
  const vec3 slope = 2.0 * abs(there - here) / (h * max(there + here, 1e-9));
  return inversesqrt(9.0 * both * both + 4.0 * slope * slope + 1e-12) / (h * h);
}

void main() {
  const uvec3 at = gl_GlobalInvocationID;
  const ivec3 cell = ivec3(2u * at.x + ((at.y + at.z + params.parity) & 1u), at.yz);
  if (any(greaterThanEqual(cell, ivec3(edge())))) return;
  const VolumeInstance volume = volumes[params.volume];
  const vec3 cell_voxels = (volume.bounds_max - volume.bounds_min) / float(edge());
  const float g = volume.look.anisotropy;
  const CellMatter own = matter_in(cell, g);
  const vec3 here = state[index_of(cell)];
  vec3 flows = own.extinction - own.scattering;
  vec3 arriving = own.scattering * mean_in(field, ivec3(0, 0, params.volume * kGlowEdge), cell).rgb;
  for (int axis = 0; axis < 3; ++axis) {
    const float h = length(volume.world_from_voxel[axis]) * cell_voxels[axis];
    for (int side = -1; side <= 1; side += 2) {
      ivec3 neighbour = cell;
      neighbour[axis] += side;
      if (neighbour[axis] < 0 || neighbour[axis] >= edge()) {
        flows += 1.0 / (h * (1.5 * own.transport * h + 2.0));
      } else {
        const vec3 c = conductance(neighbour, here, own.transport, g, h);
        flows += c;
        arriving += c * state[index_of(neighbour)];
      }
    }
  }
  const vec3 solved = arriving / max(flows, 1e-12);
  state[index_of(cell)] = max(here + kRelaxations[params.level] * (solved - here), vec3(0.0));
}
