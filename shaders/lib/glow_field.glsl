// Light of what glows in a volume, in the volume itself (shared/glow_field.h). The includer has the volumes.
#ifndef GLOW_FIELD_GLSL
#define GLOW_FIELD_GLSL
#include "shared/glow_field.h"
#include "shared/volume.h"

layout(binding = kBindGlowField) uniform sampler3D glow_field;

/// Mean radiance over all directions at a point of a volume that glows: kGlowStraight or kGlowScattered of it.
vec3 own_glow(uint volume, uint part, vec3 p_voxel) {
  const vec3 low = volumes[volume].bounds_min, size = volumes[volume].bounds_max - low;
  const float edge = float(kGlowEdge);
  const vec3 texel = clamp((p_voxel - low) / size * edge, vec3(0.5), vec3(edge - 0.5));
  return textureLod(glow_field, (texel + edge * vec3(part, 0u, volume)) / vec3(textureSize(glow_field, 0)), 0.0).rgb;
}

#endif
