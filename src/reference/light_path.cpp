#include "reference/light_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "reference/phase.hpp"
#include "surfaces/surface.hpp"

namespace brume::reference {
namespace {

using surfaces::basis_around;

/// Beyond this distance of the light from the first vertex of a path from the eye, the chance that it has one
/// from the light falls with the square of the distance [m].
constexpr float kAlwaysWithin = 4;

/// Distances in densities are at least so long that the inverse of their square is finite [m^2].
constexpr float kLeastSquare = 1e-12f;

float brightest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// A direction in which a light shines, evenly distributed.
glm::vec3 direction_of(const shared::Light& light, float solid_angle, Sampler& sampler) {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  const glm::vec2 u = sampler.next_2d();
  const float cosine = 1 - u.x * solid_angle / kTurn, sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine)),
              angle = kTurn * u.y;
  const glm::vec3 axis = light.kind == shared::kLightSpot ? light.direction : glm::vec3(0, 0, 1);
  glm::vec3 x, y;
  basis_around(axis, x, y);
  return glm::normalize(cosine * axis + sine * (std::cos(angle) * x + std::sin(angle) * y));
}

}  // namespace

double other_techniques(std::span<const Link> links, double first_density, double last, double before,
                        std::size_t most) {
  double product = 1, sum = 0;
  for (std::size_t i = links.size(); i-- > 0 && most > 0; --most) {
    if (!links[i].in_medium) break;
    const std::size_t after = links.size() - 1 - i;
    const double mine = (i == 0 ? first_density : double{links[i - 1].density}) * double{links[i].inverse_d2};
    double other = last;
    if (after == 1) other = before * double{links[i + 1].inverse_d2};
    if (after > 1) other = double{links[i + 1].density} * double{links[i + 1].inverse_d2};
    const double ratio = other / mine;
    product *= ratio * ratio;
    sum += product;
  }
  return sum;
}

void LightPath::clear() {
  vertices_.clear();
  links_.clear();
  first_densities_.clear();
}

void LightPath::trace(const Scene& scene, const glm::vec3& first_vertex, float time, std::uint32_t dimension,
                      Sampler& sampler) {
  clear();
  if (scene.near_lights.empty()) return;
  choose(scene, first_vertex);
  float chosen = sampler.random();
  for (std::size_t i = 0; i < scene.near_lights.size(); ++i) {
    const NearLight& near = scene.near_lights[i];
    const float chance = first_densities_[i] * near.solid_angle;
    if (chosen >= chance) {
      chosen -= chance;
      continue;
    }
    first_density_ = first_densities_[i];
    sampler.set_dimension(dimension);
    return scatter_from(scene, near, time, sampler);
  }
}

/// The chance of each light is its fraction of what all lights would give to the vertex if nothing hid them.
void LightPath::choose(const Scene& scene, const glm::vec3& first_vertex) {
  const auto square_to = [&](const shared::Light& light) {
    const glm::vec3 apart = light.position_world - first_vertex;
    return std::max(glm::dot(apart, apart), scene.near * scene.near);
  };
  float sum = 0;
  for (const shared::Light& light : scene.lights)
    sum += brightest(light.intensity) / (light.kind == shared::kLightDirectional ? 1 : square_to(light));
  for (const NearLight& near : scene.near_lights) {
    const shared::Light& light = scene.lights[near.light];
    const float d2 = square_to(light), given = brightest(light.intensity) / d2;
    first_densities_.push_back(given / sum * std::min(1.0f, kAlwaysWithin * kAlwaysWithin / d2) /
                               near.solid_angle);
  }
}

/// Collisions along a random walk; roulette by the albedo, so that the flux stays.
void LightPath::scatter_from(const Scene& scene, const NearLight& near, float time, Sampler& sampler) {
  const shared::Light& light = scene.lights[near.light];
  Ray ray{light.position_world, direction_of(light, near.solid_angle, sampler), 0, time};
  // Surfaces around the light do not hide it (distance_to_housing).
  const float housing = shared::kShadowNear / brightest(glm::abs(ray.direction));
  ray.end = housing + scene.surfaces.distance({ray.at(housing), ray.direction, Ray::kNoEnd, time});
  glm::vec3 flux(0);
  while (true) {
    glm::vec3 emitted(0);
    const std::optional<Collision> collision = scene.media.collide(ray, sampler, emitted);
    if (!collision) return;
    const Medium& medium = *collision->medium;
    const glm::vec3 p = ray.at(collision->t), p_rest = medium.at_rest(ray).at(collision->t);
    const float d2 = std::max(collision->t * collision->t, kLeastSquare);
    if (vertices_.empty()) flux = light_at(light, p).irradiance * d2 / first_density_;
    Ray up_to_here = ray;
    up_to_here.end = collision->t;
    const glm::vec3 albedo = medium.albedo(p_rest);
    flux *= albedo * scene.surfaces.through_panes(up_to_here);
    if (!(brightest(flux) > 0)) return;
    vertices_.push_back({p, -ray.direction, &medium, flux});
    links_.push_back({true, 1 / d2, 0});

    // On to the next.
    const float survive = std::min(brightest(albedo), 1.0f);
    if (vertices_.size() == kMostVertices || sampler.random() >= survive) return;
    flux /= survive;
    const glm::vec3 direction = sample_phase(medium.phase(), ray.direction, sampler);
    links_.back().density = shared::phase_value(medium.phase(), glm::dot(ray.direction, direction));
    ray = {p, direction, Ray::kNoEnd, time};
    ray.end = scene.surfaces.distance(ray);
  }
}

}  // namespace brume::reference
