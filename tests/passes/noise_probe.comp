// Evaluates each kind of noise at given points: ten values a point.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/noise_functions.h"

#include "probes.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Points { PackedVec3 points[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Values { float values[]; };
layout(scalar, push_constant) uniform Push { int cells; uint seed; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(points.length())) return;
  const vec3 p = unpacked(points[i]);
  const vec4 gradient = perlin(p, cells, seed);
  const vec3 curl = curl_noise(p, cells, seed);
  const float all[10] =
      float[10](worley(p, cells, seed), gradient.w, gradient.x, gradient.y, gradient.z, curl.x, curl.y, curl.z,
                perlin_worley(p, cells, 2u, seed), threads(p, cells, 2u, seed));
  for (uint k = 0u; k < 10u; ++k) values[10u * i + k] = all[k];
}
