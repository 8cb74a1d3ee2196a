// Traces given rays through a tank: two vec4 a ray in (origin and largest t; direction and the id that is skipped),
// t and id out.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/sphere_trace.glsl"

#include "probes.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Rays { vec4 rays[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Hits { vec2 hits[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (2u * i >= uint(rays.length())) return;
  const vec4 from = rays[2u * i], to = rays[2u * i + 1u];
  SphereRay ray = SphereRay(from.xyz, to.xyz, uint(to.w), i, false, from.w, 0u);
  trace_spheres(ray);
  hits[i] = vec2(ray.t, float(ray.id));
}
