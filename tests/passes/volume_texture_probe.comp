// Values of a 3D texture at given points, filtered by the device.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "probes.h"
#include "volume_projection_probe.h"

layout(local_size_x = 64) in;
layout(binding = kBindProbeIn2) uniform sampler3D volume;
layout(scalar, binding = kBindProbeIn) readonly buffer Outcomes { ProjectionOutcome outcomes[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Values { vec4 values[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < uint(outcomes.length())) values[i] = textureLod(volume, outcomes[i].trilinear_uvw, 0.0);
}
