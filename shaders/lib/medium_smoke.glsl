// Smoke as a medium of lib/march.glsl: eroded by advected noise, cut by holes, exact at walls, lit by the in-scatter
// atlas. The includer defines the constant kHoles.
#ifndef MEDIUM_SMOKE_GLSL
#define MEDIUM_SMOKE_GLSL
#include "lib/boundary_cells.glsl"
#include "lib/bricks.glsl"
#include "lib/erosion.glsl"
#include "lib/frame.glsl"
#include "lib/ray_holes.glsl"
#include "shared/noise.h"

layout(binding = kBindDensityDisplacement) uniform sampler3D density_displacement_atlas;
layout(binding = kBindInscatter) uniform sampler3D inscatter_atlas;
layout(binding = kBindNoiseTile) uniform sampler3D noise_tile;

VolumeLayout medium_volume() { return frame.volume; }
float medium_step_length() { return frame.look.step_length; }
float medium_extinction() { return frame.look.extinction; }
float medium_opaque_transmittance() { return frame.look.opaque_transmittance; }
vec3 medium_albedo() { return frame.look.albedo; }

struct MediumRay {
  RayHoles holes;
  vec3 texel, texels_per_metre;  // of the atlas, in texture coordinates
  float periods_per_metre;       // of the noise
  vec3 risen;                    // rise of the noise [periods]
};

MediumRay medium_ray(vec2 position_px) {
  MediumRay ray;
  ray.holes = holes_of_ray(position_px);
  ray.texel = atlas_texel(frame.volume);
  ray.texels_per_metre = ray.texel / frame.volume.voxel_size;
  ray.periods_per_metre = 1.0 / frame.look.noise_period;
  ray.risen = vec3(0.0, frame.look.rise * frame.time * ray.periods_per_metre, 0.0);
  return ray;
}

struct MediumBrick {
  uint slot;
  vec3 low_voxel;
  vec3 uvw_offset;  // uvw = p_world * texels_per_metre + uvw_offset
};

MediumBrick medium_brick(MediumRay ray, uint slot, vec3 low_voxel) {
  const VolumeLayout volume = frame.volume;
  const vec3 offset = (atlas_corner(volume, slot) - low_voxel) * ray.texel - volume.origin_world * ray.texels_per_metre;
  return MediumBrick(slot, low_voxel, offset);
}

struct MediumSample {
  float density;  // after erosion and holes
  vec3 uvw, light_offset;
};

MediumSample sample_medium(MediumRay ray, MediumBrick brick, vec3 p_world, float t, inout uint texture_samples) {
  // Density, by the planes of the cell next to a surface.
  const VolumeLayout volume = frame.volume;
  const vec3 uvw = p_world * ray.texels_per_metre + brick.uvw_offset;
  const vec4 texel = textureLod(density_displacement_atlas, uvw, 0.0);
  SmokeSample smoke = SmokeSample(texel.r, vec3(0.0));
  if (texel.r < 0.0)
    smoke = boundary_sample(brick.slot, (p_world - volume.origin_world) / volume.voxel_size - brick.low_voxel);
  float density = smoke.density;
  ++texture_samples;

  // Noise, for erosion and for the rims of holes.
  if (density > 0.0 && (kHoles != kHolesNone || frame.look.erosion > 0.0)) {
    const vec3 noise_at = (p_world + texel.gba) * ray.periods_per_metre - ray.risen;
    const vec4 noise = textureLod(noise_tile, noise_at, 0.0);
    ++texture_samples;
    if (frame.look.erosion > 0.0) density = erode(frame.look, density, noise);
    if (kHoles != kHolesNone)
      density *= remaining_after_holes(ray.holes, t, p_world, 2.0 * noise.g - 1.0, density > 0.0);
  }
  return MediumSample(density, uvw, smoke.light_offset);
}

vec3 medium_inscatter(MediumRay ray, MediumSample here, inout uint texture_samples) {
  ++texture_samples;
  return textureLod(inscatter_atlas, here.uvw + here.light_offset * ray.texel, 0.0).rgb;
}

#endif
