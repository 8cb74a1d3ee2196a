// The pixels of a picture of a tank: the mean of its samples. What is behind the tank is in tank_over_air.glsl and
// tank_over_surfaces.glsl.
#ifndef TANK_PICTURE_GLSL
#define TANK_PICTURE_GLSL
#include "lib/tank_glass.glsl"
#include "lib/tank_samples.glsl"
#include "shared/average.h"
#include "shared/display.h"

layout(binding = kBindRadiance, rgba16f) uniform writeonly image2D radiance_image;
layout(binding = kBindRadianceSum, rgba32f) uniform image2D sum_image;
layout(push_constant, scalar) uniform Samples { TankSamples samples; };

/// What a path brings: radiance, and which fraction of that of the frame's surfaces behind the tank.
struct Seen {
  vec3 radiance;
  float transmittance;
};

void add(inout Seen sum, Seen more) {
  sum.radiance += more.radiance;
  sum.transmittance += more.transmittance;
}

/// The pixel of this thread.
ivec2 sampled_pixel() {
  return ivec2(gl_GlobalInvocationID.xy) + ivec2(0, samples.first_row);
}

/// The sum of a pixel's samples so far. Further ones are added to it one by one: the same bits in whatever portions
/// they come.
Seen sum_so_far(ivec2 px) {
  if (samples.first == 0u) return Seen(vec3(0.0), 0.0);
  const vec4 sum = imageLoad(sum_image, px);
  return Seen(sum.rgb, sum.a);
}

/// Writes the sum of a pixel, and the mean.
void store_sum(ivec2 px, Seen sum) {
  const float count = float(samples.first + samples.count);
  imageStore(sum_image, px, vec4(sum.radiance, sum.transmittance));
  imageStore(radiance_image, px, vec4(min(sum.radiance / count, 65504.0), sum.transmittance / count));
}

/// The random points of the i-th sample of this dispatch.
SampleSource sample_source(ivec2 px, uint i) {
  return SampleSource(px, samples.index + samples.first + i, 0u);
}

/// The camera's ray of a sample, anywhere in its pixel unless all are in the middle, and anywhere on the lens.
void sample_camera(inout SampleSource source, out vec3 origin, out vec3 direction) {
  const vec2 in_pixel = next_point(source), u = next_point(source);
  vec2 on_lens = vec2(0.0);
  if (tank.camera.aperture > 0.0)
    on_lens = tank.camera.lens_points == kLensRejection
                  ? lens_point_by_rejection(tank.camera.blades, uvec3(source.px, source.index * 64u))
                  : lens_point(tank.camera.blades, u);
  tank_camera_ray(vec2(source.px) + (tank.in_middle != 0u ? vec2(0.5) : in_pixel), on_lens, origin, direction);
}

#endif
