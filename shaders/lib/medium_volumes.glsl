// Volumes besides the smoke as a medium of lib/media.glsl: bricks of densities under any affine transform, lit by the
// grids of shared/volume_light.h, and glowing where they are hot.
#ifndef MEDIUM_VOLUMES_GLSL
#define MEDIUM_VOLUMES_GLSL
#include "lib/volume_detail.glsl"
#include "lib/volume_disturbance.glsl"
#include "lib/volume_glow.glsl"
#include "lib/volume_inscatter.glsl"

// Constants of the pipeline: a software rasteriser pays for branches that it does not take.
const bool kIsLit = (kMedia & kMediumLit) != 0u, kHasGlow = kHasHeat || kHasMasks;

/// A ray in the voxel space of a volume, and where it is inside the bounds [m].
struct VolumeRay {
  VoxelRay ray;
  vec3 inverse;  // of ray.per_metre
  vec2 inside;
};

VolumeRay volume_ray(uint i, WorldRay world) {
  const mat4x3 voxel_from_world = matrix_of(volumes[i].voxel_from_world);
  const VoxelRay ray =
      VoxelRay(voxel_from_world * vec4(world.origin, 1.0), voxel_from_world * vec4(world.direction, 0.0));
  const vec3 reach = disturbance_of(i);
  return VolumeRay(ray, inverse_of(ray),
                   span_in_box(ray, volumes[i].bounds_min - reach, volumes[i].bounds_max + reach));
}

/// What the samples of a ray in volume i have in common with regard to light.
struct LightRay {
  TextureRay light, sun;  // in the cubes of light and of the sun's depths [texels]
  float phase;
};

LightRay light_ray(uint i, WorldRay world, VoxelRay ray) {
  LightRay lit;
  const float edge = float(textureSize(volume_light, 0).x);
  const vec3 per_voxel = light_per_voxel(i, edge);
  lit.light = TextureRay(light_first(i, edge) + ray.origin * per_voxel, ray.per_metre * per_voxel);
  if (kHasSun) {
    const float sun_edge = float(textureSize(sun_depths, 0).y);
    const vec3 first = vec3(0.0, 0.0, float(i));
    const mat4x3 sun_from_voxel = matrix_of(volumes[i].sun_from_voxel);
    lit.sun = TextureRay((sun_from_voxel * vec4(ray.origin, 1.0) + first) * sun_edge,
                         sun_from_voxel * vec4(ray.per_metre, 0.0) * sun_edge);
    lit.phase = volume_phase(i, world);
  }
  return lit;
}

/// What the samples of a ray have in common, in a frame of one volume.
struct VolumesRay {
  VolumeRay volume;
  LightRay lit;
};

VolumesRay volumes_ray(WorldRay world) {
  const VolumeRay ray = volume_ray(0u, world);
  return VolumesRay(ray, light_ray(0u, world, ray.ray));
}

/// What the samples of a volume in a brick have in common.
struct VolumeBrick {
  TextureRay values;    // in the atlas
  TextureRay colors;    // in the atlas of colours and masks
  float uniform_value;  // of a uniform brick; else below 0
};

VolumeBrick brick_of(uint i, VoxelRay ray, BrickSpan span) {
  VolumeBrick brick;
  brick.uniform_value = -1.0;
  if (span.slot == kDisturbedSlot) return brick;
  brick.values = texture_ray(volumes[i].bricks, span, ray);
  if ((kHasColorGrids || kHasMasks) && volumes[i].color_kind != kColorsNone)
    brick.colors = texture_ray(volumes[i].color_bricks, span, ray);
  if (span.slot == kUniformSlot) brick.uniform_value = span.uniform_value;
  return brick;
}

struct VolumesSpan {
  bool present;  // samples in [t_first, t_stop) may be inside the volume
  VolumeBrick brick;
  float ds;  // of the steps, where there are transfer functions
  float t_first, t_stop, t_next;
};

/// The span of one volume: a brick, an empty cube, or all samples before or behind its bounds.
BrickSpan volume_span(uint i, VolumeRay ray, float t, float ds) {
  if (ray.inside.x >= ray.inside.y || t >= ray.inside.y) return BrickSpan(vec3(0.0), kNoSlot, 0.0, t, t, 1e30);
  const float t_inside = sample_from(ray.inside.x, t, ds);
  if (t_inside > t) return BrickSpan(vec3(0.0), kNoSlot, 0.0, t, t, t_inside);
  if (is_disturbed(i)) {
    const float t_next = max(sample_from(ray.inside.y, t, ds), t + ds);
    return BrickSpan(vec3(0.0), kDisturbedSlot, 0.0, t, t_next, t_next);
  }
  const vec3 p_voxel = ray.ray.origin + ray.ray.per_metre * t;
  return brick_span(ray.ray, ray.inverse, volume_brick(volumes[i].bricks, p_voxel), t, ds);
}

VolumesSpan volumes_span(VolumesRay rays, float t, float ds) {
  const BrickSpan at = volume_span(0u, rays.volume, t, ds);
  VolumesSpan span;
  span.t_first = span.t_stop = t;
  span.t_next = at.t_next;
  span.present = at.slot != kNoSlot;
  span.brick = brick_of(0u, rays.volume.ray, at);
  if (kHasTransfer || kHasDisturbance) span.ds = ds;
  if (span.present) span.t_stop = span.t_next - 0.5 * ds;
  return span;
}

/// Whether all samples of a span are alike: in a brick of one value, where nothing but the extinction matters.
bool is_constant(VolumesSpan span) {
  return !kIsLit && !kHasGlow && !kHasVolumeDetail && span.present && span.brick.uniform_value >= 0.0;
}

/// Sums over the volumes.
struct VolumesSample {
  float extinction;  // [1/m]
  vec3 light;        // extinction times radiance towards the eye
  vec3 glow;         // radiance that leaves per metre, whatever the extinction
};

void add_volume(uint i, VolumeMatter matter, vec4 masks, LightTexels at, float phase, vec3 p_world,
                inout VolumesSample sum, inout uint texture_samples) {
  const float extinction = volumes[i].look.extinction * matter.density;
  texture_samples += kHasTransfer ? 2u : 1u;
  if (kHasColorGrids) ++texture_samples;
  sum.extinction += extinction;
  if (kIsLit && extinction > 0.0) {
    sum.light += extinction * (volume_inscatter(matter.albedo, i, at, phase) + matter.emission);
    texture_samples += kHasSun ? 2u : 1u;
  }
  if (kHasHeat && volumes[i].heat_per_value > 0.0) {
    sum.glow += volumes[i].look.extinction * volume_glow(i, p_world);
    ++texture_samples;
  }
  if (kHasMasks && volumes[i].color_kind >= kColorsMasks) {
    sum.glow += matrix_of(volume_effects[i].tints) * masks;
    ++texture_samples;
  }
}

/// Adds volume i at a point of its voxel space that noise has moved: its brick is another one at each sample.
void add_disturbed(uint i, vec3 p_voxel, LightTexels at, float phase, vec3 half_voxels, vec3 p_world, float t,
                   inout VolumesSample sum, inout uint texture_samples) {
  const vec3 p = disturbed(i, p_voxel);
  if (any(lessThan(p, volumes[i].bounds_min)) || any(greaterThan(p, volumes[i].bounds_max))) return;
  const BrickAt brick = volume_brick(volumes[i].bricks, p);
  if (brick.slot == kNoSlot) return;
  vec4 masks = vec4(0.0);
  if (kHasMasks && volumes[i].color_kind >= kColorsMasks) {
    const vec3 corner = atlas_corner(volumes[i].color_bricks, brick.slot);
    masks = masks_at(i, (corner + p - brick.low) * volumes[i].color_bricks.atlas_texel);
  }
  VolumeMatter matter = matter_around(volumes[i], i, p, half_voxels);
  matter.density *= detail_left(i, p, matter.density, t, texture_samples);
  add_volume(i, matter, masks, at, phase, p_world, sum, texture_samples);
}

/// Adds volume i at the sample at t of a ray through one of its bricks.
void add_volume_at(uint i, VolumeBrick brick, LightRay lit, VoxelRay ray, float ds, vec3 p_world, float t,
                   inout VolumesSample sum, inout uint texture_samples) {
  LightTexels at;
  at.light = lit.light.at + t * lit.light.along;
  if (kHasSun) at.sun = lit.sun.at + t * lit.sun.along;
  if (is_disturbed(i)) {
    const vec3 half_voxels = half_segment(ray.per_metre, ds) * ray.per_metre;
    add_disturbed(i, ray.origin + ray.per_metre * t, at, lit.phase, half_voxels, p_world, t, sum,
                  texture_samples);
    return;
  }
  vec4 masks = vec4(0.0);
  if (kHasMasks && volumes[i].color_kind >= kColorsMasks)
    masks = masks_at(i, brick.colors.at + t * brick.colors.along);
  VolumeMatter matter = VolumeMatter(0.0, vec3(0.0), vec3(0.0));
  // What only glows is no more than its masks.
  if (!kHasMasks || volumes[i].look.extinction > 0.0)
    matter = matter_along(volumes[i], i, brick.values, brick.colors, brick.uniform_value, ray.per_metre, ds, t);
  matter.density *= detail_left(i, ray.origin + ray.per_metre * t, matter.density, t, texture_samples);
  add_volume(i, matter, masks, at, lit.phase, p_world, sum, texture_samples);
}

VolumesSample sample_volumes(VolumesSpan span, VolumesRay rays, vec3 p_world, float t, inout uint texture_samples) {
  VolumesSample sum = VolumesSample(0.0, vec3(0.0), vec3(0.0));
  add_volume_at(0u, span.brick, rays.lit, rays.volume.ray, span.ds, p_world, t, sum, texture_samples);
  return sum;
}

#endif
