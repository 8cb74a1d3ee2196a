// Irradiance of each patch by the lights.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/indirect_lights.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindSurfacePatches) readonly buffer Patches { SurfacePatch patches[]; };
layout(scalar, binding = kBindPatchIrradiance) writeonly buffer Irradiance { vec3 irradiance[]; };

void main() {
  const uint at = gl_GlobalInvocationID.x;
  if (at >= params.patch_count) return;
  const SurfacePatch surface = patches[at];
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < params.light_count; ++i) {
    const Incident incident = light_at(lights[i], surface.position_world);
    const float cosine = dot(incident.to_light, surface.normal);
    if (cosine <= 0.0 || max(incident.irradiance.r, max(incident.irradiance.g, incident.irradiance.b)) <= 0.0) continue;
    // Against self-shadowing, as in shade.comp.
    const vec3 off = surface.position_world + (0.01 + 0.006 * min(incident.distance, 10.0)) * surface.normal;
    const float lit = light_visibility(lights[i], off);
    if (lit <= 0.0) continue;
    sum += incident.irradiance * (cosine * lit * exp(-medium_depth(indirect_from_world(off), incident.to_light,
                                                                incident.distance / frame.indirect.cell_size)));
  }
  irradiance[at] = sum / 3.14159265;
}
