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
#include "lib/image_part.glsl"
#include "lib/slice_texture.glsl"
#include "lib/low_discrepancy.glsl"
#include "shared/decal.h"
#include "shared/gbuffer.h"

const uint kGroup = 8u;
layout(local_size_x = kGroup, local_size_y = kGroup) in;
layout(binding = kBindDepth) uniform sampler2D depth;
layout(binding = kBindNormalMetallic) uniform sampler2D normal_metallic;
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

/// How the occlusion of planes that face up and down adds up to that of a surface with another normal.
///
/// With V = 1 in directions w that are hidden, and integrals over the sphere divided by pi, it is half of the integrals
/// of V |w n| and of V w n. Their values for n = up are the sum and the difference of both planes. The horizontal part
/// of the second follows from where what hides is: V w is about W d, and V |w n| about W sqrt((d n)^2 + s^2), in the
/// direction d of its middle, with the spread s = radius / distance. W follows from the sum.
vec2 weights_of_planes(Decal decal, vec3 p_world, vec3 normal) {
  const float facing = dot(normal, decal.up_world);
  float half_sum = 0.5;
  if (decal.radius > 0.0) {
    const vec3 to_middle = decal.middle_world - p_world;
    const float along = dot(to_middle, normal), above = dot(to_middle, decal.up_world);
    const float spread = max(min(decal.radius * decal.radius, dot(to_middle, to_middle)), 1e-12);
    half_sum = 0.5 * (sqrt(along * along + spread) + along - facing * above) * inversesqrt(above * above + spread);
  }
  return half_sum + vec2(0.5, -0.5) * facing;
}

/// What samples around a point of the box have in common.
struct Curve {
  vec2 weights;    // of what faces up and down
  float exponent;
  float strength;  // less towards the sides of the box
};

Curve curve_at(Decal decal, vec3 uvw, vec2 weights) {
  const vec3 rim = clamp(min(uvw, 1.0 - uvw) / max(decal.fade, 1e-4), 0.0, 1.0);
  const vec3 fade = rim * rim * (3.0 - 2.0 * rim);
  const float exponent = decal.gamma_off == 0.0 ? 1.0 : occlusion_exponent(decal.gamma_off, decal.falloff, uvw.y);
  return Curve(weights, exponent, decal.strength * (fade.x * fade.y * fade.z));
}

/// The occlusion at a point.
float occlusion_at(Decal decal, vec3 uvw, Curve curve) {
  const vec2 both = slice_texture_sample(slice_textures, decal.occlusion, uvw).rg;
  const float occluded = max(dot(both, curve.weights), 0.0);
  const float powered = curve.exponent == 1.0 ? occluded : occluded > 0.0 ? pow(occluded, curve.exponent) : 0.0;
  return min(powered, 1.0) * curve.strength;
}

/// What remains of the light of a surface beside all decals: at its own place, and as the mean of scattered samples.
struct Remaining {
  float exact, scattered;
};

/// Of which points of the R3 sequence (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences") a pixel
/// takes its samples, shifted by its noise.
struct Scatter {
  vec3 noise;
  uint first, count;
};

void add_decal(Decal decal, vec3 p_world, vec3 normal, Scatter scatter, inout Remaining remaining) {
  const vec3 uvw = matrix_of(decal.uvw_from_world) * vec4(p_world, 1.0);
  if (any(lessThan(uvw, vec3(0.0))) || any(greaterThan(uvw, vec3(1.0)))) return;
  const Curve curve = curve_at(decal, uvw, weights_of_planes(decal, p_world, normal));
  const float exact = occlusion_at(decal, uvw, curve);
  remaining.exact *= 1.0 - exact;
  if (decal.scatter == vec3(0.0)) {
    remaining.scattered *= 1.0 - exact;
    return;
  }
  float sum = 0.0;
  for (uint i = scatter.first; i < scatter.first + scatter.count; ++i) {
    const vec3 offset = lattice_point(i, scatter.noise) - 0.5;
    sum += occlusion_at(decal, uvw + offset * decal.scatter, curve);
  }
  remaining.scattered *= 1.0 - sum / float(scatter.count);
}

/// The past at a surface.
struct Past {
  float occlusion;
  float samples;  // of how many it is the mean; 0: there is no past
  float spread;   // how far samples were from the surface's own value: their mean
};

/// That of a surface that has not moved: what the frame before stored.
Past past_at(vec3 p_world) {
  const Past nothing = Past(0.0, 0.0, 0.0);
  if (params.past_frames == 0u) return nothing;
  const vec4 seen = params.past_from_world * vec4(p_world, 1.0);
  if (seen.w <= frame.camera.near_z) return nothing;
  const vec2 uv = seen.xy / seen.z * 0.5 + 0.5;
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) return nothing;
  const vec4 past =
      textureLod(past_occlusion, uv_of_part(uv, params.past_size_px, textureSize(past_occlusion, 0)), 0.0);
  // Another surface was there.
  if (abs(past.b - seen.w) > 0.01 * seen.w) return nothing;
  return Past(past.r, past.g, past.a);
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
  const vec3 p_world = camera_point(frame.camera, vec2(px) + 0.5, frame.size_px, z);
  // What moves is what decals are baked of.
  const vec4 n = inside ? texelFetch(normal_metallic, px, 0) : vec4(0.0);
  const bool receives = d > 0.0 && !moves_of(n.a);

  // This frame.
  Past past = Past(0.0, 0.0, 0.0);
  Remaining remaining = Remaining(1.0, 1.0);
  uint samples = kDecalSamples;
  const uint mask = decals_of_tile(receives, p_world);
  if (receives && mask != 0u) {
    past = past_at(p_world);
    if (past.samples > 0.0) samples = 1u;
    const uint first = params.past_frames != 0u ? params.past_frames : frame.frame_index * kDecalSamples;
    // Floats hold the multiples of R3 up to the 8191st well enough.
    const Scatter scatter = Scatter(blue_noise(blue_noise_tile, px, 0u).rgb, first & 8191u, samples);
    const vec3 normal = normalize(n.xyz);
    for (uint left = mask; left != 0u; left &= left - 1u)
      add_decal(decals[findLSB(left)], p_world, normal, scatter, remaining);
  }

  // The frames before, as far from the surface's own value as samples usually are: nothing trails behind a carrier. By
  // how far they are in this frame alone, a sample that is close would discard the mean.
  const float exact = 1.0 - remaining.exact, scattered = 1.0 - remaining.scattered;
  const float apart = abs(scattered - exact);
  const float usual = exact == 0.0 && scattered == 0.0 ? 0.0 : max(apart, 2.0 * past.spread);
  const float count = min(past.samples + float(samples), kDecalMeanSamples);
  const float weight = float(samples) / count, off = usual + 1.0 / 255.0;
  const float mean = mix(clamp(past.occlusion, exact - off, exact + off), scattered, weight);
  // Finite where there is no surface, too: a filter multiplies it by 0.
  const float distance = d > 0.0 ? z : 0.0;
  if (inside) imageStore(occlusion_image, px, vec4(mean, count, distance, mix(past.spread, apart, weight)));
}
