// What points of spheres gather of photons.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/photon_gather.glsl"

#include "probes.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Points { PhotonQuery queries[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Sums { PackedVec3 sums[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(queries.length())) return;
  const PhotonQuery query = queries[i];
  sums[i] = packed_of(gather_photons(query.grid, query.at, query.id, query.sphere, query.extinction));
}
