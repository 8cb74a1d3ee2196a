// Smoke as a medium of lib/media.glsl: eroded by advected noise, cut by holes, exact at walls, lit by the in-scatter
// atlas. The includer defines the constants kMedia and kHoles.
#ifndef MEDIUM_SMOKE_GLSL
#define MEDIUM_SMOKE_GLSL
#include "lib/boundary_cells.glsl"
#include "lib/bricks.glsl"
#include "lib/erosion.glsl"
#include "lib/frame.glsl"
#include "lib/noise_tile.glsl"
#include "lib/ray_holes.glsl"
#include "shared/light_side.h"
#include "shared/media.h"

const bool kHasSmoke = (kMedia & kMediumSmoke) != 0u, kFineShadows = (kMedia & kMediumFineShadows) != 0u;
const bool kHasDetail = (kMedia & kMediumDetail) != 0u;
/// Below this fraction of light from one side it casts no fine shadows.
const float kLeastSide = 0.02;
/// So far beyond its voxels the texels of a brick reach, less the resolution of the texture unit [voxels].
const float kInside = 0.5 - 1.0 / 64.0;

layout(binding = kBindDensityDisplacement) uniform sampler3D density_displacement_atlas;
layout(binding = kBindInscatter) uniform sampler3D inscatter_atlas;
layout(binding = kBindLightSide) uniform sampler3D light_side_atlas;

layout(scalar, binding = kBindFilled) readonly buffer Filled { uint filled[]; };

struct SmokeRay {
  RayHoles holes;
};

SmokeRay smoke_ray(vec2 position_px) {
  return SmokeRay(holes_of_ray(position_px));
}

struct SmokeSpan {
  BrickSpan bricks;
  vec3 uvw_offset;  // uvw = p_world * texels_per_metre + uvw_offset
};

SmokeSpan smoke_span(WorldRay world, float t, float ds) {
  const VolumeLayout volume = frame.volume;
  const VoxelRay ray = VoxelRay((world.origin - volume.origin_world) * volume.voxels_per_metre,
                                world.direction * volume.voxels_per_metre);
  const ivec3 brick = ivec3(floor((ray.origin + ray.per_metre * t) / float(kBrickVoxels)));
  int edge = 0;
  const uint slot = slot_at(volume.bricks, brick, edge);
  edge = slot != kNoSlot ? kBrickVoxels : edge;
  SmokeSpan span;
  const BrickAt at = BrickAt(vec3((brick * kBrickVoxels) & -edge), float(edge), slot, 0.0);
  span.bricks = brick_span(ray, inverse_of(ray), at, t, ds);
  // Cell 0 of a brick begins half a voxel before it.
  if (slot != kNoSlot) {
    const uint box = filled[slot];
    narrow_to(vec3(cells_low(box)) - 0.5, vec3(cells_end(box)) - 0.5, ray, t, ds, span.bricks);
  }
  const vec3 corner = atlas_corner(volume.bricks, slot) - span.bricks.low;
  span.uvw_offset = corner * volume.bricks.atlas_texel - volume.origin_world * volume.texels_per_metre;
  return span;
}

struct SmokeSample {
  float density;  // after erosion and holes; in a wall below 0: none
  vec3 uvw, light_offset;
  // With fine shadows.
  vec3 p_world, low;  // low corner of the brick [voxels]
  float even;         // density before erosion
};

/// The look that is drawn. Light in the smoke has detail's steep rims even where it is not drawn.
SmokeLook drawn_look() {
  SmokeLook look = frame.look;
  if (!kHasDetail) look.detail = 0.0;
  return look;
}

SmokeSample sample_smoke(SmokeRay ray, SmokeSpan span, vec3 p_world, float t, inout uint texture_samples) {
  // Density, by the planes of the cell next to a surface.
  const VolumeLayout volume = frame.volume;
  const vec3 uvw = p_world * volume.texels_per_metre + span.uvw_offset;
  const vec4 texel = textureLod(density_displacement_atlas, uvw, 0.0);
  BrickSample smoke = BrickSample(texel.r, vec3(0.0));
  if (texel.r < 0.0) {
    const vec3 local_voxel = (p_world - volume.origin_world) * volume.voxels_per_metre - span.bricks.low;
    smoke = boundary_sample(span.bricks.slot, local_voxel);
    if (smoke.density == kNoBoundary)
      smoke.density =
          textureLod(density_displacement_atlas, uvw + off_faces(local_voxel) * volume.bricks.atlas_texel, 0.0).r;
  }
  float density = smoke.density;
  ++texture_samples;

  // Noise, for erosion and for the rims of holes.
  if (density > 0.0 && (kHoles != kHolesNone || frame.look.erosion > 0.0)) {
    const vec3 p_noise = p_world + texel.gba;
    const vec4 noise = smoke_noise(noise_tile, frame.look, p_noise, frame.time);
    ++texture_samples;
    vec4 detailed = noise;
    if (kHasDetail) {
      const vec2 weights = detail_weights(frame.look, t * frame.pixel_width);
      // The rims of holes have it wherever they are.
      if (any_hole_at(ray.holes, t) || detail_matters(frame.look, density, noise, weights))
        detailed = detailed_noise(noise_tile, frame.look, p_noise, frame.time, noise, weights, texture_samples);
    }
    if (frame.look.erosion > 0.0) density = erode(drawn_look(), density, noise, detailed);
    if (kHoles != kHolesNone)
      density *= remaining_after_holes(ray.holes, t, p_world, 2.0 * detailed.g - 1.0, density > 0.0);
  }
  return SmokeSample(density, uvw, smoke.light_offset, p_world, span.bricks.low, smoke.density);
}

/// Optical depth from a sample towards the light, over the path of shared/light_side.h, without holes.
float depth_towards(SmokeSample here, vec3 towards, inout uint texture_samples) {
  const VolumeLayout volume = frame.volume;
  const vec3 local = (here.p_world - volume.origin_world) * volume.voxels_per_metre - here.low;
  float sum = 0.0;
  for (uint i = 0u; i < kSideSamples; ++i) {
    const vec3 offset = towards * side_sample(i);
    // Beyond the texels of the brick, as at their border; not on it, where rounding would meet other bricks.
    const vec3 at = clamp(local + offset, vec3(-kInside), vec3(float(kBrickVoxels) + kInside)) - local;
    const vec4 texel = textureLod(density_displacement_atlas, here.uvw + at * volume.bricks.atlas_texel, 0.0);
    const vec3 p_world = here.p_world + offset * volume.voxel_size;
    const vec4 noise = smoke_noise(noise_tile, frame.look, p_world + texel.gba, frame.time);
    sum += erode(drawn_look(), texel.r < 0.0 ? here.even : texel.r, noise, noise);
    texture_samples += 2u;
  }
  return sum * side_depth(frame.look.extinction, volume.voxel_size);
}

/// Where less than this fraction of a sample reaches the eye, noise casts no shadows within a voxel: they would not be
/// seen, and on average they change nothing.
const float kLeastSeen = 1.0 / 16.0;

vec3 smoke_inscatter(SmokeSample here, float transmittance, inout uint texture_samples) {
  ++texture_samples;
  const vec3 uvw = here.uvw + here.light_offset * frame.volume.bricks.atlas_texel;
  const vec3 light = textureLod(inscatter_atlas, uvw, 0.0).rgb;
  if (!kFineShadows || transmittance < kLeastSeen) return light;
  ++texture_samples;
  const vec4 side = textureLod(light_side_atlas, uvw, 0.0);
  const float fraction = length(side.xyz);
  if (fraction < kLeastSide) return light;
  return light * exp(fraction * (side.a - depth_towards(here, side.xyz / fraction, texture_samples)));
}

#endif
