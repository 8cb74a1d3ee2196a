// Light in the volumes in view: gathers the sun and the sky from their sweeps, and marches to the other lights
// (shared/volume_light.h). A thread per cell of a volume's cube.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/frame.glsl"
#include "shared/light.h"
#include "shared/scattering.h"
#include "shared/volume_light.h"

// Rows of 8: a software rasteriser takes the lanes of a subgroup from a row.
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kMedia = 0u;
layout(scalar, binding = kBindLights) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = kBindSweeps) readonly buffer Sweeps { VolumeSweep sweeps[]; };
layout(binding = kBindSunDepths) uniform sampler3D sun_depths;
layout(binding = kBindSkyDepths) uniform sampler3D sky_depths;
layout(binding = kBindVolumeLightTarget, rgba16f) uniform writeonly image3D light_target;
layout(scalar, push_constant) uniform Push { VolumeLightParams params; };
#include "lib/dense_volume_light.glsl"
#include "lib/glow_field.glsl"
#include "lib/indirect_light.glsl"
#include "lib/light_visibility.glsl"
#include "lib/sky_light.glsl"

const bool kHasDense = (kMedia & kMediumDense) != 0u;
const uint kStepsToLight = 16u;
const float kOpaqueDepth = 1e4;
const float kPerSphere = 0.0795774715;  // 1 / (4 pi)

/// Whether a sample that reads this cell can lie in a brick.
bool is_near_bricks(uint volume, vec3 p_voxel, vec3 cell_voxels) {
  for (uint corner = 0u; corner < 9u; ++corner) {
    const vec3 side = corner == 8u ? vec3(0.0) : vec3(corner & 1u, corner >> 1u & 1u, corner >> 2u) * 2.0 - 1.0;
    if (volume_brick(volumes[volume].bricks, p_voxel + side * cell_voxels).slot != kNoSlot) return true;
  }
  return false;
}

/// Optical depth of a sweep at a point: of the cube of this number.
float swept_depth(sampler3D depths, uint volume, uint number, VolumeSweep sweep, vec3 p_world) {
  const vec3 size = vec3(textureSize(depths, 0)), at = matrix_of(sweep.sweep_from_world) * vec4(p_world, 1.0);
  const float edge = size.y;
  const vec3 first = edge * vec3(number, 0u, volume);
  return textureLod(depths, (first + clamp(at * edge, vec3(0.5), vec3(edge - 0.5))) / size, 0.0).r;
}

/// What arrives through the sweeps along the sky's directions.
Arrivals swept_arrivals(uint volume, vec3 p_world, vec4 around) {
  Arrivals sum = no_arrivals();
  for (uint i = 0u; i < kSkySweeps; ++i) {
    const VolumeSweep sweep = sweeps[volume * kSweepsOfVolume + 1u + i];
    const vec3 to_sky = -matrix_of(sweep.world_from_sweep)[2] / sweep.length_m;
    const float passed = exp(-swept_depth(sky_depths, volume, i, sweep, p_world)) / float(kSkySweeps);
    sum.escape += passed;
    sum.seen += passed * seen_around(around, to_sky);
  }
  return sum;
}

/// Optical depth of the media along a ray to a light.
float depth_to_light(uint volume, vec3 p_world, Incident incident) {
  if (kHasDense && volumes[volume].is_dense != 0u) {
    const float depth = dense_depth(volume, p_world, incident.to_light, incident.distance, kMostDepthOften).all;
    // The ray ends there, and without an albedo of less than 1 the light would not.
    return depth < kMostDepthOften ? depth : kOpaqueDepth;
  }
  const float ds = incident.distance / float(kStepsToLight);
  const uint mask =
      volumes_along(p_world, p_world + incident.to_light * incident.distance);
  float depth = others_depth(p_world, incident.to_light, incident.distance);
  for (uint i = 0u; i < kStepsToLight; ++i)
    depth += ds * volumes_extinction(mask, p_world + incident.to_light * (ds * (float(i) + 0.5)),
                                     incident.to_light * (0.5 * ds));
  return depth;
}

/// Light of all lights but the sun, scattered equally in all directions: once, and more often.
struct OtherLights {
  vec3 once, often;
  vec3 own;  // the part of `often` that is the volume's own glow
};

OtherLights other_lights(uint volume, vec3 p_voxel, vec3 p_world, vec3 albedo, ManyScatterings many, float weight) {
  OtherLights sum = OtherLights(vec3(0.0), vec3(0.0), vec3(0.0));
  if (glows(volumes[volume])) {
    sum.once = albedo * own_glow(volume, kGlowStraight, p_voxel);
    sum.often = sum.own = albedo * weight * own_glow(volume, kGlowScattered, p_voxel);
  }
  for (uint i = 0u; i < frame.light_count; ++i) {
    if (i == params.sun) continue;
    if (lights[i].glow_of == volumes[volume].number + 1u) continue;
    const Incident incident = light_at(lights[i], p_world);
    if (is_negligible(lights[i], incident)) continue;
    const float lit = light_visibility(lights[i], p_world);
    if (lit <= 0.0) continue;
    const float depth = depth_to_light(volume, p_world, incident);
    const vec3 arriving = incident.irradiance * (lit * kPerSphere);
    sum.once += arriving * exp(-depth) * albedo;
    sum.often += arriving * many.fraction * exp(-many.decay * depth);
  }
  return sum;
}

/// The mean albedo of a cell, by extinction; that of the look where there is none.
vec3 mean_albedo(uint i, vec3 p_voxel, vec3 cell_voxels) {
  vec3 sum = vec3(0.0);
  float extinction = 0.0;
  for (uint octant = 0u; octant < 8u; ++octant) {
    const vec3 side = vec3(octant & 1u, octant >> 1u & 1u, octant >> 2u) * 2.0 - 1.0;
    // From the middle to each corner.
    const VolumeMatter matter =
        matter_around(volumes[i], i, p_voxel + side * (0.25 * cell_voxels), side * (0.25 * cell_voxels));
    sum += matter.density * matter.albedo;
    extinction += matter.density;
  }
  return extinction > 0.0 ? sum / extinction : volumes[i].look.albedo;
}

/// Scattered light of the sky and of surfaces around.
vec3 light_from_around(VolumeLook look, vec3 albedo, ManyScatterings many, Arrivals arrivals, bool is_dense,
                       vec3 on_ground) {
  const vec3 arriving = radiance_around(arrivals.seen, on_ground);
  if (!is_dense)
    return albedo * scattered_sky(look.albedo, look.multiple_scattering, look.anisotropy, arrivals.escape, arriving);
  vec3 often;
  for (uint c = 0u; c < 3u; ++c) often[c] = radiance_around(arrivals.seen_often[c], on_ground)[c];
  return albedo * arriving + many.fraction * often;
}

/// The light in a cell of a volume.
vec4 light_in_cell(uint volume, vec3 p_voxel, vec3 cell_voxels) {
  const bool is_dense = kHasDense && volumes[volume].is_dense != 0u;
  const vec3 p_world = matrix_of(volumes[volume].world_from_voxel) * vec4(p_voxel, 1.0);
  VolumeLook look = volumes[volume].look;
  if (kHasAlbedos) look.albedo = mean_albedo(volume, p_voxel, cell_voxels);
  const vec4 around = sky_around(p_world);
  Arrivals arrivals;
  if (is_dense) {
    const vec3 decay = multiple_scattering(many_fit(), look.albedo, look.anisotropy, 0.0).decay;
    arrivals = dense_arrivals(volume, p_world, around, decay);
    if (arrivals.escape < kLeastEscape) return vec4(0.0);
  } else {
    arrivals = swept_arrivals(volume, p_world, around);
  }
  // All light here has been scattered at least once. With albedos of their own, samples multiply it by them.
  const vec3 albedo = kHasAlbedos ? vec3(1.0) : look.albedo;
  ManyScatterings many = multiple_scattering(many_fit(), look.albedo, look.anisotropy, arrivals.escape);
  // What is not opaque within a voxel or two is known to the cells of indirect light.
  const bool in_cells = frame.indirect.bounces > 0u && !is_dense;
  many.fraction *= look.multiple_scattering * albedo;
  vec4 light = vec4(0.0);
  vec3 often = vec3(0.0), on_ground = vec3(0.0);
  if (params.sun != kNoSun) {
    const Light sunlight = lights[params.sun];
    const float lit = light_visibility(sunlight, p_world);
    float depth = 0.0;
    if (is_dense)
      depth = dense_depth(volume, p_world, -sunlight.direction, kFar, kMostDepth).all;
    else
      depth = swept_depth(sun_depths, volume, 0u, sweeps[volume * kSweepsOfVolume], p_world);
    light.a = is_dense ? lit * exp(-depth) : lit;
    on_ground = sunlight.intensity * (lit * max(-sunlight.direction.y, 0.0));
    often = sunlight.intensity * (lit * kPerSphere) * many.fraction * exp(-many.decay * depth);
  }
  const OtherLights others = other_lights(volume, p_voxel, p_world, albedo, many, look.multiple_scattering);
  often += others.often;
  light.rgb = others.once;
  if (in_cells) {
    const vec3 detail =
        detail_in_cells(p_world, look.albedo, look.anisotropy, look.multiple_scattering, arrivals.escape);
    const vec3 of_cells = albedo * indirect_field(p_world).mean;
    // A few bounces between coarse cells miss much of what glows in dense matter.
    light.rgb += max(refined_by_formula(of_cells, albedo * formula_in_cells(p_world), often, detail), others.own);
  } else
    light.rgb += often + light_from_around(look, albedo, many, arrivals, is_dense, on_ground);
  return light;
}

void main() {
  const uvec3 at = gl_GlobalInvocationID;
  const uint volume = at.z / params.edge;
  if (any(greaterThanEqual(at.xy, uvec2(params.edge))) || volume >= frame.media.volume_count) return;
  const vec3 cell = vec3(at.xy, at.z % params.edge) + 0.5;
  const vec3 low = volumes[volume].bounds_min, size = volumes[volume].bounds_max - low;
  const vec3 p_voxel = low + cell / float(params.edge) * size, cell_voxels = size / float(params.edge);
  const bool is_dense = kHasDense && volumes[volume].is_dense != 0u;
  vec4 light = vec4(0.0);
  if (is_near_bricks(volume, p_voxel, cell_voxels) && (!is_dense || is_near_matter(volume, p_voxel, cell_voxels)))
    light = light_in_cell(volume, p_voxel, cell_voxels);
  imageStore(light_target, ivec3(at), light);
}
