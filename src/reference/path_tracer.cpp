#include "reference/path_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "reference/light_path.hpp"
#include "reference/near_lights.hpp"
#include "reference/phase.hpp"
#include "shared/pane.h"

namespace brume::reference {
namespace {

using surfaces::Emitter;
using surfaces::Reflection;
using surfaces::SurfaceHit;

float largest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// Veach's power heuristic: the weight of a sample of density `a` where another way of sampling has `b`.
float power_heuristic(float a, float b) {
  return a * a / (a * a + b * b);
}

/// Paths from the eye always have their first vertex from it (other_techniques).
constexpr double kAlways = std::numeric_limits<double>::infinity();

/// Where a path is scattered: a point of a medium or of a surface.
struct Vertex {
  const SurfaceHit* surface = nullptr;
  const Medium* medium = nullptr;
  glm::vec3 position{0};
  glm::vec3 arriving{0};  ///< Direction of the path before, unit.
  glm::vec3 albedo{1};    ///< Single-scattering albedo of a medium.
  float t = 0;            ///< Along the ray that leads there, from the last pane on [m].
  float distance = 0;     ///< From the vertex before [m].
  float time = 0;         ///< While the shutter is open, [0, 1].

  /// Radiance back along the path for unit irradiance from a direction, with the cosine of a surface.
  glm::vec3 value(const glm::vec3& to_light) const {
    // What comes from behind the triangle lights nothing, however its normals lean.
    if (surface)
      return glm::dot(surface->geometric_normal, to_light) > 0
                 ? surface->reflection.value(-arriving, to_light)
                 : glm::vec3(0);
    return albedo * shared::phase_value(medium->phase(), glm::dot(arriving, to_light));
  }
  /// Probability per solid angle with which a direction is sampled.
  float density(const glm::vec3& to_light) const {
    if (surface) return surface->reflection.density(-arriving, to_light);
    return shared::phase_value(medium->phase(), glm::dot(arriving, to_light));
  }
  Ray leaving(const glm::vec3& direction) const {
    return {surface ? Surfaces::off_surface(*surface, direction) : position, direction, Ray::kNoEnd, time};
  }
};

/// What a path knows of near lights in media. All paths of a thread share one, to reuse its memory.
struct NearLightsOfPath {
  NearChords chords;        ///< Along the eye's ray.
  LightPath light_path;     ///< Its vertices are joined with the path's.
  std::vector<Link> links;  ///< By vertex, if near lights may reach the path.
};

class Path {
 public:
  Path(const Scene& scene, const PathLimits& limits, Sampler& sampler, NearLightsOfPath& near)
      : scene_(scene), limits_(limits), sampler_(sampler), near_(near) {
    near.light_path.clear();
    near.links.clear();
  }

  PathSample trace(Ray ray);

 private:
  // Dimensions of the sampler; the eye's come before.
  static constexpr std::uint32_t kOfEye = 4, kOfBounce = 6;
  // For the eye's ray near lights, and for the light's path: far from all bounces.
  static constexpr std::uint32_t kNearLights = 1u << 30, kOfLightPath = kNearLights + 1;

  void add(const glm::vec3& radiance);
  void add_near_lights(const Ray& ray);
  void weigh_collision(const Vertex& vertex, std::span<glm::vec3> values) const;
  void add_lights(const Vertex& vertex);
  void add_light_path(const Vertex& vertex);
  glm::vec3 joined(const Vertex& vertex, std::size_t i) const;
  void add_emitters(const Vertex& vertex);
  void add_glow(const Vertex& vertex);
  void add_found_emitter(const SurfaceHit& hit, const Ray& ray);
  bool scatter(const Vertex& vertex, Ray& ray);
  bool roulette();
  glm::vec3 visible(Ray ray, float distance, float distance_of_surfaces);
  glm::vec3 emitted_along(Ray ray);
  bool pass_pane(const SurfaceHit& hit, Ray& ray);
  void note_surface(const std::optional<SurfaceHit>& nearest, const Ray& ray);
  float density_of_emitter(const Emitter& emitter) const;

  const Scene& scene_;
  const PathLimits& limits_;
  Sampler& sampler_;
  PathSample found_;
  glm::vec3 throughput_{1};
  std::uint32_t bounces_ = 0;
  float last_density_ = 0;  // per solid angle, of the last direction; 0: the eye's
  Ray from_last_;           // the ray from the last vertex, whatever panes it passes
  float passed_m_ = 0;      // along it, up to the last pane
  NearLightsOfPath& near_;
};

void Path::add(const glm::vec3& radiance) {
  glm::vec3 sum = throughput_ * radiance;
  if (bounces_ == 0) {
    found_.seen += sum;
    return;
  }
  const float most = largest(sum);
  if (bounces_ > 1 && most > limits_.clamp) sum *= limits_.clamp / most;
  (bounces_ == 1 ? found_.single : found_.multiple) += sum;
}

/// Distance up to which surfaces hide a light: not those around it, such as its bulb, that its shadow map is
/// too near to show (face_clip_from_world of the shadow pass).
float distance_to_housing(const Incident& incident) {
  const glm::vec3 along = glm::abs(incident.to_light);
  return incident.distance - shared::kShadowNear / largest(along);
}

/// Fraction of light that reaches a ray's origin from so far away, past surfaces up to a distance.
glm::vec3 Path::visible(Ray ray, float distance, float distance_of_surfaces) {
  ray.end = distance_of_surfaces;
  if (ray.end > 0 && scene_.surfaces.occluded(ray)) return glm::vec3(0);
  const glm::vec3 passed = ray.end > 0 ? scene_.surfaces.through_panes(ray) : glm::vec3(1);
  ray.end = distance;
  return passed * scene_.media.transmittance(ray, sampler_);
}

/// Adds what media scatter along the eye's ray near lights, at one place, besides collisions. The density of
/// collisions is the extinction times a transmittance. This technique multiplies what it finds by the same
/// transmittance, so that the densities are compared without it.
void Path::add_near_lights(const Ray& ray) {
  near_.chords.find(scene_, ray);
  if (near_.chords.empty() || limits_.max_bounces == 0) return;
  sampler_.set_dimension(kNearLights);
  const NearChords::Point point = near_.chords.sample(sampler_.next_2d());
  if (!(point.density > 0)) return;
  const Incident incident = light_at(scene_.lights[point.light], ray.at(point.t));

  // Scattering by all media there.
  float extinction = 0;
  glm::vec3 scattered(0);
  for (const auto& medium : scene_.media.all()) {
    const glm::vec3 p_rest = medium->at_rest(ray).at(point.t);
    const float here = medium->collisions(p_rest);
    if (!(here > 0)) continue;
    extinction += here;
    scattered += medium->albedo(p_rest) *
                 (here * shared::phase_value(medium->phase(), glm::dot(ray.direction, incident.to_light)));
  }
  const glm::vec3 value =
      scattered * incident.irradiance * (power_heuristic(point.density, extinction) / point.density);
  if (!(largest(value) > 0)) return;

  // Transmittance to the light and to the eye.
  glm::vec3 passed = visible({ray.at(point.t), incident.to_light, 0, ray.time}, incident.distance,
                             distance_to_housing(incident));
  if (!(largest(passed) > 0)) return;
  Ray before = ray;
  before.end = point.t;
  passed *= scene_.media.transmittance(before, sampler_);
  ++bounces_;
  add(value * passed);
  --bounces_;
}

/// Multiplies what lights add at a collision by its weight beside the other techniques that find it: places
/// near lights on the eye's ray, and paths from lights.
void Path::weigh_collision(const Vertex& vertex, std::span<glm::vec3> values) const {
  if (bounces_ == 1) {
    float extinction = -1;
    near_.chords.for_each_at(vertex.t, [&](std::uint32_t light, float density) {
      if (extinction < 0) {
        extinction = 0;
        const Ray here{vertex.position, vertex.arriving, 0, vertex.time};
        for (const auto& medium : scene_.media.all())
          extinction += medium->collisions(medium->at_rest(here).origin);
      }
      values[light] *= power_heuristic(extinction, density);
    });
    return;
  }
  for (std::size_t i = 0; i < near_.light_path.first_densities().size(); ++i) {
    const std::uint32_t light = scene_.near_lights[i].light;
    const Incident incident = light_at(scene_.lights[light], vertex.position);
    const double d2 = double{incident.distance} * double{incident.distance};
    values[light] /= static_cast<float>(
        1 + other_techniques(near_.links, kAlways, double{near_.light_path.first_densities()[i]} / d2,
                             double{vertex.density(incident.to_light)}, LightPath::kMostVertices));
  }
}

/// Adds one of the lights, chosen in proportion to what it would add if nothing hid it.
void Path::add_lights(const Vertex& vertex) {
  thread_local std::vector<glm::vec3> values;
  values.clear();
  float sum = 0;
  for (const shared::Light& light : scene_.lights) {
    const Incident incident = light_at(light, vertex.position);
    values.push_back(incident.irradiance * vertex.value(incident.to_light));
  }
  if (vertex.medium) weigh_collision(vertex, values);
  for (const glm::vec3& value : values) sum += largest(value);
  if (!(sum > 0)) return;
  float chosen = sampler_.next_1d() * sum;
  std::size_t i = 0;
  while (i + 1 < values.size() && chosen >= largest(values[i])) chosen -= largest(values[i++]);
  while (i > 0 && largest(values[i]) <= 0) --i;
  if (largest(values[i]) <= 0) return;
  const Incident incident = light_at(scene_.lights[i], vertex.position);
  const glm::vec3 passed =
      visible(vertex.leaving(incident.to_light), incident.distance, distance_to_housing(incident));
  if (largest(passed) > 0) add(values[i] * (passed * (sum / largest(values[i]))));
}

/// Radiance of a vertex by light that comes through vertex i of the light's path if nothing is in between.
glm::vec3 Path::joined(const Vertex& vertex, std::size_t i) const {
  const LightPath::Vertex& end = near_.light_path.vertices()[i];
  const glm::vec3 apart = end.position - vertex.position;
  const float d2 = glm::dot(apart, apart);
  if (!(d2 > 1e-12f)) return glm::vec3(0);
  const glm::vec3 direction = apart / std::sqrt(d2);
  const float phase = shared::phase_value(end.medium->phase(), glm::dot(direction, end.to_light));
  const glm::vec3 value = vertex.value(direction) * end.flux * (phase / d2);
  if (!(largest(value) > 0)) return value;
  const double density = double{vertex.density(direction)};
  const double others =
      other_techniques(near_.links, kAlways, double{phase / d2}, density, LightPath::kMostVertices - i - 1) +
      other_techniques(near_.light_path.links().first(i + 1), double{near_.light_path.first_density()},
                       density / double{d2}, double{phase}, LightPath::kMostVertices);
  return value / static_cast<float>(1 + others);
}

/// Adds the light of a vertex of the light's path, chosen in proportion to what it would add if nothing were
/// in between.
void Path::add_light_path(const Vertex& vertex) {
  thread_local std::vector<float> estimates;
  estimates.clear();
  float sum = 0;
  for (std::size_t i = 0; i < near_.light_path.vertices().size(); ++i) {
    if (bounces_ + i >= limits_.max_bounces) break;
    estimates.push_back(largest(joined(vertex, i)));
    sum += estimates.back();
  }
  if (!(sum > 0)) return;
  float chosen = sampler_.random() * sum;
  std::size_t i = 0;
  while (i + 1 < estimates.size() && chosen >= estimates[i]) chosen -= estimates[i++];
  while (i > 0 && estimates[i] <= 0) --i;
  if (estimates[i] <= 0) return;

  // Transmittance between the two vertices.
  const glm::vec3 apart = near_.light_path.vertices()[i].position - vertex.position;
  const float distance = glm::length(apart);
  const glm::vec3 passed = visible(vertex.leaving(apart / distance), distance, distance);
  if (!(largest(passed) > 0)) return;
  const std::uint32_t scattered = static_cast<std::uint32_t>(i) + 1;
  bounces_ += scattered;
  add(joined(vertex, i) * (passed * (sum / estimates[i])));
  bounces_ -= scattered;
}

/// Probability per area of a point on an emitter.
float Path::density_of_emitter(const Emitter& emitter) const {
  return largest(emitter.radiance) / scene_.emitted_power;
}

/// Adds the light of a point on one of the emitters, chosen in proportion to their power.
void Path::add_emitters(const Vertex& vertex) {
  const std::span<const Emitter> emitters = scene_.surfaces.emitters();
  if (!(scene_.emitted_power > 0)) return;
  const glm::vec2 u = sampler_.next_2d();
  const float chosen = sampler_.random() * scene_.emitted_power;
  const auto at = std::ranges::upper_bound(scene_.power_up_to, chosen);
  const Emitter& emitter = emitters[std::min<std::size_t>(
      static_cast<std::size_t>(at - scene_.power_up_to.begin()), emitters.size() - 1)];
  const float root = std::sqrt(u.x);
  const glm::vec3 p = emitter.corner + (1 - root) * emitter.edge_u + u.y * root * emitter.edge_v;
  const glm::vec3 apart = p - vertex.position;
  const float d2 = glm::dot(apart, apart), distance = std::sqrt(d2);
  if (!(distance > 0)) return;
  const glm::vec3 direction = apart / distance;
  const float cosine =
      std::abs(glm::dot(glm::cross(emitter.edge_u, emitter.edge_v), direction)) / (2 * emitter.area);
  if (!(cosine > 1e-6f)) return;
  const float density = density_of_emitter(emitter) * d2 / cosine;
  const glm::vec3 value = vertex.value(direction) * emitter.radiance;
  if (!(largest(value) > 0)) return;
  // Up to just before the emitter, which would hide itself.
  const float end = distance * (1 - 1e-4f);
  const glm::vec3 passed = visible(vertex.leaving(direction), end, end);
  if (largest(passed) > 0)
    add(value * (passed * (power_heuristic(density, vertex.density(direction)) / density)));
}

/// What the media emit along a ray, through panes, up to a surface.
glm::vec3 Path::emitted_along(Ray ray) {
  glm::vec3 sum(0), passed(1);
  while (true) {
    const std::optional<SurfaceHit> hit = scene_.surfaces.hit(ray);
    if (hit) ray.end = hit->t;
    glm::vec3 emitted(0);
    const bool collides = scene_.media.collide(ray, sampler_, emitted).has_value();
    sum += passed * emitted;
    if (collides || !hit || hit->passes == glm::vec3(0)) return sum;
    passed *= hit->passes;
    ray = Ray{Surfaces::off_surface(*hit, ray.direction), ray.direction, Ray::kNoEnd, ray.time};
  }
}

/// What the media emit along a ray to a point of them.
void Path::add_glow(const Vertex& vertex) {
  const EmissionCells& cells = scene_.media.emission();
  if (cells.empty()) return;
  const glm::vec3 apart = cells.sample(vertex.time, sampler_) - vertex.position;
  if (!(glm::dot(apart, apart) > 0)) return;
  const glm::vec3 direction = glm::normalize(apart), value = vertex.value(direction);
  if (!(largest(value) > 0)) return;
  Ray ray = vertex.leaving(direction);
  const float density = cells.direction_density(ray);
  if (!(density > 0)) return;
  add(value * emitted_along(ray) * (power_heuristic(density, vertex.density(direction)) / density));
}

/// An emitter that the path itself found.
void Path::add_found_emitter(const SurfaceHit& hit, const Ray& ray) {
  const float distance = passed_m_ + hit.t;
  if (hit.emission == glm::vec3(0)) return;
  const std::optional<std::uint32_t> i = scene_.surfaces.emitter_of(hit);
  if (bounces_ == 0 || !i) return add(hit.emission);
  const float cosine = std::abs(glm::dot(hit.geometric_normal, ray.direction));
  const float by_light =
      density_of_emitter(scene_.surfaces.emitters()[*i]) * distance * distance / std::max(cosine, 1e-6f);
  add(hit.emission * power_heuristic(last_density_, by_light));
}

/// Goes on in a direction of a vertex; false where the path ends.
bool Path::scatter(const Vertex& vertex, Ray& ray) {
  if (bounces_ >= limits_.max_bounces) return false;
  // What lights and emitters add.
  if (bounces_ == 0 && limits_.max_bounces > 1)
    near_.light_path.trace(scene_, vertex.position, vertex.time, kOfLightPath, sampler_);
  if (!near_.light_path.first_densities().empty())
    near_.links.push_back(
        {vertex.medium != nullptr, 1 / std::max(vertex.distance * vertex.distance, 1e-12f), 0});
  sampler_.set_dimension(kOfEye + kOfBounce * bounces_);
  ++bounces_;
  add_lights(vertex);
  add_emitters(vertex);
  add_glow(vertex);
  add_light_path(vertex);

  // The next direction.
  glm::vec3 direction;
  if (vertex.surface) {
    const Reflection::Direction next = vertex.surface->reflection.sample(-vertex.arriving, sampler_);
    direction = next.to_light;
    // A normal map must not lead behind the surface.
    if (largest(next.weight) <= 0 || glm::dot(direction, vertex.surface->geometric_normal) <= 0) return false;
    throughput_ *= next.weight;
    last_density_ = next.density;
  } else {
    direction = sample_phase(vertex.medium->phase(), vertex.arriving, sampler_);
    throughput_ *= vertex.albedo;
    last_density_ = vertex.density(direction);
  }
  if (!near_.links.empty()) near_.links.back().density = last_density_;
  ray = from_last_ = vertex.leaving(direction);
  passed_m_ = 0;
  return roulette();
}

/// Ends most paths that carry little; the others stand for them.
bool Path::roulette() {
  const float left = largest(throughput_);
  if (!(left > 0)) return false;
  if (left >= 0.5f && bounces_ < 256) return true;
  const float survive = std::min(left, bounces_ < 256 ? 1.0f : 0.95f);
  if (sampler_.random() >= survive) return false;
  throughput_ /= survive;
  return true;
}

/// What the picture says of the surface that the eye sees, past panes.
void Path::note_surface(const std::optional<SurfaceHit>& nearest, const Ray& ray) {
  const bool is_pane = nearest && nearest->is_pane;
  const std::optional<SurfaceHit> behind = is_pane ? scene_.surfaces.opaque_hit(ray) : std::nullopt;
  const std::optional<SurfaceHit>& seen = is_pane ? behind : nearest;
  if (!seen) return;
  found_.albedo = seen->reflection.albedo;
  found_.normal = seen->reflection.normal;
  found_.distance = seen->t;
}

/// Goes straight on through a pane, or not, at random: then it scatters.
bool Path::pass_pane(const SurfaceHit& hit, Ray& ray) {
  const float straight = largest(hit.passes);
  if (!(straight > 0)) return false;
  const float scattered =
      largest(hit.reflection.albedo) +
      shared::pane_reflectance(hit.reflection.highlight, -glm::dot(hit.reflection.normal, ray.direction));
  const float chance = straight / (straight + scattered);
  if (sampler_.random() >= chance) {
    throughput_ /= 1 - chance;
    return false;
  }
  throughput_ *= hit.passes / chance;
  passed_m_ += hit.t;
  ray = {Surfaces::off_surface(hit, ray.direction), ray.direction, Ray::kNoEnd, ray.time};
  return true;
}

PathSample Path::trace(Ray ray) {
  from_last_ = ray;
  while (true) {
    const std::optional<SurfaceHit> hit = scene_.surfaces.hit(ray);
    if (bounces_ == 0 && passed_m_ <= 0) note_surface(hit, ray);
    // Media before the surface.
    if (hit) ray.end = hit->t;
    if (bounces_ == 0) add_near_lights(ray);
    glm::vec3 emitted(0);
    const std::optional<Collision> collision = scene_.media.collide(ray, sampler_, emitted);
    if (emitted != glm::vec3(0))
      add(emitted * (bounces_ == 0 ? 1.0f
                                   : power_heuristic(last_density_, scene_.media.emission().direction_density(
                                                                        ray.without_end()))));
    Vertex vertex;
    vertex.arriving = ray.direction;
    vertex.time = ray.time;
    if (collision) {
      if (bounces_ == 0) found_.through_media = false;
      vertex.medium = collision->medium;
      vertex.t = collision->t;
      vertex.position = ray.at(collision->t);
      vertex.albedo = collision->medium->albedo(collision->medium->at_rest(ray).at(collision->t));
    } else if (hit) {
      add_found_emitter(*hit, ray);
      if (pass_pane(*hit, ray)) continue;
      vertex.surface = &*hit;
      vertex.t = hit->t;
      vertex.position = hit->position;
    } else {
      add(bounces_ == 0 ? scene_.environment.seen(ray.direction)
                        : scene_.environment.lighting(ray.direction));
      return found_;
    }
    vertex.distance = passed_m_ + vertex.t;
    if (!scatter(vertex, ray)) return found_;
  }
}

}  // namespace

PathSample trace_path(const Scene& scene, const Ray& ray, const PathLimits& limits, Sampler& sampler) {
  thread_local NearLightsOfPath near;
  return Path(scene, limits, sampler, near).trace(ray);
}

}  // namespace brume::reference
