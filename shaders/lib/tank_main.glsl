// The samples of a pixel. Who includes it has path_seen and first_hit, and what is behind the tank.
#ifndef TANK_MAIN_GLSL
#define TANK_MAIN_GLSL
#include "lib/tank_picture.glsl"

void main() {
  const ivec2 px = sampled_pixel();
  if (any(greaterThanEqual(uvec2(px), tank.size_px))) return;
  Seen sum = sum_so_far(px);
  const float surface = surface_distance(px);
  for (uint i = 0u; i < samples.count; ++i) {
    SampleSource source = sample_source(px, i);
    vec3 origin, direction;
    sample_camera(source, origin, direction);
    add(sum, path_seen(origin, direction, along_ray(surface, direction), source));
  }
  store_sum(px, sum);
  if (kIsSurface) {
    vec3 origin, direction;
    tank_camera_ray(vec2(px) + 0.5, vec2(0.0), origin, direction);
    store_surface(px, direction, first_hit(px, origin, direction, along_ray(surface, direction)));
  }
}

#endif
