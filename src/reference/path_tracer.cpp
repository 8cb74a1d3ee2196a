#include "reference/path_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "reference/phase.hpp"

namespace brume::reference {
namespace {

float largest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// Veach's power heuristic: the weight of a sample of density `a` where another way of sampling has `b`.
float power_heuristic(float a, float b) {
  return a * a / (a * a + b * b);
}

/// Where a path is scattered: a point of a medium or of a surface.
struct Vertex {
  const SurfaceHit* surface = nullptr;
  const Medium* medium = nullptr;
  glm::vec3 position{0};
  glm::vec3 arriving{0};  ///< Direction of the path before, unit.
  glm::vec3 albedo{1};    ///< Of a medium.
  float time = 0;         ///< Of the shutter.

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
    return {surface ? Surfaces::off_surface(*surface, direction) : position, direction,
            std::numeric_limits<float>::infinity(), time};
  }
};

class Path {
 public:
  Path(const Scene& scene, const PathLimits& limits, Sampler& sampler)
      : scene_(scene), limits_(limits), sampler_(sampler) {}

  PathSample trace(Ray ray);

 private:
  // Dimensions of the sampler: those of the eye come before.
  static constexpr std::uint32_t kOfEye = 4, kOfBounce = 6;

  void add(const glm::vec3& radiance);
  void add_lights(const Vertex& vertex);
  void add_emitters(const Vertex& vertex);
  void add_glow(const Vertex& vertex);
  void add_found_emitter(const SurfaceHit& hit, const Ray& ray);
  bool scatter(const Vertex& vertex, Ray& ray);
  bool roulette();
  float visible(const Vertex& vertex, const glm::vec3& direction, float distance, float distance_of_surfaces);
  float density_of_emitter(const Emitter& emitter) const;

  const Scene& scene_;
  const PathLimits& limits_;
  Sampler& sampler_;
  PathSample found_;
  glm::vec3 throughput_{1};
  std::uint32_t bounces_ = 0;
  float last_density_ = 0;  // of the direction of the path; 0: the eye's
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

/// Fraction of light that reaches a vertex from so far away, past surfaces up to a distance.
float Path::visible(const Vertex& vertex, const glm::vec3& direction, float distance,
                    float distance_of_surfaces) {
  Ray ray = vertex.leaving(direction);
  ray.end = distance_of_surfaces;
  if (ray.end > 0 && scene_.surfaces.occluded(ray)) return 0;
  ray.end = distance;
  return scene_.media.transmittance(ray, sampler_);
}

/// One of the lights, in proportion to what it would add if nothing hid it.
void Path::add_lights(const Vertex& vertex) {
  thread_local std::vector<glm::vec3> values;
  values.clear();
  float sum = 0;
  for (const shared::Light& light : scene_.lights) {
    const Incident incident = light_at(light, vertex.position);
    values.push_back(incident.irradiance * vertex.value(incident.to_light));
    sum += largest(values.back());
  }
  if (!(sum > 0)) return;
  float chosen = sampler_.next_1d() * sum;
  std::size_t i = 0;
  while (i + 1 < values.size() && chosen >= largest(values[i])) chosen -= largest(values[i++]);
  while (i > 0 && largest(values[i]) <= 0) --i;
  if (largest(values[i]) <= 0) return;
  const Incident incident = light_at(scene_.lights[i], vertex.position);
  const float passed = visible(vertex, incident.to_light, incident.distance, distance_to_housing(incident));
  if (passed > 0) add(values[i] * (passed * sum / largest(values[i])));
}

/// Probability per area of a point on an emitter.
float Path::density_of_emitter(const Emitter& emitter) const {
  return largest(emitter.radiance) / scene_.emitted_power;
}

/// A point on one of the emitters, in proportion to their power.
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
  // Not as far as the emitter itself.
  const float end = distance * (1 - 1e-4f);
  const float passed = visible(vertex, direction, end, end);
  if (passed > 0) add(value * (passed * power_heuristic(density, vertex.density(direction)) / density));
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
  ray.end = scene_.surfaces.distance(ray);
  glm::vec3 emitted(0);
  scene_.media.collide(ray, sampler_, emitted);
  add(value * emitted * (power_heuristic(density, vertex.density(direction)) / density));
}

/// An emitter that the path itself found.
void Path::add_found_emitter(const SurfaceHit& hit, const Ray& ray) {
  if (hit.emission == glm::vec3(0)) return;
  const std::optional<std::uint32_t> i = scene_.surfaces.emitter_of(hit);
  if (bounces_ == 0 || !i) return add(hit.emission);
  const float cosine = std::abs(glm::dot(hit.geometric_normal, ray.direction));
  const float by_light =
      density_of_emitter(scene_.surfaces.emitters()[*i]) * hit.t * hit.t / std::max(cosine, 1e-6f);
  add(hit.emission * power_heuristic(last_density_, by_light));
}

/// Goes on in a direction of a vertex; false where the path ends.
bool Path::scatter(const Vertex& vertex, Ray& ray) {
  if (bounces_ >= limits_.max_bounces) return false;
  sampler_.set_dimension(kOfEye + kOfBounce * bounces_);
  ++bounces_;
  add_lights(vertex);
  add_emitters(vertex);
  add_glow(vertex);
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
  ray = vertex.leaving(direction);
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

PathSample Path::trace(Ray ray) {
  while (true) {
    const std::optional<SurfaceHit> hit = scene_.surfaces.hit(ray);
    if (bounces_ == 0 && hit) {
      found_.albedo = hit->reflection.albedo;
      found_.normal = hit->reflection.normal;
      found_.distance = hit->t;
    }
    // Media before the surface.
    if (hit) ray.end = hit->t;
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
      vertex.position = ray.at(collision->t);
      vertex.albedo = collision->medium->albedo(collision->medium->at_rest(ray).at(collision->t));
    } else if (hit) {
      add_found_emitter(*hit, ray);
      vertex.surface = &*hit;
      vertex.position = hit->position;
    } else {
      add(bounces_ == 0 ? scene_.environment.seen(ray.direction)
                        : scene_.environment.lighting(ray.direction));
      return found_;
    }
    if (!scatter(vertex, ray)) return found_;
  }
}

}  // namespace

PathSample trace_path(const Scene& scene, const Ray& ray, const PathLimits& limits, Sampler& sampler) {
  return Path(scene, limits, sampler).trace(ray);
}

}  // namespace brume::reference
