#include "surfaces/surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brume::surfaces {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

float alpha_of(float roughness) {
  return std::max(roughness * roughness, 0.02f);
}

/// GGX, of the cosine between half vector and normal [1/sr].
float ggx(float alpha, float n_h) {
  const float a2 = alpha * alpha, d = n_h * n_h * (a2 - 1) + 1;
  return a2 / (kPi * d * d);
}

float luminance(const glm::vec3& c) {
  return glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

glm::vec3 fresnel(const Reflection& s, float h_v) {
  const glm::vec3 f0 = glm::mix(glm::vec3(0.04f), s.albedo, s.metallic);
  const float factor = glm::mix(s.highlight, 1.0f, s.metallic);
  const float grazing = 1 - std::clamp(h_v, 0.0f, 1.0f), grazing2 = grazing * grazing;
  return factor * (f0 + (1.0f - f0) * (grazing2 * grazing2 * grazing));
}

}  // namespace

void basis_around(const glm::vec3& n, glm::vec3& x, glm::vec3& y) {
  const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  x = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  y = {b, sign + n.y * n.y * a, -n.y};
}

glm::vec3 Reflection::value(const glm::vec3& view, const glm::vec3& to_light) const {
  const float n_l = glm::dot(normal, to_light);
  if (n_l <= 0) return glm::vec3(0);
  const float n_v = glm::dot(normal, view), facing = std::max(n_v, 1e-3f);
  // The sum of both vectors has the length 2 h.view.
  const float v_l = glm::dot(view, to_light), one_over = 1 / std::sqrt(std::max(2 + 2 * v_l, 1e-6f));
  const float n_h = std::max((n_l + n_v) * one_over, 0.0f), h_v = (1 + v_l) * one_over;
  const float alpha = alpha_of(roughness);
  const float visibility = 0.5f / glm::mix(2 * n_l * facing, n_l + facing, alpha);
  const glm::vec3 f = fresnel(*this, h_v);
  const glm::vec3 diffuse = albedo * ((1 - metallic) / kPi) * (1.0f - f);
  return (diffuse + f * (ggx(alpha, n_h) * visibility)) * n_l;
}

float Reflection::specular_share(const glm::vec3& view) const {
  if (highlight <= 0 && metallic <= 0) return 0;
  const float specular = luminance(fresnel(*this, glm::dot(normal, view)));
  const float diffuse = luminance(albedo) * (1 - metallic);
  // Never without either, so that both shapes are found.
  return metallic >= 1 ? 1.0f : std::clamp(specular / std::max(specular + diffuse, 1e-6f), 0.1f, 0.9f);
}

float Reflection::density(const glm::vec3& view, const glm::vec3& to_light) const {
  const float n_l = glm::dot(normal, to_light);
  if (n_l <= 0) return 0;
  const float share = specular_share(view);
  const glm::vec3 sum = view + to_light;
  const float length = glm::length(sum);
  float specular = 0;
  if (length > 1e-4f) {
    const glm::vec3 h = sum / length;
    const float n_h = glm::dot(normal, h), v_h = glm::dot(view, h);
    if (n_h > 0 && v_h > 0) specular = ggx(alpha_of(roughness), n_h) * n_h / (4 * v_h);
  }
  return share * specular + (1 - share) * n_l / kPi;
}

Reflection::Direction Reflection::sample(const glm::vec3& view, Sampler& sampler) const {
  glm::vec3 x, y;
  basis_around(normal, x, y);
  const glm::vec2 u = sampler.next_2d();
  const float angle = 2 * kPi * u.x;
  Direction out;
  if (sampler.next_1d() < specular_share(view)) {
    const float alpha = alpha_of(roughness);
    const float cos2 = (1 - u.y) / (1 + (alpha * alpha - 1) * u.y);
    const float cos_h = std::sqrt(cos2), sin_h = std::sqrt(std::max(0.0f, 1 - cos2));
    const glm::vec3 h = cos_h * normal + sin_h * (std::cos(angle) * x + std::sin(angle) * y);
    out.to_light = glm::normalize(2 * glm::dot(view, h) * h - view);
  } else {
    const float sin_n = std::sqrt(u.y);
    out.to_light =
        glm::normalize(std::sqrt(1 - u.y) * normal + sin_n * (std::cos(angle) * x + std::sin(angle) * y));
  }
  out.density = density(view, out.to_light);
  if (out.density > 0) out.weight = value(view, out.to_light) / out.density;
  return out;
}

}  // namespace brume::surfaces
