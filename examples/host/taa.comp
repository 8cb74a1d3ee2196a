// Plain temporal anti-aliasing: a tenth of the frame, and the rest of what the frames before showed of the same point,
// within the range of the pixel's neighbours.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D picture;
layout(binding = 1) uniform sampler2D depth;
layout(binding = 2) uniform sampler2D smoke;   // brume_renderer_smoke
layout(binding = 3) uniform sampler2D motion;  // brume_renderer_motion
layout(binding = 4) uniform sampler2D history;
layout(binding = 5, rgba16f) uniform writeonly image2D shown;
layout(push_constant) uniform Push {
  mat4 before_from_now;  // from this frame's clip space to the one of the frame before, both without jitter
  vec2 jitter;           // [px]
  uint follows_smoke;
  uint has_history;
} push;

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(shown);
  if (any(greaterThanEqual(at, size))) return;
  const vec3 now = texelFetch(picture, at, 0).rgb;
  vec3 least = now, most = now;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const vec3 beside = texelFetch(picture, clamp(at + ivec2(x, y), ivec2(0), size - 1), 0).rgb;
      least = min(least, beside);
      most = max(most, beside);
    }

  // To where the surface was.
  const vec2 middle = vec2(at) + 0.5, sample_at = middle + push.jitter;
  const vec2 clip = sample_at / vec2(size) * 2.0 - 1.0;
  const vec4 before = push.before_from_now * vec4(clip, texelFetch(depth, at, 0).r, 1.0);
  vec2 from = middle + (before.xy / before.w * 0.5 + 0.5) * vec2(size) - sample_at;
  float weight = 0.1;

  // To where the smoke was, if it hides more than half of the surface; and less history, the more it hides.
  if (push.follows_smoke != 0u) {
    const float opacity = 1.0 - texelFetch(smoke, at, 0).a;
    if (opacity > 0.5) from = middle + texelFetch(motion, at, 0).rg;
    weight = mix(weight, 0.3, opacity);
  }
  const vec2 uv = from / vec2(size);
  if (push.has_history == 0u || any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) weight = 1.0;
  const vec3 past = clamp(textureLod(history, uv, 0.0).rgb, least, most);
  imageStore(shown, at, vec4(mix(past, now, weight), 1.0));
}
