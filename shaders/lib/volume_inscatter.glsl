// Light that volumes besides the smoke scatter at a sample (shared/volume_light.h). The includer defines the
// constant kMedia.
#ifndef VOLUME_INSCATTER_GLSL
#define VOLUME_INSCATTER_GLSL
#include "lib/frame.glsl"
#include "lib/volume_transfer.glsl"
#include "shared/media.h"
#include "shared/phase.h"
#include "shared/volume_light.h"

const bool kHasSun = (kMedia & kMediumSun) != 0u, kHasDense = (kMedia & kMediumDense) != 0u;

layout(binding = kBindVolumeLight) uniform sampler3D volume_light;
layout(binding = kBindSunDepths) uniform sampler3D sun_depths;

/// Phase function of the sun's light towards the eye.
float volume_phase(uint i, WorldRay world) {
  return henyey_greenstein(volumes[i].look.anisotropy, dot(frame.media.to_sun, world.direction));
}

/// Texels of a volume's cube of light per voxel, and of its bounds' low corner.
vec3 light_per_voxel(uint i, float edge) { return edge / (volumes[i].bounds_max - volumes[i].bounds_min); }
vec3 light_first(uint i, float edge) {
  return vec3(0.0, 0.0, float(i) * edge) - volumes[i].bounds_min * light_per_voxel(i, edge);
}

/// Where the samples of the cubes of light are read [texels].
struct LightTexels {
  vec3 light, sun;
};

/// The texel of cube i of an image of cubes along z, in texture coordinates.
vec3 in_cube(uint i, vec3 texel, vec3 size) {
  const vec3 first = vec3(0.0, 0.0, float(i) * size.y);
  return clamp(texel, first + 0.5, first + size.y - 0.5) / size;
}

/// Radiance towards the eye that a volume scatters, per extinction.
vec3 volume_inscatter(vec3 albedo, uint i, LightTexels at, float phase) {
  vec4 light = textureLod(volume_light, in_cube(i, at.light, vec3(textureSize(volume_light, 0))), 0.0);
  if (kHasAlbedos) light.rgb *= albedo;
  if (!kHasSun) return light.rgb;
  const vec3 size = vec3(textureSize(sun_depths, 0));
  // The light of dense volumes includes it.
  const bool is_dense = kHasDense && volumes[i].is_dense != 0u;
  const float depth = is_dense ? 0.0 : textureLod(sun_depths, in_cube(i, at.sun, size), 0.0).r;
  const float arrives = light.a * exp(-depth);
  return light.rgb + albedo * frame.media.sun_irradiance * (arrives * phase);
}

#endif
