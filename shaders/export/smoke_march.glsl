// Smoke along a ray, with your light: to be included after smoke.glsl and a function of yours,
//
//   vec3 brume_light(vec3 position, vec3 texel, vec3 direction)
//
// the radiance that opaque smoke at a point would send to the eye: a sum over your lights of brume_scattered, for
// example. `direction` is that of the ray. `texel` is the point in the textures of bricks, off the walls, for
// brume_light_at and brume_sky_at.
#ifndef BRUME_SMOKE_MARCH_GLSL
#define BRUME_SMOKE_MARCH_GLSL

// Radiance of the smoke along a ray in rgb, and in a what it lets through. `t_end`: distance of the surface behind [m].
// `jitter` in [0, 1): where samples are in their steps; different from pixel to pixel, as blue noise, it turns banding
// into fine grain. `pixel_width`: width of a pixel one metre away [m]. Each step is exact for the light at its sample:
// energy does not depend on the length of steps.
vec4 brume_march(vec3 origin, vec3 direction, float t_end, float jitter, float pixel_width) {
  vec2 span = brume_span(origin, direction, t_end);
  vec4 gathered = vec4(0.0, 0.0, 0.0, 1.0);
  if (span.y <= span.x) return gathered;
  uvec4 holes = brume_holes_of_ray(origin, direction);
  float ds = (span.y - span.x) / ceil((span.y - span.x) / BRUME_STEP);
  float t = span.x + jitter * ds;
  while (t < span.y) {
    vec3 position = origin + t * direction;
    vec3 voxel = (position - BRUME_ORIGIN) * BRUME_VOXELS_PER_METRE;
    ivec3 brick = ivec3(floor(voxel * 0.125));
    ivec3 place = brume_place(brick);
    if (place.x < 0) {
      t += ds * brume_steps_out(voxel, brick, direction, ds * BRUME_VOXELS_PER_METRE);
      continue;
    }
    vec3 local = voxel - vec3(brick) * 8.0;
    vec3 off;
    float density = brume_sample(place, local, position, t * pixel_width, holes, off);
    if (density > 0.0) {
      float passed = exp(-BRUME_EXTINCTION * density * ds);
      vec3 texel = vec3(place) * 10.0 + local + off + 1.0;
      gathered.rgb += gathered.a * (1.0 - passed) * brume_light(position, texel, direction);
      gathered.a *= passed;
      if (gathered.a < 0.004) {
        gathered.a = 0.0;
        break;
      }
    }
    t += ds;
  }
  return gathered;
}

#endif
