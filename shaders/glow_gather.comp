// Mean radiance over all directions of what glows in a volume, that arrives straight, and what diffusing light meets in
// the finest cells (shared/glow_field.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/glow_field.h"
#include "shared/sky_light.h"
#include "shared/volume.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = kBindVolumes) uniform Volumes { VolumeInstance volumes[kMaxVolumes]; };
layout(binding = kBindGlowMatter) uniform sampler3D matter;
layout(binding = kBindGlowAlbedo) uniform sampler3D albedo;
layout(binding = kBindGlowSwept) uniform sampler3D swept;
layout(scalar, binding = kBindGlowCells) writeonly buffer Cells { GlowCell cells[]; };
layout(binding = kBindGlowFieldTarget, rgba16f) uniform writeonly image3D field;
layout(scalar, push_constant) uniform Push { GlowFieldParams params; };

void main() {
  const ivec3 cell = ivec3(gl_GlobalInvocationID);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < kSkyDirections; ++i) sum += texelFetch(swept, cell + ivec3(i * kGlowEdge, 0, 0), 0).rgb;
  imageStore(field, cell + ivec3(0, 0, params.volume * kGlowEdge), vec4(sum, 1.0));
  const float extinction = texelFetch(matter, cell, 0).a;
  const vec3 scattering = extinction * texelFetch(albedo, cell, 0).rgb;
  cells[uint(cell.x) + kGlowEdge * (uint(cell.y) + kGlowEdge * uint(cell.z))] =
      GlowCell(packed_of(extinction - volumes[params.volume].look.anisotropy * scattering),
               packed_of(extinction - scattering), packed_of(scattering * sum));
}
