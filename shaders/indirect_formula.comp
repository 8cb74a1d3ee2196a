// What the formula of shared/scattering.h takes for light that is scattered more than once, in each cell. Cells know
// better where beams are narrow or walls hide a light; the formula knows better what happens within a cell. So media
// have the light of the cells, less this, plus the formula at the point itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/indirect_lights.glsl"
#include "shared/scattering.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(binding = kBindIndirectTarget, rgba16f) uniform image3D target;

/// Mean of exp(-k depth) over the part of a ray in its own cell, of extinction * k.
vec3 out_of_cell(vec3 extinction) {
  return vec3(out_of_cell(extinction.x), out_of_cell(extinction.y), out_of_cell(extinction.z));
}

void main() {
  const ivec3 cell = params.media_low + ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(cell, params.media_high))) return;
  const vec4 matter = texelFetch(medium_matter, cell, 0);
  const vec4 around = imageLoad(target, cell + ivec3(0, 0, int(kEscapeSlab) * frame.indirect.size.z));
  if (around.a < 0.5 || matter.a <= 0.0) return;
  // Of the medium itself, which the cells replace by a similar one.
  const float similar = 1.0 - params.g * dot(params.albedo, vec3(1.0 / 3.0));
  const ManyScatterings many = multiple_scattering(many_fit(), params.albedo, params.g, pow(around.r, 1.0 / similar));
  const vec3 decay = many.decay / similar;
  const vec3 p_world = frame.indirect.origin_world + (vec3(cell) + 0.5) * frame.indirect.cell_size;
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < params.light_count; ++i) {
    const Incident incident = light_at(lights[i], p_world);
    if (max(incident.irradiance.r, max(incident.irradiance.g, incident.irradiance.b)) < kLeastIrradiance) continue;
    const float lit = light_visibility(lights[i], p_world);
    if (lit <= 0.0) continue;
    const float depth = medium_depth(p_world, incident.to_light, incident.distance, 0.5);
    sum += incident.irradiance * (lit * many.fraction * out_of_cell(decay * matter.a) * exp(-decay * depth));
  }
  imageStore(target, cell + ivec3(0, 0, int(kFormulaSlab) * frame.indirect.size.z),
             vec4(sum * (0.25 / 3.14159265), 1.0));
}
