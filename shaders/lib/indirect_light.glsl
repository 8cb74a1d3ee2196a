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

bool is_free_cell(ivec3 cell) {
  return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, frame.indirect.size)) &&
         texelFetch(indirect_cube, cell, 0).a > 0.5;
}

/// Whether the surface in a cell goes on over the next two.
bool goes_on(ivec3 cell, ivec3 step) { return !is_free_cell(cell + step) && !is_free_cell(cell + 2 * step); }

/// The place off a surface at which its light is read. In a solid cell, where other surfaces begin, it moves half a
/// cell to where this one goes on: the far half of a thin wall would show the light of the next room.
vec3 off_corners(vec3 p_cells, vec3 normal) {
  const ivec3 cell = ivec3(floor(p_cells)), behind = ivec3(floor(p_cells - normal));
  if (is_free_cell(cell)) return p_cells;
  ivec3 towards = ivec3(0);
  for (int axis = 0; axis < 3; ++axis) {
    if (abs(normal[axis]) > 0.7) continue;
    ivec3 step = ivec3(0);
    step[axis] = 1;
    const bool up = goes_on(behind, step), down = goes_on(behind, -step);
    // On both sides, as in a house of several floors: to the nearer one that is free.
    const int nearer = p_cells[axis] < float(cell[axis]) + 0.5 ? -1 : 1;
    if (up != down) towards[axis] = up ? 1 : -1;
    else if (up && is_free_cell(cell + nearer * step)) towards[axis] = nearer;
    else if (up && is_free_cell(cell - nearer * step)) towards[axis] = -nearer;
  }
  if (towards == ivec3(0) || !is_free_cell(cell + towards)) return p_cells;
  return mix(p_cells, vec3(cell) + 0.5 + 0.5 * vec3(towards), notEqual(towards, ivec3(0)));
}

/// Irradiance / pi on a surface. Interpolates free cells only, so that no light leaks through walls.
vec3 indirect_irradiance(vec3 p_world, vec3 normal) {
  // A cell off the surface, outside of the cells that it runs through.
  const vec3 p = off_corners(indirect_from_world(p_world) + normal, normal);
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
