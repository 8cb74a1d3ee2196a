// Phase functions at given cosines, and those of droplets.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/phase.h"

#include "probes.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Phases { Phase phases[]; };
layout(scalar, binding = kBindProbeIn2) readonly buffer Cosines { float cosines[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Values { float values[]; };
layout(scalar, binding = kBindProbeIn3) readonly buffer Diameters { float diameters[]; };
layout(scalar, binding = kBindProbeOut2) writeonly buffer Droplets { Phase droplets[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < uint(values.length())) {
    values[i] = phase_value(phases[i / uint(cosines.length())], cosines[i % uint(cosines.length())]);
  }
  if (i < uint(diameters.length())) droplets[i] = phase_of_droplet(diameters[i]);
}
