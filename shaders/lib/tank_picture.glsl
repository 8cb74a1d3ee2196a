// The pixels of a picture of a tank: the mean of its samples.
#ifndef TANK_PICTURE_GLSL
#define TANK_PICTURE_GLSL
#include "lib/tank.glsl"
#include "lib/tank_samples.glsl"
#include "shared/average.h"
#include "shared/display.h"

layout(binding = kBindRadiance, rgba16f) uniform writeonly image2D radiance_image;
layout(binding = kBindRadianceSum, rgba32f) uniform image2D sum_image;
layout(push_constant, scalar) uniform Samples { TankSamples samples; };

/// Of this thread.
ivec2 sampled_pixel() {
  return ivec2(gl_GlobalInvocationID.xy) + ivec2(0, samples.first_row);
}

/// Of the samples of a pixel so far. Further ones are added to it one by one: the same bits in whatever portions they
/// come.
vec3 sum_so_far(ivec2 px) {
  return samples.first > 0u ? imageLoad(sum_image, px).rgb : vec3(0.0);
}

/// Writes the sum of a pixel, and the mean.
void store_sum(ivec2 px, vec3 sum) {
  imageStore(sum_image, px, vec4(sum, 1.0));
  imageStore(radiance_image, px, vec4(min(sum / float(samples.first + samples.count), 65504.0), 1.0));
}

/// The camera's ray of a sample, anywhere in its pixel and on the lens. The first of a pinhole is in the middle.
void sample_camera(inout SampleSource source, out vec3 origin, out vec3 direction) {
  const vec2 in_pixel = next_point(source), u = next_point(source);
  vec2 on_lens = vec2(0.0);
  if (tank.camera.aperture > 0.0)
    on_lens = tank.camera.lens_points == kLensRejection
                  ? lens_point_by_rejection(tank.camera.blades, uvec3(source.px, source.index * 64u))
                  : lens_point(tank.camera.blades, u);
  tank_camera_ray(vec2(source.px) + in_pixel, on_lens, origin, direction);
}

#endif
