// Light of the lights in each cell of smoke, the mean over all directions.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/indirect_lights.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(binding = kBindIndirectTarget, rgba16f) uniform writeonly image3D target;

/// Light at a point of a cell of a medium.
vec3 light_in_medium(Light light, vec3 p_world, float extinction) {
  const Incident incident = light_at(light, p_world);
  if (max(incident.irradiance.r, max(incident.irradiance.g, incident.irradiance.b)) < kLeastIrradiance)
    return vec3(0.0);
  const float lit = light_visibility(light, p_world);
  if (lit <= 0.0) return vec3(0.0);
  // Its own cell, and from its border on.
  const float depth = medium_depth(p_world, incident.to_light, incident.distance, 0.5);
  return incident.irradiance * (lit * out_of_cell(extinction) * exp(-depth));
}

/// The mean over a cell: by 8 points near a light and 64 next to it, around which it grows beyond all bounds.
vec3 light_in_cell(Light light, vec3 p_world, float extinction) {
  const float cell = frame.indirect.cell_size;
  const float cells = light.kind == kLightDirectional ? 1e9 : distance(light.position_world, p_world) / cell;
  if (cells > 2.0) return light_in_medium(light, p_world, extinction);
  const int edge = cells < 1.0 ? 4 : 2;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < edge * edge * edge; ++i) {
    const vec3 at = (vec3(i % edge, i / edge % edge, i / (edge * edge)) + 0.5) / float(edge) - 0.5;
    sum += light_in_medium(light, p_world + at * cell, extinction);
  }
  return sum / float(edge * edge * edge);
}

void main() {
  const ivec3 cell = params.media_low + ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(cell, params.media_high))) return;
  const float extinction = texelFetch(medium_matter, cell, 0).a;
  vec3 sum = vec3(0.0);
  if (extinction > 0.0) {
    const vec3 p_world = frame.indirect.origin_world + (vec3(cell) + 0.5) * frame.indirect.cell_size;
    for (uint i = 0u; i < params.light_count; ++i) sum += light_in_cell(lights[i], p_world, extinction);
  }
  imageStore(target, cell, vec4(sum * (0.25 / 3.14159265), extinction));
}
