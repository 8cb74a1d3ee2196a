#include "reference/tank_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/color.hpp"

namespace brume::reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// As a float that is not below it.
float rounded_up(double t) {
  const float rounded = static_cast<float>(t);
  return static_cast<double>(rounded) < t ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
                                          : rounded;
}

/// Fraction of unpolarized light that is reflected (Fresnel): Born and Wolf, "Principles of Optics", 1.5.2,
/// by the cosines of both angles to the normal.
double reflectance(double cosine, double behind, double index, double index_behind) {
  const double across = (index * cosine - index_behind * behind) / (index * cosine + index_behind * behind);
  const double along = (index_behind * cosine - index * behind) / (index_behind * cosine + index * behind);
  return 0.5 * (across * across + along * along);
}

}  // namespace

bool TankLensBody::contains(const glm::dvec3& at) const {
  const glm::dvec3 scaled = (at - center) / radii;
  return glm::dot(scaled, scaled) < 1;
}

glm::dvec2 TankLensBody::crossings(const glm::dvec3& origin, const glm::dvec3& direction) const {
  const glm::dvec3 o = (origin - center) / radii, d = direction / radii;
  const double a = glm::dot(d, d), middle = -glm::dot(o, d) / a;
  const glm::dvec3 nearest = o + middle * d;
  const double rest = 1 - glm::dot(nearest, nearest);
  if (rest < 0) return {kInfinity, -kInfinity};
  const double half = std::sqrt(rest / a);
  return {middle - half, middle + half};
}

bool TankLensBody::cross(const glm::dvec3& at, bool inside, double random, glm::dvec3& direction) const {
  const glm::dvec3 outward = glm::normalize((at - center) / (radii * radii));
  const glm::dvec3 normal = inside ? -outward : outward;
  const double here = inside ? index : 1, behind = inside ? 1 : index;
  // What is along the surface changes by the ratio of the indices (Snell's law).
  const double cosine = std::clamp(-glm::dot(direction, normal), 0.0, 1.0);
  const glm::dvec3 along = (direction + cosine * normal) * (here / behind);
  const double squared = 1 - glm::dot(along, along);
  const double cosine_behind = std::sqrt(std::max(squared, 0.0));
  if (squared > 0 && random >= reflectance(cosine, cosine_behind, here, behind)) {
    direction = glm::normalize(along - cosine_behind * normal);
    return true;
  }
  direction = glm::normalize(direction + 2 * cosine * normal);
  return false;
}

TankModel::TankModel(const spheres::Tank& tank, const scene::TankScene& scene)
    : tank_(tank),
      voxel_(static_cast<double>(tank.voxel)),
      bounces_(scene.bounces),
      sky_(scene.sky),
      fog_(scene.fog),
      fog_extinction_(static_cast<double>(scene.fog.extinction) * voxel_) {
  // In voxels.
  for (const scene::TankLight& light : scene.lights) {
    TankBall ball;
    ball.center = voxel_from_world(light.position_world);
    ball.radius = static_cast<double>(light.radius) / voxel_;
    ball.intensity = glm::dvec3(light.color) * (static_cast<double>(light.intensity) / (voxel_ * voxel_));
    if (ball.radius > 0) ball.radiance = ball.intensity / (std::numbers::pi * ball.radius * ball.radius);
    lights_.push_back(ball);
  }
  if (scene.glass)
    glass_ = TankLensBody{voxel_from_world(scene.glass->position_world),
                          glm::dvec3(scene.glass->radii) / voxel_, static_cast<double>(scene.glass->index)};

  // Tables of all bytes.
  for (int byte = 0; byte < 256; ++byte) {
    linear_.push_back(scene::linear_from_srgb(byte / 255.0));
    extinctions_.push_back(byte < 255 ? -std::log1p(-byte / 255.0) : kInfinity);
  }
  tree_.build("tank", tank.spheres).value_or_throw();
}

glm::dvec3 TankModel::albedo(std::uint32_t sphere) const {
  const spheres::Color color = tank_.colors[sphere];
  return {linear_[color & 255], linear_[color >> 8 & 255], linear_[color >> 16 & 255]};
}

glm::dvec2 TankModel::crossings(std::uint32_t sphere, const TankRay& ray) const {
  const spheres::Sphere& ball = tank_.spheres[sphere];
  const double radius = static_cast<double>(ball.radius);
  const glm::dvec3 apart = glm::dvec3(ball.center) - ray.origin;
  const double middle = glm::dot(apart, ray.direction);
  const glm::dvec3 nearest = apart - middle * ray.direction;
  const double squared = radius * radius - glm::dot(nearest, nearest);
  if (squared < 0) return {kInfinity, -kInfinity};
  const double half = std::sqrt(squared);
  return {middle - half, middle + half};
}

glm::dvec2 TankModel::box_crossings(const TankRay& ray, double margin) const {
  glm::dvec2 inside(-kInfinity, kInfinity);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = -margin - ray.origin[axis], high = tank_.size[axis] + margin - ray.origin[axis];
    if (ray.direction[axis] == 0) {
      if (low > 0 || high < 0) return {kInfinity, -kInfinity};
      continue;
    }
    const double a = low / ray.direction[axis], b = high / ray.direction[axis];
    inside = {std::max(inside.x, std::min(a, b)), std::min(inside.y, std::max(a, b))};
  }
  return inside;
}

double TankModel::length_in_tank(const TankRay& ray, double end) const {
  const glm::dvec2 inside = box_crossings(ray, 0);
  return std::max(0.0, std::min(inside.y, end) - std::max(inside.x, 0.0));
}

/// Calls visit(sphere, enter, leave) for the spheres on a ray in their order until it returns false; `enter`
/// is below 0 where the ray begins inside.
template <typename Visit>
void TankModel::for_each_sphere(const TankRay& ray, double end, const Visit& visit) const {
  std::uint32_t skip = ray.leaves;
  double passed = 0;
  if (ray.inside != TankRay::kNone) {
    const glm::dvec2 crossed = crossings(ray.inside, ray);
    // By rounding, the origin may lie outside.
    if (crossed.y > 0 && !visit(ray.inside, -1.0, crossed.y)) return;
    passed = std::max(crossed.y, 0.0);
    skip = ray.inside;
  }

  // From the box on, so that the tree's floats stay exact.
  const glm::dvec2 box = box_crossings(ray, 1);
  const double start = std::max(box.x, 0.0), last = std::min(box.y, end);
  const glm::vec3 origin(ray.at(start)), direction(ray.direction);
  float from = rounded_up(std::max(passed - start, 0.0));
  while (start < last) {
    const trace::SphereTree::Hit hit =
        tree_.next(origin, direction, from, static_cast<float>(last - start) + 1, skip);
    if (hit.sphere == trace::SphereTree::kNone) return;
    const glm::dvec2 crossed = crossings(hit.sphere, ray);
    skip = hit.sphere;
    from = std::nextafter(std::max(from, hit.t), std::numeric_limits<float>::infinity());
    // The tree's floats find it once more, or where the ray only just misses it.
    if (crossed.y <= passed || crossed.y < crossed.x) continue;
    if (crossed.x >= end || !visit(hit.sphere, crossed.x, crossed.y)) return;
    passed = crossed.y;
    from = std::max(from, rounded_up(crossed.y - start));
  }
}

TankEvent TankModel::next_event(const TankRay& ray, double end, Sampler& sampler) const {
  TankEvent event;
  for_each_sphere(ray, end, [&](std::uint32_t sphere, double enter, double leave) {
    if (is_opaque(sphere)) {
      // One that the ray begins in is not there.
      if (enter < 0) return true;
      event = {sphere, enter, true};
      return false;
    }
    // u in [0, 1) of 24 bits: its complement is above 0.
    const double free_path = -std::log(1 - static_cast<double>(sampler.random())) / extinction(sphere);
    const double t = std::max(enter, 0.0) + free_path;
    if (!(t < leave)) return true;
    if (t < end) event = {sphere, t, false};
    return false;
  });
  return event;
}

double TankModel::transmittance(const TankRay& ray, double end) const {
  double depth = 0;
  for_each_sphere(ray, end, [&](std::uint32_t sphere, double enter, double leave) {
    if (is_opaque(sphere)) {
      if (enter >= 0) depth = kInfinity;
      return enter < 0;
    }
    depth += extinction(sphere) * (std::min(leave, end) - std::max(enter, 0.0));
    return true;
  });
  return std::exp(-depth);
}

}  // namespace brume::reference
