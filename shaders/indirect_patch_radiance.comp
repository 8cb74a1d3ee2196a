// Radiance that leaves each patch: of the lights, of other patches and of the smoke.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/indirect_light.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindSurfacePatches) readonly buffer Patches { SurfacePatch patches[]; };
layout(scalar, binding = kBindPatchIrradiance) readonly buffer Irradiance { PackedVec3 irradiance[]; };
layout(scalar, binding = kBindPatchRadiance) writeonly buffer Radiance { PackedVec3 radiance[]; };
layout(scalar, push_constant) uniform Push { IndirectParams params; };

void main() {
  const uint at = gl_GlobalInvocationID.x;
  if (at >= params.patch_count) return;
  const SurfacePatch surface = patches[at];
  const vec3 indirect = indirect_irradiance(unpacked(surface.position_world), unpacked(surface.normal));
  radiance[at] =
      packed_of(unpacked(surface.albedo) * (unpacked(irradiance[at]) + indirect) + unpacked(surface.emission));
}
