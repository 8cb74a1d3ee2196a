// Debug views of a slice through the world: density of the smoke, or its light.
#ifndef SLICE_VIEW_GLSL
#define SLICE_VIEW_GLSL
#include "lib/smoke_density.glsl"
#include "lib/tone.glsl"
#include "lib/view_pixel.glsl"
#include "lib/voxel_rays.glsl"

layout(binding = kBindInscatter) uniform sampler3D inscatter_atlas;

/// Smoke of a slot's brick at a point of the slice, over the colour of the slice.
vec3 smoke_on_slice(uint slot, vec3 local_voxel, vec3 colour) {
  const vec3 texel = frame.smoke.bricks.atlas_texel;
  const vec3 uvw = (atlas_corner(frame.smoke.bricks, slot) + local_voxel) * texel;
  const BrickSample here = sample_brick(slot, local_voxel, uvw);
  if (kView == kViewDensity) return density_colour(here.density, colour);
  const vec3 light = textureLod(inscatter_atlas, uvw + here.light_offset * texel, 0.0).rgb * frame.look.albedo;
  return mix(colour, srgb_from_linear(tone_curve(light * frame.exposure)), smoothstep(0.0, 0.06, here.density));
}

vec3 slice_view(ViewPixel pixel) {
  const vec3 behind = dimmed_scene(pixel);
  const int axis = params.slice_axis;
  const float t = slice_distance(pixel);
  vec3 p_voxel = eye_voxel() + pixel.direction * (t / params.voxel_size);
  // Exactly on the slice, so that every pixel finds the same layer of voxels.
  p_voxel[axis] = (params.slice_world - params.grid_origin_world[axis]) / params.voxel_size;
  const bool in_grid = all(greaterThanEqual(p_voxel, vec3(0.0))) && all(lessThan(p_voxel, vec3(params.grid_size)));
  if (!(t > 0.0 && t < 1e6 && in_grid)) return behind;

  const ivec3 voxel = ivec3(p_voxel);
  const float width = pixel_voxels(pixel, t, abs(pixel.direction[axis]));
  const vec2 f = fract(axis == 0 ? p_voxel.yz : axis == 1 ? p_voxel.xz : p_voxel.xy);
  const float line = grid_line(f, width);
  vec3 colour = slice_air(line, behind);
  const ivec3 brick = voxel >> 3;
  const uint slot = smoke_brick(brick);
  if (voxel_at(voxel) != 0u) {
    colour = slice_wall(line);
  } else if (slot != kNoSlot) {
    colour = smoke_on_slice(slot, p_voxel - vec3(brick * kBrickVoxels), colour);
  }
  return over_surface(pixel, t, behind, colour);
}

#endif
