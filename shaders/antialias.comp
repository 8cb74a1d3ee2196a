// Temporal antialiasing: the mean of this frame and of previous ones, each of which shows another point of every pixel,
// where they still match (Karis 2014, "High-Quality Temporal Supersampling").
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/camera.glsl"
#include "lib/smoke_distance.glsl"
#include "lib/upsample.glsl"
#include "shared/antialias.h"
#include "shared/display.h"
#include "shared/gbuffer.h"

const int kGroup = 8, kTile = kGroup + 2;
layout(local_size_x = kGroup, local_size_y = kGroup) in;
layout(binding = kBindDepth) uniform sampler2D depth;
layout(binding = kBindSmoke) uniform sampler2D smoke;
layout(binding = kBindRadiance) uniform sampler2D radiance;
layout(binding = kBindPastRadiance) uniform sampler2D past_radiance;
layout(binding = kBindMeanRadiance, rgba16f) uniform writeonly image2D mean_radiance;
layout(scalar, push_constant) uniform Push { AntialiasParams params; };

/// The group's pixels and those around them: colour and reverse depth.
shared vec4 tile[kTile * kTile];

// Means are of colours compressed to [0, 1): otherwise one bright sample outweighs all others, and edges of lights stay
// jagged. YCoCg separates luminance from chroma, which bounds of a neighbourhood fit more tightly.
vec3 compressed(vec3 radiance) {
  const vec3 x = min(radiance, 65504.0) * frame.exposure;
  const vec3 c = x / (1.0 + max(x.r, max(x.g, x.b)));
  return vec3(dot(c, vec3(0.25, 0.5, 0.25)), 0.5 * (c.r - c.b), dot(c, vec3(-0.25, 0.5, -0.25)));
}
vec3 expanded(vec3 ycocg) {
  const float base = ycocg.x - ycocg.z;
  const vec3 c = clamp(vec3(base + ycocg.y, ycocg.x + ycocg.z, base - ycocg.y), 0.0, 0.9999);
  return c / ((1.0 - max(c.r, max(c.g, c.b))) * frame.exposure);
}

void load_tile() {
  const ivec2 first = ivec2(gl_WorkGroupID.xy) * kGroup - 1;
  for (int i = int(gl_LocalInvocationIndex); i < kTile * kTile; i += kGroup * kGroup) {
    const ivec2 px = clamp(first + ivec2(i % kTile, i / kTile), ivec2(0), ivec2(frame.size_px) - 1);
    tile[i] = vec4(compressed(texelFetch(radiance, px, 0).rgb), texelFetch(depth, px, 0).r);
  }
  barrier();
}

/// Mean and standard deviation around a pixel, and the reverse depth of the nearest surface there: the background
/// beside an edge moves with the edge.
struct Neighbourhood {
  vec3 mean, deviation;
  float depth;
};

Neighbourhood neighbourhood_of(int centre) {
  vec3 sum = vec3(0.0), squares = vec3(0.0);
  float nearest = 0.0;
  for (int i = 0; i < 9; ++i) {
    const vec4 texel = tile[centre + (i / 3 - 1) * kTile + i % 3 - 1];
    sum += texel.rgb;
    squares += texel.rgb * texel.rgb;
    nearest = max(nearest, texel.a);
  }
  const vec3 mean = sum / 9.0;
  return Neighbourhood(mean, sqrt(max(squares / 9.0 - mean * mean, vec3(0.0))), nearest);
}

/// The previous result at a point of the image by Catmull-Rom weights, which keep it sharp, without the corners of the
/// 4 x 4 texels: five bilinear samples (Jimenez 2016, "Filmic SMAA").
vec4 past_at(vec2 uv) {
  const vec2 size = vec2(frame.size_px), at = uv * size - 0.5, whole = floor(at), f = at - whole;
  const vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f)), w1 = 1.0 + f * f * (1.5 * f - 2.5);
  const vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f)), w3 = f * f * (0.5 * f - 0.5), w12 = w1 + w2;
  const vec2 p0 = (whole - 0.5) / size, p12 = (whole + 0.5 + w2 / w12) / size, p3 = (whole + 2.5) / size;
  const vec4 sum = textureLod(past_radiance, vec2(p12.x, p0.y), 0.0) * (w12.x * w0.y) +
                   textureLod(past_radiance, vec2(p0.x, p12.y), 0.0) * (w0.x * w12.y) +
                   textureLod(past_radiance, p12, 0.0) * (w12.x * w12.y) +
                   textureLod(past_radiance, vec2(p3.x, p12.y), 0.0) * (w3.x * w12.y) +
                   textureLod(past_radiance, vec2(p12.x, p3.y), 0.0) * (w12.x * w3.y);
  return max(sum / (w12.x * w0.y + w0.x * w12.y + w12.x * w12.y + w3.x * w12.y + w12.x * w3.y), vec4(0.0));
}

/// Where the previous frame showed what a pixel shows now; outside of [0, 1)^2 where it did not.
vec2 past_uv(ivec2 px, float nearest_depth) {
  const vec3 ray = camera_ray(frame.camera, vec2(px) + 0.5 - params.jitter, frame.size_px);
  const float transmittance = texelFetch(smoke, px, 0).a;
  const vec3 eye = frame.camera.eye_world;
  const float z = transmittance < 0.5
                      ? smoke_distance(eye, ray, distance_in_smoke(frame, nearest_depth), transmittance)
                      : view_distance(frame.camera, nearest_depth);
  const vec4 clip = params.past_clip_from_world * vec4(eye + z * ray, 1.0);
  return params.has_past != 0u && clip.w > frame.camera.near_z ? clip.xy / clip.w * 0.5 + 0.5 : vec2(-1.0);
}

void main() {
  load_tile();
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(px, ivec2(frame.size_px)))) return;
  const int centre = (int(gl_LocalInvocationID.y) + 1) * kTile + int(gl_LocalInvocationID.x) + 1;
  const vec3 here = tile[centre].rgb;
  const Neighbourhood around = neighbourhood_of(centre);
  const vec2 uv = past_uv(px, around.depth);
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) {
    imageStore(mean_radiance, px, vec4(texelFetch(radiance, px, 0).rgb, 1.0));
    return;
  }
  // Clamps the past to plausible values (variance clipping, Salvi 2016, "An Excursion in Temporal Supersampling"):
  // smoke that closed, or a body that left, disappears at once. The further the clamp moves it, the less it counts.
  const vec4 past = past_at(uv);
  const vec3 past_color = compressed(past.rgb);
  const vec3 low = min(around.mean - around.deviation, here), high = max(around.mean + around.deviation, here);
  const vec3 plausible = clamp(past_color, low, high);
  const vec3 moved = abs(plausible - past_color) / (high - low + 1.0 / 255.0);
  const float fits = 1.0 / (1.0 + max(moved.x, max(moved.y, moved.z)));
  // In motion every frame reads the past between its pixels, which blurs it a little more each time.
  const float way_px = distance(uv * vec2(frame.size_px), vec2(px) + 0.5);
  const float most = mix(kAntialiasedFrames, kAntialiasedFramesInMotion, min(way_px, 1.0));
  const float frames = min(past.a * fits + 1.0, most);
  imageStore(mean_radiance, px, vec4(expanded(mix(plausible, here, 1.0 / frames)), frames));
}
