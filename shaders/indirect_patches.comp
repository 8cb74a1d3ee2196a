// Irradiance of each patch by the lights.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/indirect_lights.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindSurfacePatches) readonly buffer Patches { SurfacePatch patches[]; };
layout(scalar, binding = kBindPatchIrradiance) writeonly buffer Irradiance { PackedVec3 irradiance[]; };

void main() {
  const uint at = gl_GlobalInvocationID.x;
  if (at >= params.patch_count) return;
  const vec3 position_world = unpacked(patches[at].position_world), normal = unpacked(patches[at].normal);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < params.light_count; ++i) {
    const Incident incident = light_at(lights[i], position_world);
    const float cosine = dot(incident.to_light, normal);
    if (cosine <= 0.0 || max(incident.irradiance.r, max(incident.irradiance.g, incident.irradiance.b)) <= 0.0) continue;
    // Against self-shadowing, as in shade.comp.
    const vec3 off = position_world + (0.01 + 0.006 * min(incident.distance, 10.0)) * normal;
    const float lit = light_visibility(lights[i], off);
    if (lit <= 0.0) continue;
    sum += incident.irradiance * (cosine * lit * exp(-medium_depth(indirect_from_world(off), incident.to_light,
                                                                incident.distance / frame.indirect.cell_size)));
  }
  irradiance[at] = packed_of(sum / 3.14159265);
}
