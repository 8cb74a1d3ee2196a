// Occlusion by decals, volumes of baked occlusion that follow their carriers: what fraction of its light each surface
// loses. Noise scatters the samples; the mean of the frames before smooths them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "lib/frame.glsl"
#include "lib/blue_noise.glsl"
#include "lib/camera.glsl"
#include "lib/slice_texture.glsl"
#include "shared/decal.h"
#include "shared/gbuffer.h"

const uint kGroup = 8u;
layout(local_size_x = kGroup, local_size_y = kGroup) in;
layout(binding = kBindDepth) uniform sampler2D depth;
layout(binding = kBindNormalMetallic) uniform sampler2D normal_metallic;
layout(binding = kBindEmission) uniform sampler2D emission;
layout(binding = kBindBlueNoise) uniform sampler2D blue_noise_tile;
layout(binding = kBindSliceTextures) uniform sampler2D slice_textures;
layout(scalar, binding = kBindDecals) readonly buffer Decals { Decal decals[]; };
layout(binding = kBindPastOcclusion) uniform sampler2D past_occlusion;
layout(binding = kBindOcclusion, rgba16f) uniform writeonly image2D occlusion_image;
layout(scalar, push_constant) uniform Push { DecalParams params; };

/// Decals that may darken a surface of the tile, of those from `first` on: 32 at most, one bit each. A tile is a
/// subgroup, each thread of which tests a decal.
uint decals_of_tile(bool receives, vec3 p_world) {
  const vec3 nothing = vec3(1e30);
  const vec3 low = subgroupMin(receives ? p_world : nothing), high = subgroupMax(receives ? p_world : -nothing);
  uint mask = 0u;
  for (uint done = 0u; done < params.decal_count; done += gl_SubgroupSize) {
    const uint i = done + gl_SubgroupInvocationID;
    const Decal decal = decals[min(i, params.decal_count - 1u)];
    const bool meets = all(lessThanEqual(low, decal.high_world)) && all(greaterThanEqual(high, decal.low_world));
    mask |= subgroupBallot(i < params.decal_count && meets).x << done;
  }
  return mask;
}

/// The occlusion of a surface that faces `up` (1: as the planes of the first channel) at a point of the box.
float occlusion_at(Decal decal, vec3 uvw, float up) {
  const vec2 both = slice_texture_sample(slice_textures, decal.occlusion, uvw).rg;
  const float occluded = max(mix(both.g, both.r, up), 0.0);
  if (occluded == 0.0) return 0.0;
  const vec3 rim = clamp(min(uvw, 1.0 - uvw) / max(decal.fade, 1e-4), 0.0, 1.0);
  const vec3 fade = rim * rim * (3.0 - 2.0 * rim);
  return min(pow(occluded, occlusion_exponent(decal.gamma_off, decal.falloff, uvw.y)), 1.0) * decal.strength *
         (fade.x * fade.y * fade.z);
}

/// What remains of the light of a surface beside all decals: at its own place, and as the mean of scattered samples.
struct Remaining {
  float exact, scattered;
};

void add_decal(Decal decal, vec3 p_world, vec3 normal, vec4 noise, uint samples, inout Remaining remaining) {
  const vec3 uvw = decal.uvw_from_world * vec4(p_world, 1.0);
  const vec3 reach = 0.5 * decal.scatter;
  if (any(lessThan(uvw, -reach)) || any(greaterThan(uvw, 1.0 + reach))) return;
  const float up = 0.5 + 0.5 * dot(normal, decal.up_world);
  const float exact = occlusion_at(decal, uvw, up);
  remaining.exact *= 1.0 - exact;
  if (decal.scatter == vec3(0.0)) {
    remaining.scattered *= 1.0 - exact;
    return;
  }
  // Points of the R3 sequence (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
  float sum = 0.0;
  for (uint i = 0u; i < samples; ++i) {
    const vec3 offset = fract(noise.rgb + float(i) * vec3(0.8191725134, 0.6710436067, 0.5497004779)) - 0.5;
    sum += occlusion_at(decal, uvw + offset * decal.scatter, up);
  }
  remaining.scattered *= 1.0 - sum / float(samples);
}

/// The occlusion of the frame before at a surface that has not moved, and of how many frames it is the mean; 0: none.
vec2 past_at(vec3 p_world) {
  if (params.has_past == 0u) return vec2(0.0);
  const vec4 clip = params.past_clip_from_world * vec4(p_world, 1.0);
  if (clip.w <= frame.camera.near_z) return vec2(0.0);
  const vec2 uv = clip.xy / clip.w * 0.5 + 0.5;
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) return vec2(0.0);
  const vec4 past = textureLod(past_occlusion, uv, 0.0);
  // Another surface was there.
  if (abs(past.b - clip.w) > 0.01 * clip.w) return vec2(0.0);
  return past.rg;
}

void main() {
  // Z order: the pixels of a subgroup of any size are close together.
  const uint i = gl_LocalInvocationIndex;
  const uvec2 in_group =
      uvec2((i & 1u) | (i >> 1u & 2u) | (i >> 2u & 4u), (i >> 1u & 1u) | (i >> 2u & 2u) | (i >> 3u & 4u));
  const ivec2 px = ivec2(kGroup * gl_WorkGroupID.xy + in_group);
  const bool inside = all(lessThan(uvec2(px), frame.size_px));
  const float d = inside ? texelFetch(depth, px, 0).r : 0.0;
  const float z = view_distance(frame.camera, d);
  const vec3 p_world = frame.camera.eye_world + z * camera_ray(frame.camera, vec2(px) + 0.5, frame.size_px);
  // What moves is what decals are baked of.
  const bool receives = d > 0.0 && texelFetch(emission, px, 0).a == 0.0;

  // This frame.
  Remaining remaining = Remaining(1.0, 1.0);
  const uint mask = decals_of_tile(receives, p_world);
  if (receives && mask != 0u) {
    const vec3 normal = normalize(texelFetch(normal_metallic, px, 0).xyz);
    const vec4 noise = blue_noise(blue_noise_tile, px, frame.frame_index);
    const uint samples = params.has_past != 0u ? 1u : kDecalSamples;
    for (uint left = mask; left != 0u; left &= left - 1u)
      add_decal(decals[findLSB(left)], p_world, normal, noise, samples, remaining);
  }

  // The frames before, as far from the surface's own value as scattering brings it: nothing trails behind a carrier.
  const float exact = 1.0 - remaining.exact, scattered = 1.0 - remaining.scattered;
  const vec2 past = receives ? past_at(p_world) : vec2(0.0);
  const float off = abs(scattered - exact) + 1.0 / 255.0;
  const float frames = min(past.g + 1.0, kDecalFrames);
  const float mean = mix(clamp(past.r, exact - off, exact + off), scattered, 1.0 / frames);
  if (inside) imageStore(occlusion_image, px, vec4(mean, frames, z, 0.0));
}
