// Enlarges an image along its edges: a Lanczos kernel that is long along the local edge and narrow across it,
// after "FidelityFX Super Resolution 1.0", EASU (Lottes, AMD, 2021), with its 12 texels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/upscale.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindUpscaleSource) uniform sampler2D source;
layout(binding = kBindUpscaleTarget, rgba8) uniform writeonly image2D target;
layout(push_constant, scalar) uniform Constants { UpscaleConstants constants; };

vec3 texel(ivec2 at) {
  return texelFetch(source, clamp(at, ivec2(0), ivec2(constants.source_px) - 1), 0).rgb;
}

float luma(vec3 colour) {
  return dot(colour, vec3(0.25, 0.5, 0.25));
}

// Adds the gradient at one of the four texels around the sample, from its cross of lumas, and how much of an
// edge it is: 1 for a step, 0 for a thin line, whose kernel must not be longer than the line is wide.
void add_gradient(inout vec2 direction, inout float edge, float weight, float up, float left, float middle,
                  float right, float down) {
  const vec2 gradient = vec2(right - left, down - up);
  const vec2 steps = max(abs(vec2(right - middle, down - middle)), abs(vec2(middle - left, middle - up)));
  const vec2 straight = clamp(abs(gradient) / max(steps, vec2(1.0 / 1024.0)), 0.0, 1.0);
  direction += weight * gradient;
  edge += 0.5 * weight * dot(straight, straight);
}

// The approximation of Lanczos-2 that needs no sine: (25/16 (2/5 x^2 - 1)^2 - 9/16) (lobe x^2 - 1)^2.
float kernel(float square, float lobe, float limit) {
  const float x2 = min(square, limit);
  const float a = 0.4 * x2 - 1.0, b = lobe * x2 - 1.0;
  return (25.0 / 16.0 * a * a - 9.0 / 16.0) * b * b;
}

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), constants.target_px))) return;
  const vec2 at = (vec2(px) + 0.5) * vec2(constants.source_px) / vec2(constants.target_px) - 0.5;
  const ivec2 first = ivec2(floor(at));
  const vec2 f = at - vec2(first);

  // The texels of a 4x4 square without its corners, and their luma.
  vec3 colours[16];
  float lumas[16];
  for (int i = 0; i < 16; ++i) {
    colours[i] = texel(first + ivec2(i & 3, i >> 2) - 1);
    lumas[i] = luma(colours[i]);
  }

  // The edge at the sample.
  vec2 direction = vec2(0);
  float edge = 0.0;
  for (int i = 0; i < 4; ++i) {
    const ivec2 corner = ivec2(i & 1, i >> 1);
    const vec2 near = mix(1.0 - f, f, vec2(corner));
    const int c = 5 + corner.x + 4 * corner.y;
    add_gradient(direction, edge, near.x * near.y, lumas[c - 4], lumas[c - 1], lumas[c], lumas[c + 1],
                 lumas[c + 4]);
  }
  const float square = dot(direction, direction);
  direction = square < 1.0 / 32768.0 ? vec2(1, 0) : direction * inversesqrt(square);
  edge *= edge;

  // A kernel along it.
  const float diagonal = 1.0 / max(abs(direction.x), abs(direction.y));
  const vec2 stretch = vec2(1.0 + (diagonal - 1.0) * edge, 1.0 - 0.5 * edge);
  const float lobe = 0.5 - 0.29 * edge;
  vec3 sum = vec3(0);
  float weights = 0.0;
  for (int i = 0; i < 16; ++i) {
    if (i == 0 || i == 3 || i == 12 || i == 15) continue;
    const vec2 offset = vec2(i & 3, i >> 2) - 1.0 - f;
    const vec2 turned = vec2(dot(offset, direction), dot(offset, vec2(-direction.y, direction.x))) * stretch;
    const float weight = kernel(dot(turned, turned), lobe, 1.0 / lobe);
    sum += weight * colours[i];
    weights += weight;
  }

  // Without ringing: within the four texels around the sample.
  const vec3 low = min(min(colours[5], colours[6]), min(colours[9], colours[10]));
  const vec3 high = max(max(colours[5], colours[6]), max(colours[9], colours[10]));
  imageStore(target, px, vec4(clamp(sum / weights, low, high), 1.0));
}
