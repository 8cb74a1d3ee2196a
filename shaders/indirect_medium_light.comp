// Light of the lights in each cell of a medium, the mean over all directions; and what the formulas of
// shared/scattering.h find in the cell, on average. Cells know better where beams are narrow or walls hide a light; the
// formulas know better what happens within a cell. So media have the light of the cells, times the formula at the point
// itself, divided by its mean.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/indirect_lights.glsl"
#include "shared/scattering.h"
#include "shared/volume.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindIndirectProbes) readonly buffer Probes { uint probes[]; };
layout(scalar, binding = kBindIndirectHits) readonly buffer Hits { uint hits[]; };
layout(binding = kBindIndirectTarget, rgba16f) uniform writeonly image3D target;
layout(binding = kBindIndirectCubeTarget, rgba16f) uniform writeonly image3D cube;
layout(scalar, binding = kBindVolumes) uniform Volumes { VolumeInstance volumes[kMaxVolumes]; };
#include "lib/glow_field.glsl"

/// Points of a cell: light falls off too fast from its border for the mean to be that of the middle. Along each axis
/// half of them are at each point of the Gauss-Legendre rule.
const uint kPoints = 4u;

/// Relative to the middle of the cell [cells].
vec3 point_of_cell(uint i) { return (vec3(i & 1u, i >> 1u, (i & 1u) ^ (i >> 1u)) - 0.5) * 0.577350269; }

/// What the formula for a light needs at each of the points.
struct Formula {
  vec3 fraction[kPoints];
  vec3 decay;  // per optical depth of the cells
};

/// Mean transmittance out of the media at a place [cells], over all directions.
float escape_at(uint probe, uint phase, vec3 p_cells) {
  float sum = 0.0;
  for (uint i = 0u; i < kProbeRays; ++i)
    sum += exp(-medium_depth(p_cells, probe_direction(i, phase), hit_cells(hits[i * params.probe_count + probe])));
  return sum / float(kProbeRays);
}

/// The albedo of what lies in a cell, of which a similar medium that scatters evenly is known (indirect_medium.comp).
vec3 albedo_in(vec4 matter) {
  const vec3 similar = min(matter.rgb / matter.a, 1.0);
  const float mean = dot(similar, vec3(1.0 / 3.0)), own_mean = mean / (1.0 - params.g + params.g * mean);
  return min(similar * ((1.0 - params.g * own_mean) / (1.0 - params.g)), 1.0);
}

struct Arriving {
  vec3 direct, formula;
};

/// Light at a place [cells], which is at point k of the cell.
Arriving light_at_place(Light light, vec3 p_cells, Formula formula, uint k) {
  const vec3 p_world = world_from_indirect(p_cells);
  const Incident incident = light_at(light, p_world);
  if (is_negligible(light, incident)) return Arriving(vec3(0.0), vec3(0.0));
  const float lit = light_visibility(light, p_world);
  if (lit <= 0.0) return Arriving(vec3(0.0), vec3(0.0));
  const float depth = medium_depth(p_cells, incident.to_light, incident.distance / frame.indirect.cell_size);
  const vec3 arriving = incident.irradiance * lit;
  return Arriving(arriving * exp(-depth), arriving * formula.fraction[k] * exp(-formula.decay * depth));
}

/// The mean over a cell: by the points of the formula, and by 64 next to a light, around which it grows beyond all
/// bounds.
Arriving light_in_cell(Light light, vec3 p_cells, Formula formula) {
  const float cells = light.kind == kLightDirectional
                          ? 1e9
                          : distance(light.position_world, world_from_indirect(p_cells)) / frame.indirect.cell_size;
  const uint points = cells < 1.0 ? 64u : kPoints;
  Arriving sum = Arriving(vec3(0.0), vec3(0.0));
  for (uint i = 0u; i < points; ++i) {
    const vec3 at = points == kPoints ? point_of_cell(i) : (vec3(i & 3u, i >> 2u & 3u, i >> 4u) + 0.5) / 4.0 - 0.5;
    const Arriving here = light_at_place(light, p_cells + at, formula, i % kPoints);
    sum.direct += here.direct / float(points);
    sum.formula += here.formula / float(points);
  }
  return sum;
}

/// The light of volumes in view that glow, in the volumes themselves.
struct OwnGlow {
  uint of;  // bit n: the cell lies in the volume of number n
  vec3 straight, scattered;
};

OwnGlow own_glow_in(vec3 p_cells) {
  OwnGlow sum = OwnGlow(0u, vec3(0.0), vec3(0.0));
  for (uint v = 0u; v < frame.media.volume_count; ++v) {
    const vec3 low = volumes[v].bounds_min, high = volumes[v].bounds_max;
    const vec3 middle = matrix_of(volumes[v].voxel_from_world) * vec4(world_from_indirect(p_cells), 1.0);
    if (!glows(volumes[v]) || any(lessThan(middle, low)) || any(greaterThan(middle, high))) continue;
    sum.of |= 1u << volumes[v].number;
    for (uint k = 0u; k < kPoints; ++k) {
      const vec3 p_world = world_from_indirect(p_cells + point_of_cell(k));
      const vec3 p_voxel = matrix_of(volumes[v].voxel_from_world) * vec4(p_world, 1.0);
      sum.straight += own_glow(v, kGlowStraight, p_voxel) / float(kPoints);
      sum.scattered += own_glow(v, kGlowScattered, p_voxel) / float(kPoints);
    }
  }
  return sum;
}

void main() {
  const uint probe = gl_GlobalInvocationID.x;
  if (probe >= params.probe_count) return;
  const ivec3 cell = cell_at(frame.indirect, probes[probe]);
  const vec4 matter = texelFetch(medium_matter, cell, 0);
  if (matter.a <= 0.0) return;
  const vec3 p_cells = vec3(cell) + 0.5;
  // Of the medium itself, which the cells replace by a similar one.
  const vec3 albedo = albedo_in(matter);
  const float similar = 1.0 - params.g * dot(albedo, vec3(1.0 / 3.0));
  Formula formula;
  vec3 sky = vec3(0.0);
  for (uint k = 0u; k < kPoints; ++k) {
    const float escape = escape_at(probe, probe_phase(cell), p_cells + point_of_cell(k));
    sky += scattered_sky(min(matter.rgb / matter.a, 1.0), 1.0, 0.0, escape) / float(kPoints);
    const ManyScatterings many = multiple_scattering(many_fit(), albedo, params.g, pow(escape, 1.0 / similar));
    formula.fraction[k] = many.fraction;
    formula.decay = many.decay / similar;
  }
  Arriving sum = Arriving(vec3(0.0), vec3(0.0));
  const OwnGlow own = own_glow_in(p_cells);
  for (uint i = 0u; i < params.light_count; ++i) {
    if (lights[i].glow_of > 0u && (own.of >> (lights[i].glow_of - 1u) & 1u) != 0u) continue;
    const Arriving here = light_in_cell(lights[i], p_cells, formula);
    sum.direct += here.direct;
    sum.formula += here.formula;
  }
  const float per_sphere = 0.25 / 3.14159265;
  imageStore(target, cell, vec4(sum.direct * per_sphere + own.straight, 1.0));
  imageStore(cube, cell + ivec3(0, 0, int(kSkySlab) * frame.indirect.size.z), vec4(sky, 1.0));
  imageStore(cube, cell + ivec3(0, 0, int(kFormulaSlab) * frame.indirect.size.z),
             vec4(sum.formula * per_sphere + own.scattered, 1.0));
}
