// Reflection of a surface.
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

/// Radiance towards `view` for unit irradiance on the surface from `to_light`, both unit vectors in front of it:
/// Lambert and GGX with Schlick's Fresnel and Hammon's 2017 approximation of the height-correlated Smith term.
vec3 reflectance(Surface s, vec3 view, vec3 to_light) {
  const float n_l = dot(s.normal, to_light), n_v = dot(s.normal, view), facing = max(n_v, 1e-3);
  // The sum of both vectors has the length 2 h.view.
  const float v_l = dot(view, to_light), one_over = inversesqrt(max(2.0 + 2.0 * v_l, 1e-6));
  const float n_h = max((n_l + n_v) * one_over, 0.0), h_v = (1.0 + v_l) * one_over;
  const float alpha = max(s.roughness * s.roughness, 0.02);
  const float a2 = alpha * alpha;
  const float d = n_h * n_h * (a2 - 1.0) + 1.0;
  // Distribution a2 / (pi d^2) and visibility 0.5 / mix(...).
  const float specular = 0.5 * a2 / (kPi * d * d * mix(2.0 * n_l * facing, n_l + facing, alpha));
  const vec3 f0 = mix(vec3(0.04), s.albedo, s.metallic), diffuse = s.albedo * ((1.0 - s.metallic) / kPi);
  const float grazing = 1.0 - clamp(h_v, 0.0, 1.0), grazing2 = grazing * grazing;
  const vec3 fresnel = f0 + (1.0 - f0) * (grazing2 * grazing2 * grazing);
  return diffuse + fresnel * (specular - diffuse);
}

#endif
