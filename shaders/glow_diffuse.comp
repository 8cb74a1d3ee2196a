// Light of what glows in a volume that has been scattered before: successive over-relaxation of the diffusion
// equation, a step of which is every other cell (shared/glow_field.h).
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

// All cells of one parity of the coarsest level.
layout(local_size_x = 4, local_size_y = 8, local_size_z = 8) in;
layout(scalar, binding = kBindVolumes) uniform Volumes { VolumeInstance volumes[kMaxVolumes]; };
layout(scalar, binding = kBindGlowCells) readonly buffer Cells { GlowCell cells[]; };
layout(scalar, binding = kBindGlowState) coherent buffer State { PackedVec3 state[]; };
layout(scalar, push_constant) uniform Push { GlowFieldParams params; };

/// Of a cube with N cells an edge the best is 2 / (1 + sin(pi / N)), for light that is not absorbed.
const float kRelaxations[kGlowLevels] = float[kGlowLevels](1.8, 1.67, 1.45);

uint index_of(ivec3 cell) {
  const int edge = int(kGlowEdge >> params.level);
  return first_glow_cell(params.level) + uint(cell.x + edge * (cell.y + edge * cell.z));
}

/// How much of the difference to its neighbour flows into a cell [1/m], whose centre is h metres away.
vec3 conductance(vec3 here, vec3 there, vec3 transport, float h) {
  const vec3 slope = 2.0 * abs(there - here) / (h * max(there + here, 1e-9));
  return inversesqrt(9.0 * transport * transport + 4.0 * slope * slope + 1e-12) / (h * h);
}

/// Solves for a cell with edges of these lengths [m].
void solve(ivec3 cell, vec3 lengths) {
  const int edge = int(kGlowEdge >> params.level);
  const GlowCell own = cells[index_of(cell)];
  const vec3 here = unpacked(state[index_of(cell)]), transport = unpacked(own.transport);
  vec3 flows = unpacked(own.absorption), arriving = unpacked(own.source);
  for (int axis = 0; axis < 3; ++axis) {
    const float h = lengths[axis];
    for (int side = -1; side <= 1; side += 2) {
      ivec3 neighbour = cell;
      neighbour[axis] += side;
      if (neighbour[axis] < 0 || neighbour[axis] >= edge) {
        flows += 1.0 / (h * (1.5 * transport * h + 2.0));
      } else {
        const uint at = index_of(neighbour);
        const vec3 there = unpacked(state[at]);
        const vec3 c = conductance(here, there, 0.5 * (transport + unpacked(cells[at].transport)), h);
        flows += c;
        arriving += c * there;
      }
    }
  }
  const vec3 solved = arriving / max(flows, 1e-12);
  state[index_of(cell)] = packed_of(max(here + kRelaxations[params.level] * (solved - here), vec3(0.0)));
}

void main() {
  const uvec3 at = gl_GlobalInvocationID;
  const VolumeInstance volume = volumes[params.volume];
  const vec3 cell_voxels = (volume.bounds_max - volume.bounds_min) / float(kGlowEdge >> params.level);
  const mat4x3 axes = matrix_of(volume.world_from_voxel);
  const vec3 lengths = cell_voxels * vec3(length(axes[0]), length(axes[1]), length(axes[2]));
  for (uint step = 0u; step < params.steps; ++step) {
    solve(ivec3(2u * at.x + ((at.y + at.z + params.parity + step) & 1u), at.yz), lengths);
    memoryBarrierBuffer();
    barrier();
  }
}
