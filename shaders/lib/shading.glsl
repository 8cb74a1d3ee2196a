// How a surface answers light.
#ifndef SHADING_GLSL
#define SHADING_GLSL

const float kPi = 3.14159265358979;

struct Surface {
  vec3 position_world;
  vec3 normal;
  vec3 albedo;
  float roughness;
  float metallic;
};

/// Radiance towards `view` for unit irradiance from `to_light`, both unit vectors: Lambert and GGX with Schlick's
/// Fresnel and the height-correlated Smith term as Hammon 2017 approximates it.
vec3 reflect_light(Surface s, vec3 view, vec3 to_light) {
  const float n_l = dot(s.normal, to_light);
  if (n_l <= 0.0) return vec3(0.0);
  const float n_v = max(dot(s.normal, view), 1e-3);
  const vec3 h = normalize(view + to_light);
  const float n_h = max(dot(s.normal, h), 0.0);
  const float alpha = max(s.roughness * s.roughness, 0.02);
  const float a2 = alpha * alpha;
  const float d = n_h * n_h * (a2 - 1.0) + 1.0;
  const float distribution = a2 / (kPi * d * d);
  const float visibility = 0.5 / mix(2.0 * n_l * n_v, n_l + n_v, alpha);
  const vec3 f0 = mix(vec3(0.04), s.albedo, s.metallic);
  const float grazing = 1.0 - max(dot(h, view), 0.0), grazing2 = grazing * grazing;
  const vec3 fresnel = f0 + (1.0 - f0) * (grazing2 * grazing2 * grazing);
  const vec3 diffuse = s.albedo * (1.0 - s.metallic) * (1.0 - fresnel) / kPi;
  return (diffuse + fresnel * distribution * visibility) * n_l;
}

#endif
