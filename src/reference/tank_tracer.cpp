#include "reference/tank_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "surfaces/surface.hpp"

namespace brume::reference {
namespace {

constexpr double kTankInfinity = std::numeric_limits<double>::infinity();
constexpr double kTankPi = std::numbers::pi;
/// Crossings of the glass between two events, at most: light that total reflection keeps inside is lost. What
/// else stays so long is less than 10^-20 of all.
constexpr int kMostCrossings = 256;

/// Dimensions of the sampler; the eye's come before.
constexpr std::uint32_t kTankOfEye = 4, kTankOfEvent = 3;

/// Across a unit vector, with it a basis.
glm::dmat3 tank_basis(const glm::dvec3& n) {
  const glm::dvec3 other = std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, n));
  return {x, glm::cross(n, x), n};
}

/// A unit vector, by its component along an axis and its angle around it.
glm::dvec3 turned(const glm::dvec3& axis, double cosine, double angle) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return glm::normalize(tank_basis(axis) *
                        glm::dvec3(sine * std::cos(angle), sine * std::sin(angle), cosine));
}

double largest_of(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

class TankPath {
 public:
  TankPath(const TankModel& model, Sampler& sampler, const spheres::LightPaths* photons)
      : model_(model), sampler_(sampler), photons_(photons) {}
  PathSample trace(const Ray& ray);

 private:
  /// The vertex of the path at an event.
  struct Vertex {
    TankEvent event;
    glm::dvec3 position{0}, normal{0}, albedo{0};
  };

  void add(const glm::dvec3& radiance);
  void add_fog(double end);
  void add_met_lights(double end);
  void add_lights(const Vertex& vertex);
  void add_photons(const Vertex& vertex);
  bool follow();
  bool is_in_glass(const glm::dvec3& at) const { return model_.glass() && model_.glass()->contains(at); }
  double distance_to_glass() const;
  Vertex vertex_of(const TankEvent& event) const;
  void note_first(const Vertex& vertex);
  bool scatter(const Vertex& vertex);

  const TankModel& model_;
  Sampler& sampler_;
  const spheres::LightPaths* photons_;
  PathSample found_;
  TankRay ray_;
  glm::dvec3 weight_{1};
  std::uint32_t events_ = 0;
  double length_ = 0;  // since the eye
  bool in_glass_ = false;
  bool met_glass_ = false;   // since the last event
  bool left_glass_ = false;  // outwards from its surface, which is convex: it does not meet it again
};

void TankPath::add(const glm::dvec3& radiance) {
  const glm::vec3 sum(weight_ * radiance);
  (events_ == 0 ? found_.seen : events_ == 1 ? found_.single : found_.multiple) += sum;
}

/// The fog of the eye's ray up to a distance.
void TankPath::add_fog(double end) {
  if (!(model_.fog_extinction() > 0)) return;
  const double passed = std::exp(-model_.fog_extinction() * model_.length_in_tank(ray_, end));
  add(glm::dvec3(model_.fog().color) * (1 - passed));
  weight_ *= passed;
}

/// Lights whose surface a ray enters that has met the glass: add_lights does not find them.
void TankPath::add_met_lights(double end) {
  for (const TankBall& light : model_.lights()) {
    const glm::dvec3 apart = light.center - ray_.origin;
    const double middle = glm::dot(apart, ray_.direction);
    const glm::dvec3 nearest = apart - middle * ray_.direction;
    const double squared = light.radius * light.radius - glm::dot(nearest, nearest);
    if (!(squared > 0)) continue;
    const double enter = middle - std::sqrt(squared);
    if (!(enter > 0 && enter < end)) continue;
    // Radiance over the squared index is what stays along a ray.
    const double index = in_glass_ ? model_.glass()->index : 1;
    add(light.radiance / (index * index));
  }
}

/// A light by a straight line outside of the glass.
void TankPath::add_lights(const Vertex& vertex) {
  const float chosen = sampler_.next_1d();
  const glm::vec2 u = sampler_.next_2d();
  if (is_in_glass(vertex.position)) return;
  const auto estimate = [&](const TankBall& light) {
    const glm::dvec3 apart = light.center - vertex.position;
    return largest_of(light.intensity) / std::max(glm::dot(apart, apart), light.radius * light.radius);
  };
  double sum = 0;
  for (const TankBall& light : model_.lights()) sum += estimate(light);
  if (!(sum > 0)) return;
  double rest = static_cast<double>(chosen) * sum;
  std::size_t i = 0;
  while (i + 1 < model_.lights().size() && rest >= estimate(model_.lights()[i]))
    rest -= estimate(model_.lights()[i++]);
  const TankBall& light = model_.lights()[i];

  // A direction in the cone that the light fills, up to its surface.
  const glm::dvec3 apart = light.center - vertex.position;
  const double squared = glm::dot(apart, apart), distance = std::sqrt(squared);
  if (!(distance > light.radius)) return;
  const double sine_squared = light.radius * light.radius / squared, widest = std::sqrt(1 - sine_squared);
  const double cosine = 1 - static_cast<double>(u.x) * (sine_squared / (1 + widest));
  TankRay ray{vertex.position, turned(apart / distance, cosine, 2 * kTankPi * static_cast<double>(u.y))};
  (vertex.event.is_surface ? ray.leaves : ray.inside) = vertex.event.sphere;
  const double value =
      vertex.event.is_surface ? glm::dot(vertex.normal, ray.direction) / kTankPi : 0.25 / kTankPi;
  if (!(value > 0)) return;
  const double chord = light.radius * light.radius - squared * (1 - cosine * cosine);
  const double end = distance * cosine - std::sqrt(std::max(chord, 0.0));
  if (model_.glass()) {
    const glm::dvec2 crossed = model_.glass()->crossings(ray.origin, ray.direction);
    if (crossed.x < crossed.y && crossed.y > 0 && crossed.x < end) return;
  }
  // Radiance I / (pi r^2) times the solid angle 2 pi (1 - widest) of the cone.
  const glm::dvec3 irradiance = light.intensity * (2 / (squared * (1 + widest)));
  add(vertex.albedo * irradiance * (value * model_.transmittance(ray, end) * sum / estimate(light)));
}

/// Light that comes through or off the glass.
void TankPath::add_photons(const Vertex& vertex) {
  const std::uint32_t i = vertex.event.sphere;
  const glm::dvec3 gathered(
      photons_->gather(glm::vec3(vertex.position), i, model_.sphere(i),
                       vertex.event.is_surface ? 0.0f : static_cast<float>(model_.extinction(i))));
  add(vertex.albedo * gathered * (vertex.event.is_surface ? 1 / kTankPi : 0.25 / kTankPi));
}

double TankPath::distance_to_glass() const {
  if (!model_.glass() || left_glass_) return kTankInfinity;
  const glm::dvec2 crossed = model_.glass()->crossings(ray_.origin, ray_.direction);
  if (in_glass_) return std::max(crossed.y, 0.0);
  return crossed.x < crossed.y && crossed.x > 0 ? crossed.x : kTankInfinity;
}

TankPath::Vertex TankPath::vertex_of(const TankEvent& event) const {
  Vertex vertex{event, ray_.at(event.t), glm::dvec3(0), model_.albedo(event.sphere)};
  if (event.is_surface) {
    const spheres::Sphere& ball = model_.sphere(event.sphere);
    vertex.normal = model_.normal(event.sphere, vertex.position);
    vertex.position = glm::dvec3(ball.center) + static_cast<double>(ball.radius) * vertex.normal;
  }
  return vertex;
}

void TankPath::note_first(const Vertex& vertex) {
  found_.through_media = vertex.event.is_surface;
  if (!vertex.event.is_surface) return;
  found_.albedo = glm::vec3(vertex.albedo);
  found_.normal = glm::vec3(vertex.normal);
  found_.distance = static_cast<float>((length_ + vertex.event.t) * model_.voxel());
}

/// What lights an event, and where the path goes on; false where it ends.
bool TankPath::scatter(const Vertex& vertex) {
  sampler_.set_dimension(kTankOfEye + kTankOfEvent * events_);
  ++events_;
  add_lights(vertex);
  if (photons_ != nullptr) add_photons(vertex);
  weight_ *= vertex.albedo;
  if (model_.bounces() == 0) {
    add(glm::dvec3(model_.sky().ambient));
    return false;
  }
  if (!(largest_of(weight_) > 0)) return false;

  // By Lambert's law, or evenly.
  const glm::vec2 u = sampler_.next_2d();
  const double angle = 2 * kTankPi * static_cast<double>(u.y), along = static_cast<double>(u.x);
  TankRay next{vertex.position};
  if (vertex.event.is_surface) {
    next.leaves = vertex.event.sphere;
    next.direction = turned(vertex.normal, std::sqrt(1 - along), angle);
  } else {
    next.inside = vertex.event.sphere;
    next.direction = turned({0, 0, 1}, 1 - 2 * along, angle);
  }
  ray_ = next;
  in_glass_ = is_in_glass(ray_.origin);
  met_glass_ = in_glass_;
  left_glass_ = false;
  return true;
}

/// Follows the ray to its next event or crossing of the glass; false where the path ends.
bool TankPath::follow() {
  const double to_glass = distance_to_glass();
  const TankEvent event = model_.next_event(ray_, to_glass, sampler_);
  const double end = std::min(event.t, to_glass);
  if (events_ == 0 && !in_glass_) add_fog(end);
  if (events_ > 0 && met_glass_ && photons_ == nullptr) add_met_lights(end);

  if (event.sphere != TankRay::kNone) {
    if (events_ >= std::max(model_.bounces(), 1u)) return false;
    const Vertex vertex = vertex_of(event);
    if (events_ == 0) note_first(vertex);
    return scatter(vertex);
  }
  if (to_glass == kTankInfinity) {
    const scene::SkyOptions& sky = model_.sky();
    const float up = std::clamp(0.5f * static_cast<float>(ray_.direction.y) + 0.5f, 0.0f, 1.0f);
    add(glm::dvec3(events_ == 0 ? glm::mix(sky.horizon, sky.zenith, up) : sky.ambient));
    return false;
  }

  // The glass.
  length_ += to_glass;
  glm::dvec3 direction = ray_.direction;
  const glm::dvec3 at = ray_.at(to_glass);
  const bool passed = model_.glass()->cross(at, in_glass_, static_cast<double>(sampler_.random()), direction);
  ray_ = {at, direction};
  in_glass_ = in_glass_ != passed;
  left_glass_ = !in_glass_;
  met_glass_ = true;
  return true;
}

PathSample TankPath::trace(const Ray& ray) {
  ray_ = {model_.voxel_from_world(ray.origin), glm::normalize(glm::dvec3(ray.direction))};
  in_glass_ = is_in_glass(ray_.origin);
  for (int crossings = 0; crossings < kMostCrossings;) {
    const std::uint32_t before = events_;
    if (!follow()) break;
    crossings = events_ > before ? 0 : crossings + 1;
  }
  return found_;
}

}  // namespace

PathSample trace_tank_path(const TankModel& model, const Ray& ray, Sampler& sampler,
                           const spheres::LightPaths* photons) {
  return TankPath(model, sampler, photons).trace(ray);
}

Render::Trace tank_trace(const TankModel& model, const spheres::LightPaths* photons) {
  return [&model, photons](const Ray& ray, Sampler& sampler) {
    return trace_tank_path(model, ray, sampler, photons);
  };
}

spheres::LightPathScene light_path_scene(const TankModel& model) {
  spheres::LightPathScene scene;
  for (const TankBall& light : model.lights())
    scene.lights.push_back(
        {glm::vec3(light.center), static_cast<float>(light.radius), glm::vec3(light.intensity)});
  if (model.glass())
    scene.glass = {glm::vec3(model.glass()->center), static_cast<float>(model.glass()->index),
                   glm::vec3(model.glass()->radii)};
  return scene;
}

}  // namespace brume::reference
