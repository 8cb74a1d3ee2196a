// Points of a lens, by the remap or by rejection: what each costs.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "bench/lens_points.h"
#include "shared/optics.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindLensSums) writeonly buffer Sums { vec2 sums[]; };
layout(push_constant, scalar) uniform Params { LensPointsParams params; };

layout(constant_id = 0) const bool kRejects = false;

void main() {
  const uint thread = gl_GlobalInvocationID.x;
  vec2 sum = vec2(0.0);
  for (uint i = 0u; i < params.points; ++i) {
    if (kRejects)
      sum += lens_point_by_rejection(params.blades, uvec3(thread, i, 0u));
    else
      sum += lens_point(params.blades, hash3(uvec3(thread, i, 0u)).xy);
  }
  sums[thread] = sum;
}
