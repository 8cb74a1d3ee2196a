// Averages what diffusing light meets over 2^3 cells of the finer level (shared/glow_field.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/glow_field.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = kBindGlowCells) buffer Cells { GlowCell cells[]; };
layout(scalar, push_constant) uniform Push { GlowFieldParams params; };

void main() {
  const uint edge = kGlowEdge >> params.level, fine_edge = 2u * edge;
  const uvec3 cell = gl_GlobalInvocationID;
  if (any(greaterThanEqual(cell, uvec3(edge)))) return;
  vec3 transport = vec3(0.0), absorption = vec3(0.0), source = vec3(0.0);
  for (uint corner = 0u; corner < 8u; ++corner) {
    const uvec3 fine = 2u * cell + uvec3(corner & 1u, corner >> 1u & 1u, corner >> 2u);
    const GlowCell here =
        cells[first_glow_cell(params.level - 1u) + fine.x + fine_edge * (fine.y + fine_edge * fine.z)];
    transport += unpacked(here.transport) / 8.0;
    absorption += unpacked(here.absorption) / 8.0;
    source += unpacked(here.source) / 8.0;
  }
  cells[first_glow_cell(params.level) + cell.x + edge * (cell.y + edge * cell.z)] =
      GlowCell(packed_of(transport), packed_of(absorption), packed_of(source));
}
