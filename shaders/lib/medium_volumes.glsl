// Volumes besides the smoke as a medium of lib/media.glsl: bricks of densities under any affine transform, lit by the
// grids of shared/volume_light.h, and glowing where they are hot.
#ifndef MEDIUM_VOLUMES_GLSL
#define MEDIUM_VOLUMES_GLSL
#include "lib/volume_inscatter.glsl"

// Constants of the pipeline: a software rasteriser pays for branches that it does not take.
const bool kHasHeat = (kMedia & kMediumHeat) != 0u, kIsLit = (kMedia & kMediumLit) != 0u;

/// A ray in the voxel space of a volume, and where it is inside the bounds [m].
struct VolumeRay {
  VoxelRay ray;
  vec3 inverse;  // of ray.per_metre
  vec2 inside;
};

VolumeRay volume_ray(uint i, WorldRay world) {
  const VoxelRay ray = VoxelRay(volumes[i].voxel_from_world * vec4(world.origin, 1.0),
                                volumes[i].voxel_from_world * vec4(world.direction, 0.0));
  return VolumeRay(ray, inverse_of(ray), span_in_box(ray, volumes[i].bounds_min, volumes[i].bounds_max));
}

// Of each volume its brick, since bricks do not end at the same samples. Only where there are several; not in
// VolumesRay, which functions copy.
uint others_present;                  // bit i: the ray is in a brick of volume i, which is not the first
float next_of[kMaxVolumes];           // the first sample behind the brick
vec3 corner_of[kMaxVolumes];          // of the brick in the atlas, less its place in voxel space [texels]
float uniform_value_of[kMaxVolumes];  // of the brick; below 0: it differs from voxel to voxel

/// What the samples of a ray have in common: the first volume's ray, since most frames have no other.
struct VolumesRay {
  VolumeRay first;
  TextureRay light, sun;  // in its cubes of light and of the sun's depths [texels]
  float phase;
};

VolumesRay volumes_ray(WorldRay world) {
  VolumesRay rays;
  rays.first = volume_ray(0u, world);
  const float edge = float(textureSize(volume_light, 0).x);
  const vec3 per_voxel = light_per_voxel(0u, edge);
  rays.light = TextureRay(light_first(0u, edge) + rays.first.ray.origin * per_voxel,
                          rays.first.ray.per_metre * per_voxel);
  if (kHasSun) {
    const float sun_edge = float(textureSize(sun_depths, 0).y);
    rays.sun = TextureRay(volumes[0].sun_from_voxel * vec4(rays.first.ray.origin, 1.0) * sun_edge,
                          volumes[0].sun_from_voxel * vec4(rays.first.ray.per_metre, 0.0) * sun_edge);
    rays.phase = volume_phase(0u, world);
  }
  return rays;
}

/// Before samples in other places than those before.
void restart_volumes() {
  if (!kHasSeveral) return;
  others_present = 0u;
  for (uint i = 1u; i < frame.media.volume_count; ++i) next_of[i] = -1e30;
}

struct VolumesSpan {
  uint present;         // bit i: samples in [t_first, t_stop) may be inside volume i
  TextureRay values;    // of the first volume, in the atlas, where it alone is present
  TextureRay colors;    // the same in the atlas of colours
  float uniform_value;  // of the first volume in a uniform brick; else below 0
  float ds;             // of the steps, where there are transfer functions
  float t_first, t_stop, t_next;
};

/// The span of one volume: a brick, an empty cube, or all samples before or behind its bounds.
BrickSpan volume_span(uint i, VolumeRay ray, float t, float ds) {
  if (ray.inside.x >= ray.inside.y || t >= ray.inside.y) return BrickSpan(vec3(0.0), kNoSlot, 0.0, t, t, 1e30);
  const float t_inside = sample_from(ray.inside.x, t, ds);
  if (t_inside > t) return BrickSpan(vec3(0.0), kNoSlot, 0.0, t, t, t_inside);
  const vec3 p_voxel = ray.ray.origin + ray.ray.per_metre * t;
  return brick_span(ray.ray, ray.inverse, volume_brick(volumes[i].bricks, p_voxel), t, ds);
}

/// Moves the spans that end at or before the sample at t.
void move_others(WorldRay world, float t, float ds, inout VolumesSpan span) {
  for (uint i = 1u; i < frame.media.volume_count; ++i) {
    if (t > next_of[i] - 0.5 * ds) {
      const BrickSpan at = volume_span(i, volume_ray(i, world), t, ds);
      next_of[i] = at.t_next;
      others_present &= ~(1u << i);
      if (at.slot != kNoSlot) {
        others_present |= 1u << i;
        corner_of[i] = atlas_corner(volumes[i].bricks, at.slot) - at.low;
        uniform_value_of[i] = at.slot == kUniformSlot ? at.uniform_value : -1.0;
      }
    }
    span.t_next = min(span.t_next, next_of[i]);
  }
  span.present |= others_present;
}

VolumesSpan volumes_span(WorldRay world, VolumesRay rays, float t, float ds) {
  VolumesSpan span;
  const BrickSpan first = volume_span(0u, rays.first, t, ds);
  span.t_first = span.t_stop = t;
  span.t_next = first.t_next;
  span.present = first.slot != kNoSlot ? 1u : 0u;
  const vec3 texel = atlas_texel(volumes[0].bricks);
  const vec3 corner = atlas_corner(volumes[0].bricks, first.slot) - first.low;
  span.uniform_value = first.slot == kUniformSlot ? first.uniform_value : -1.0;
  span.values = TextureRay((corner + rays.first.ray.origin) * texel, rays.first.ray.per_metre * texel);
  if (kHasColorGrids) span.colors = texture_ray(volumes[0].colors.bricks, first, rays.first.ray);
  if (kHasTransfer) span.ds = ds;
  if (kHasSeveral) {
    corner_of[0] = corner;
    uniform_value_of[0] = span.uniform_value;
    move_others(world, t, ds, span);
  }
  if (span.present != 0u) span.t_stop = span.t_next - 0.5 * ds;
  return span;
}

/// Whether all samples of a span are alike: in a brick of one value, where nothing but the extinction matters.
bool is_constant(VolumesSpan span) {
  return !kIsLit && !kHasHeat && span.present == 1u && span.uniform_value >= 0.0;
}

/// Sums over the volumes.
struct VolumesSample {
  float extinction;  // [1/m]
  vec3 light;        // extinction times radiance towards the eye
  vec3 glow;         // radiance that leaves per metre, whatever the extinction
};

void add_volume(uint i, VolumeMatter matter, LightTexels at, float phase, vec3 p_world,
                inout VolumesSample sum, inout uint texture_samples) {
  const float extinction = volumes[i].look.extinction * matter.density;
  texture_samples += kHasTransfer ? 2u : 1u;
  if (kHasColorGrids) ++texture_samples;
  sum.extinction += extinction;
  if (kIsLit && extinction > 0.0) {
    sum.light += extinction * (volume_inscatter(matter.albedo, i, at, phase) + matter.emission);
    texture_samples += kHasSun ? 2u : 1u;
  }
  if (kHasHeat && volumes[i].heat.per_value > 0.0) {
    sum.glow += volumes[i].look.extinction * volume_glow(i, p_world);
    ++texture_samples;
  }
}

VolumesSample sample_volumes(VolumesSpan span, VolumesRay rays, WorldRay world, vec3 p_world, float t,
                             inout uint texture_samples) {
  VolumesSample sum = VolumesSample(0.0, vec3(0.0), vec3(0.0));
  if (!kHasSeveral || span.present == 1u) {
    const vec3 per_metre = rays.first.ray.per_metre;
    const VolumeMatter matter =
        matter_along(volumes[0], span.values, span.colors, span.uniform_value, per_metre, span.ds, t);
    LightTexels at;
    at.light = rays.light.at + t * rays.light.along;
    if (kHasSun) at.sun = rays.sun.at + t * rays.sun.along;
    add_volume(0u, matter, at, rays.phase, p_world, sum, texture_samples);
    return sum;
  }
  const float edge = float(textureSize(volume_light, 0).x), sun_edge = float(textureSize(sun_depths, 0).y);
  for (uint left = span.present; left != 0u; left &= left - 1u) {
    const uint i = uint(findLSB(left));
    const vec3 p_voxel = volumes[i].voxel_from_world * vec4(p_world, 1.0);
    const LightTexels at = LightTexels(
        light_first(i, edge) + p_voxel * light_per_voxel(i, edge),
        (volumes[i].sun_from_voxel * vec4(p_voxel, 1.0) + vec3(0.0, 0.0, float(i))) * sun_edge);
    VolumeMatter matter = VolumeMatter(uniform_value_of[i], volumes[i].look.albedo, volumes[i].look.emission);
    if (kHasAlbedos) {
      const vec3 per_metre = volumes[i].voxel_from_world * vec4(world.direction, 0.0);
      matter = matter_around(volumes[i], i, p_voxel, per_metre * half_segment(per_metre, span.ds));
    } else if (matter.density < 0.0) {
      const vec3 uvw = (corner_of[i] + p_voxel) * atlas_texel(volumes[i].bricks);
      matter.density = textureLod(volume_values, uvw, 0.0).r;
    }
    add_volume(i, matter, at, volume_phase(i, world), p_world, sum, texture_samples);
  }
  return sum;
}

#endif
