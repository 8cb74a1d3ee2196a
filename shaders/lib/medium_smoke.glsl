// Smoke as a medium of lib/media.glsl: eroded by advected noise, cut by holes, exact at walls, lit by the in-scatter
// atlas. The includer defines the constants kMedia and kHoles.
#ifndef MEDIUM_SMOKE_GLSL
#define MEDIUM_SMOKE_GLSL
#include "lib/boundary_cells.glsl"
#include "lib/bricks.glsl"
#include "lib/detail_tile.glsl"
#include "lib/erosion.glsl"
#include "lib/frame.glsl"
#include "lib/media_set.glsl"
#include "lib/noise_tile.glsl"
#include "lib/ray_holes.glsl"
#include "shared/fine_light.h"
#include "shared/light_side.h"

const bool kFineShadows = (kMedia & kMediumFineShadows) != 0u;
const bool kHasDetail = (kMedia & kMediumDetail) != 0u;
layout(binding = kBindDensityDisplacement) uniform sampler3D density_displacement_atlas;
layout(binding = kBindInscatter) uniform sampler3D inscatter_atlas;
layout(binding = kBindLightSide) uniform sampler3D light_side_atlas;
layout(binding = kBindFineLight) uniform sampler3D fine_light;
layout(scalar, binding = kBindFilled) readonly buffer Filled { uint filled[]; };
layout(scalar, binding = kBindFinePages) readonly buffer FinePages { uint fine_pages[]; };

struct SmokeRay {
  vec3 direction;
  RayHoles holes;
};

SmokeRay smoke_ray(vec3 direction, vec2 position_px) { return SmokeRay(direction, holes_of_ray(position_px)); }

struct SmokeSpan {
  BrickSpan bricks;
  vec3 uvw_offset;  // uvw = p_world * texels_per_metre + uvw_offset
  vec3 fine_corner;  // of the page of fine light [texels]; below 0: none
};

SmokeSpan smoke_span(WorldRay world, float t, float ds) {
  const VolumeLayout volume = frame.smoke;
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
  const uint page = kFineShadows && slot != kNoSlot ? fine_pages[slot] : 0u;
  span.fine_corner = page > 0u ? vec3(fine_page_corner(page - 1u)) : vec3(-1.0);
  return span;
}

struct SmokeSample {
  float density;  // after erosion and holes; in a wall below 0: none
  vec3 p_world, uvw;
  vec3 light_offset;  // from the point to its light lookup [voxels]
  float relief;       // factor of its light: shadows of detail
};

/// The look that is drawn. Light in the smoke counts detail even where it is not drawn.
SmokeLook drawn_look() {
  SmokeLook look = frame.look;
  if (!kHasDetail) look.detail = 0.0;
  return look;
}

/// Detail of the noise at a displaced point.
vec2 detail_at(vec3 p_noise, float level, inout uint texture_samples) {
  ++texture_samples;
  return detail_of(textureLod(detail_tile, detail_point(frame.look, p_noise, frame.time), level).rg);
}

/// Behind what lets less than this through, shadows of detail are not seen; on average they change nothing.
const float kLeastSeen = 1.0 / 8.0;

/// Where most light comes from at a point of the in-scatter, and the fraction that does. Else from above.
vec4 side_at(vec3 uvw) {
  const vec3 side = textureLod(light_side_atlas, uvw, 0.0).xyz;
  const float fraction = length(side);
  return fraction < kLeastSide ? vec4(0.0, 1.0, 0.0, 0.0) : vec4(side / fraction, fraction);
}

/// A sample's noise before detail, and what erosion leaves with it.
struct Erosion {
  vec3 p;               // displaced
  float weight, level;  // of detail
  float density, threshold;
  float left;  // fraction of the density
};

/// What detail does to the light of a sample: by what remains half-way along the path to where most light comes from.
float relief_at(SmokeRay ray, Erosion here, vec4 side, inout uint texture_samples) {
  const SmokeLook look = frame.look;
  const vec2 terms = relief_terms(look, here.left, mean_fraction(look, here.density, here.threshold), side.w,
                                  dot(ray.direction, side.xyz));
  const vec2 detail = detail_at(here.p + 0.5 * relief_path(look) * side.xyz, here.level, texture_samples);
  const float there = threshold_with(look, here.density, here.threshold, detail, here.weight);
  return relief(look, terms, clamp(rim_position(look, here.density, there), 0.0, 1.0));
}

/// `transmittance`: from the eye to the sample.
SmokeSample sample_smoke(SmokeRay ray, SmokeSpan span, vec3 p_world, float t, float transmittance,
                         inout uint texture_samples) {
  // Density, by the planes of the cell next to a surface.
  const VolumeLayout volume = frame.smoke;
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
  SmokeSample here = SmokeSample(density, p_world, uvw, smoke.light_offset, 1.0);

  // Noise, for erosion and for the rims of holes.
  if (density > 0.0 && (kHoles != kHolesNone || frame.look.erosion > 0.0)) {
    const vec3 p_noise = p_world + texel.gba;
    const vec4 noise = smoke_noise(noise_tile, frame.look, p_noise, frame.time);
    ++texture_samples;
    const vec2 erosion_noise = billows_and_wisps(noise);
    const float pixel = kInParallelView ? frame.pixel_width : t * frame.pixel_width;
    const float weight = kHasDetail ? detail_weight(frame.look, pixel) : 0.0, level = detail_level(frame.look, pixel);
    const float threshold = erosion_threshold(frame.look, density, erosion_noise);
    const bool matters = kHasDetail && detail_matters(frame.look, density, threshold, weight);
    vec2 detail = vec2(0.0);
    // The rims of holes have it wherever they are.
    if (matters || (weight > 0.0 && any_hole_at(ray.holes, t))) detail = detail_at(p_noise, level, texture_samples);
    float left = 1.0;
    if (frame.look.erosion > 0.0) {
      float with_detail = threshold;
      if (matters) with_detail = erosion_threshold(frame.look, density, erosion_noise + weight * detail);
      left = clamp(rim_position(drawn_look(), density, with_detail), 0.0, 1.0);
      density = left * density_inside(frame.look, noise);
    }
    if (kHoles != kHolesNone)
      density *= remaining_after_holes(ray.holes, t, p_world, rim_noise(noise, detail, weight), density > 0.0);
    if (kFineShadows && matters && density > 0.0 && transmittance > kLeastSeen) {
      const vec4 side = side_at(uvw + smoke.light_offset * volume.bricks.atlas_texel);
      ++texture_samples;
      here.relief = relief_at(ray, Erosion(p_noise, weight, level, smoke.density, threshold, left),
                              side, texture_samples);
    }
  }
  here.density = density;
  return here;
}

vec3 smoke_inscatter(SmokeSpan span, SmokeSample here, inout uint texture_samples) {
  const VolumeLayout volume = frame.smoke;
  ++texture_samples;
  if (!kFineShadows || span.fine_corner.x < 0.0)
    return here.relief *
           textureLod(inscatter_atlas, here.uvw + here.light_offset * volume.bricks.atlas_texel, 0.0).rgb;
  const vec3 voxel = (here.p_world - volume.origin_world) * volume.voxels_per_metre + here.light_offset;
  const vec3 texel = span.fine_corner + fine_page_position(voxel - span.bricks.low);
  const vec4 light = textureLod(fine_light, texel / vec3(textureSize(fine_light, 0)), 0.0);
  return here.relief / max(light.a, 1.0 / 1024.0) * light.rgb;
}

#endif
