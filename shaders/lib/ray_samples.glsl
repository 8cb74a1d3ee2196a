#ifndef RAY_SAMPLES_GLSL
#define RAY_SAMPLES_GLSL

/// The samples of a ray: number k lies at t = begin + k ds + jitter * (its segment, ds or what is left of it up to end).
struct RaySamples {
  vec3 origin_world, direction;
  float begin, end, ds, jitter;
};

#endif
