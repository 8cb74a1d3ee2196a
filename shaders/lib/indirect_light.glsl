// Indirect light at a point (shared/indirect_light.h).
#ifndef INDIRECT_LIGHT_GLSL
#define INDIRECT_LIGHT_GLSL
#include "lib/indirect_cells.glsl"
#include "shared/scattering.h"
#include "shared/sky_light.h"

layout(binding = kBindIndirectCube) uniform sampler3D indirect_cube;

/// A slab at a point: premultiplied, and in alpha how much of the cells around it is free.
vec4 indirect_slab(vec3 p_cells, uint slab) {
  const vec3 size = vec3(frame.indirect.size), inside = clamp(p_cells, vec3(0.5), size - 0.5);
  const vec3 at = vec3(inside.xy, inside.z + float(slab) * size.z);
  return textureLod(indirect_cube, at / vec3(size.xy, float(kIndirectSlabs) * size.z), 0.0);
}

/// 0 in the cells. Outside, what a place has of the nearest cell's light, less than 1 by this, falls with the third
/// power of the distance from the middle, as the light of a source above ground does on it.
float outside_of_cells(vec3 p_cells) {
  const vec3 size = vec3(frame.indirect.size), middle = 0.5 * size, inside = clamp(p_cells, vec3(0.0), size);
  const float ratio = distance(inside, middle) / max(distance(p_cells, middle), 1e-6);
  return 1.0 - min(ratio * ratio * ratio, 1.0);
}

/// Irradiance / pi on a surface. Interpolates free cells only, so that no light leaks through walls.
vec3 indirect_irradiance(vec3 p_world, vec3 normal) {
  // A cell off the surface, outside of the cells that it runs through.
  const vec3 p = indirect_from_world(p_world) + normal;
  const vec3 weights = normal * normal;
  vec4 sum = vec4(0.0);
  for (uint axis = 0u; axis < 3u; ++axis)
    sum += weights[axis] * indirect_slab(p, 2u * axis + (normal[axis] < 0.0 ? 1u : 0u));
  const vec3 inside = sum.rgb / max(sum.a, 1e-3);
  return mix(inside, frame.sky.ambient * (0.75 + 0.25 * normal.y), outside_of_cells(p));
}

/// Light from all directions, to the first order: L(d) = mean + dot(d, slope), a column a channel.
struct IndirectField {
  vec3 mean;
  mat3 slope;
};

IndirectField indirect_field(vec3 p_world) {
  const vec3 p = indirect_from_world(p_world);
  IndirectField field;
  vec4 sum = vec4(0.0);
  vec3 slopes[3];
  for (uint axis = 0u; axis < 3u; ++axis) {
    const vec4 ahead = indirect_slab(p, 2u * axis), behind = indirect_slab(p, 2u * axis + 1u);
    sum += ahead + behind;
    slopes[axis] = 0.75 * (ahead.rgb - behind.rgb);
  }
  const float free = max(sum.a / 6.0, 1e-3), outside = outside_of_cells(p);
  field.mean = mix(sum.rgb / (6.0 * free), frame.sky.ambient * sky_shape(0.0), outside);
  field.slope = transpose(mat3(slopes[0], slopes[1], slopes[2])) * ((1.0 - outside) / free);
  return field;
}

/// How much brighter a place in a medium is than the cells know, which are coarse. `escape`: mean transmittance out of
/// the medium there, whose phase function has the mean cosine g.
vec3 detail_in_cells(vec3 p_world, vec3 albedo, float g, float weight, float escape) {
  const vec3 p = indirect_from_world(p_world), here = scattered_sky(albedo, weight, g, escape);
  const vec4 slab = indirect_slab(p, kSkySlab);
  if (slab.a <= 0.0) return vec3(1.0);
  return clamp(here / mix(slab.rgb / slab.a, here, outside_of_cells(p)), 0.25, 4.0);
}

/// What the formula of shared/scattering.h takes for light that is scattered more than once, as coarse as the cells.
vec3 formula_in_cells(vec3 p_world) {
  const vec3 p = indirect_from_world(p_world);
  const vec4 slab = indirect_slab(p, kFormulaSlab);
  return slab.a > 0.0 ? slab.rgb / slab.a * (1.0 - outside_of_cells(p)) : vec3(0.0);
}

/// Indirect light at a point of a medium, from that of the cells: the formula's part of it follows the formula at the
/// point, the rest follows `detail` (detail_in_cells).
vec3 refined_by_formula(vec3 of_cells, vec3 formula_of_cells, vec3 formula_here, vec3 detail) {
  const vec3 of_both = min(of_cells, formula_of_cells);
  const vec3 ratio = clamp(formula_here / max(formula_of_cells, 1e-6), 0.25, 4.0);
  return (of_cells - of_both) * detail + of_both * ratio;
}

/// What a phase function of mean cosine g scatters of it towards a direction, unit.
vec3 scattered_field(IndirectField field, float g, vec3 towards) {
  return max(field.mean - g * (towards * field.slope), vec3(0.0));
}

#endif
