#include "tests/reference/truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/tasks.hpp"
#include "shared/erosion.h"
#include "tests/reference/phase.hpp"
#include "tests/reference/smoke_integral.hpp"

namespace brume::reference {
namespace {

constexpr double kPi = std::numbers::pi, kFar = 1e9;

double smooth(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// The tile at a point, between its texels, 0..1; it repeats.
glm::dvec4 noise_at(const NoiseTile& tile, glm::dvec3 p_tile) {
  const int n = static_cast<int>(tile.size);
  const glm::dvec3 at = (p_tile - glm::floor(p_tile)) * double(n) - 0.5;
  const glm::ivec3 low(glm::floor(at));
  const glm::dvec3 f = at - glm::dvec3(low);
  glm::dvec4 sum(0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 o(corner & 1, corner >> 1 & 1, corner >> 2), c = (low + o + n) % n;
    const double w = (o.x ? f.x : 1 - f.x) * (o.y ? f.y : 1 - f.y) * (o.z ? f.z : 1 - f.z);
    sum += w / 255 * glm::dvec4(tile.texels[static_cast<std::size_t>(c.x + n * (c.y + n * c.z))]);
  }
  return sum;
}

/// The noise displacement at a point of the smoke.
glm::dvec3 advection_at(const TruthScene& scene, glm::dvec3 p_voxel) {
  if (scene.displacement == nullptr) return glm::dvec3(0);
  const glm::ivec3 brick(glm::floor(p_voxel / 8.0));
  const std::uint32_t slot = scene.volume->slot_at(brick);
  if (slot == smoke::SmokeVolume::kNoSlot) return glm::dvec3(0);
  const glm::ivec3 corner(shared::atlas_first_texel(scene.volume->layout().bricks, slot));
  const glm::dvec3 at = p_voxel - glm::dvec3(8 * brick) + 0.5;  // a texel of apron before the brick
  const glm::ivec3 low(glm::floor(at));
  const glm::dvec3 f = at - glm::dvec3(low);
  glm::dvec3 sum(0);
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 o(i & 1, i >> 1 & 1, i >> 2), t = corner + glm::min(low + o, glm::ivec3(9));
    const double w = (o.x ? f.x : 1 - f.x) * (o.y ? f.y : 1 - f.y) * (o.z ? f.z : 1 - f.z);
    const auto index = t.x + std::int64_t{scene.displacement->size.x} *
                                 (t.y + std::int64_t{scene.displacement->size.y} * t.z);
    sum += w * glm::dvec3(scene.displacement->texels[static_cast<std::size_t>(index)]);
  }
  return sum;
}

/// The noise of the tile, and its detail.
struct TruthNoise {
  glm::dvec4 tile{0.5};
  glm::dvec2 detail{0};
};

TruthNoise smoke_noise(const TruthScene& scene, glm::dvec3 p_world, glm::dvec3 p_voxel) {
  if (scene.noise == nullptr) return {};
  const glm::dvec3 from = p_world + advection_at(scene, p_voxel),
                   rise(0, double{scene.look.rise} * scene.time, 0);
  const double frequency{scene.look.noise_frequency};
  const glm::dvec4 tile = noise_at(*scene.noise, (from - rise) * frequency);
  if (scene.detail == nullptr) return {tile, glm::dvec2(0)};
  const glm::dvec4 texel =
      noise_at(*scene.detail, (from - 1.25 * rise) * frequency * 5.3 + glm::dvec3(0.31, 0.17, 0.73));
  return {tile, 0.54 * (2.0 * glm::dvec2(texel) - 1.0)};
}

/// Fraction of the smoke that a hole removes: the rule of shaders/shared/hole.h.
double hole_share(const shared::Hole& hole, glm::dvec3 p_world, double time, double rim) {
  const glm::dvec3 apart = p_world - glm::dvec3(hole.origin_world);
  const double z = glm::dot(apart, glm::dvec3(hole.forward)), far = double{hole.distance_to_far};
  if (z < 0 || z > far) return 0;
  const double age = time - double{hole.time_start} - z / far * double{hole.time_to_reach_far};
  if (age <= 0) return 0;
  const double opened = std::min(age / std::max(double{hole.time_to_expand}, 1e-6), 1.0);
  const double closing = age - double{hole.time_to_expand} - double{hole.time_to_stay_open};
  const double closed = std::clamp(closing / std::max(double{hole.time_to_fade}, 1e-6), 0.0, 1.0);
  const double radius = (double{hole.radius} + rim) * opened * (1 - closed);
  const double x = glm::dot(apart, glm::dvec3(hole.right)), y = glm::dot(apart, glm::dvec3(hole.up));
  const double out =
      hole.shape == shared::kHoleCylinder ? std::hypot(x, y) : std::max(std::abs(x), std::abs(y));
  if (out >= radius) return 0;
  return (1 - closed) * smooth((radius - out) / (radius * double{shared::kHoleSoftFraction}));
}

/// Distance to a triangle along a unit direction (Moeller and Trumbore 1997); nothing if the ray misses.
std::optional<double> hit(const TruthTriangle& t, glm::dvec3 from, glm::dvec3 direction) {
  const glm::dvec3 u = t.b - t.a, v = t.c - t.a, p = glm::cross(direction, v);
  const double determinant = glm::dot(u, p);
  if (std::abs(determinant) < 1e-14) return {};
  const glm::dvec3 s = (from - t.a) / determinant, q = glm::cross(s, u);
  const double x = glm::dot(s, p), y = glm::dot(direction, q), at = glm::dot(v, q);
  if (x < 0 || y < 0 || x + y > 1 || at < 1e-6) return {};
  return at;
}

/// The part of a ray inside the smoke's bounds [m].
struct Interval {
  double begin, end;
};
Interval inside(const smoke::SmokeVolume& volume, glm::dvec3 from, glm::dvec3 direction, double end) {
  const shared::VolumeLayout& frame = volume.layout();
  const glm::dvec3 origin(frame.origin_world);
  Interval way{0, end};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = origin[axis] + double{frame.bounds_min[axis]} * double{frame.voxel_size};
    const double high = origin[axis] + double{frame.bounds_max[axis]} * double{frame.voxel_size};
    const double slope = std::abs(direction[axis]) > 1e-12 ? direction[axis] : 1e-12;
    const double a = (low - from[axis]) / slope, b = (high - from[axis]) / slope;
    way.begin = std::max(way.begin, std::min(a, b));
    way.end = std::min(way.end, std::max(a, b));
  }
  return way;
}

/// Calls step(t, length) for equal steps of at most `longest` over a part of a ray, t in their middles.
template <typename Step>
void walk(Interval way, double longest, const Step& step) {
  if (way.end <= way.begin) return;
  const auto count = static_cast<std::int64_t>(std::ceil((way.end - way.begin) / longest));
  const double length = (way.end - way.begin) / static_cast<double>(count);
  for (std::int64_t i = 0; i < count; ++i)
    if (!step(way.begin + (static_cast<double>(i) + 0.5) * length, length)) return;
}

struct Incident {
  glm::dvec3 irradiance, to_light;
  double distance;
};

/// Light that reaches a point through scene and smoke: the rule of shaders/lib/lights.glsl, shadows exact.
std::optional<Incident> light_at(const TruthScene& scene, const shared::Light& light, glm::dvec3 p) {
  Incident incident{glm::dvec3(light.intensity), -glm::dvec3(light.direction), kFar};
  if (light.kind != shared::kLightDirectional) {
    const glm::dvec3 apart = glm::dvec3(light.position_world) - p;
    const double d2 = std::max(glm::dot(apart, apart), 1e-4),
                 x = d2 / (double{light.range} * double{light.range});
    incident.distance = std::sqrt(d2);
    incident.to_light = apart / incident.distance;
    const double window = std::clamp(1 - x * x, 0.0, 1.0);
    incident.irradiance *=
        window * window / std::max(d2, light.radius > 0 ? double{light.radius} * double{light.radius} : 0.01);
    if (light.kind == shared::kLightSpot) {
      const double c = glm::dot(-incident.to_light, glm::dvec3(light.direction));
      const double ramp = std::clamp(
          (c - double{light.cos_outer}) / (double{light.cos_inner} - double{light.cos_outer}), 0.0, 1.0);
      incident.irradiance *= ramp * ramp;
    }
  }
  if (incident.irradiance == glm::dvec3(0)) return {};
  for (const TruthTriangle& triangle : scene.triangles) {
    const auto at = hit(triangle, p, incident.to_light);
    if (at && *at < incident.distance) return {};
  }
  double depth = 0;
  const double voxel = double{scene.volume->layout().voxel_size}, sigma = double{scene.look.extinction};
  walk(inside(*scene.volume, p, incident.to_light, incident.distance), scene.light_step * voxel,
       [&](double t, double length) {
         depth += sigma * truth_density(scene, p + t * incident.to_light) * length;
         return depth < 20;
       });
  incident.irradiance *= std::exp(-depth);
  return incident;
}

/// Radiance towards `view` for unit irradiance of a dielectric surface: the rule of
/// shaders/lib/shading.glsl.
glm::dvec3 reflected(const TruthTriangle& surface, glm::dvec3 normal, glm::dvec3 view, glm::dvec3 to_light) {
  const double n_l = glm::dot(normal, to_light), n_v = std::max(glm::dot(normal, view), 1e-3);
  if (n_l <= 0) return glm::dvec3(0);
  const glm::dvec3 h = glm::normalize(view + to_light);
  const double n_h = std::max(glm::dot(normal, h), 0.0),
               alpha = std::max(surface.roughness * surface.roughness, 0.02);
  const double d = n_h * n_h * (alpha * alpha - 1) + 1, distribution = alpha * alpha / (kPi * d * d);
  const double visibility = 0.5 / (2 * n_l * n_v * (1 - alpha) + (n_l + n_v) * alpha);
  const double fresnel = 0.04 + 0.96 * std::pow(1 - std::max(glm::dot(h, view), 0.0), 5);
  return (surface.albedo * ((1 - fresnel) / kPi) + fresnel * distribution * visibility) * n_l;
}

TruthPixel trace(const TruthScene& scene, glm::dvec2 position_px) {
  const glm::dvec2 ndc = position_px / glm::dvec2(scene.size_px) * 2.0 - 1.0;
  const glm::dvec3 eye(scene.camera.eye_world);
  const glm::dvec3 direction =
      glm::normalize(glm::dvec3(scene.camera.forward) + ndc.x * glm::dvec3(scene.camera.right) -
                     ndc.y * glm::dvec3(scene.camera.up));
  // The surface behind the smoke.
  double t_surface = kFar;
  const TruthTriangle* surface = nullptr;
  for (const TruthTriangle& triangle : scene.triangles) {
    const auto at = hit(triangle, eye, direction);
    if (!at || *at >= t_surface) continue;
    t_surface = *at;
    surface = &triangle;
  }
  TruthPixel pixel;
  if (surface != nullptr) {
    glm::dvec3 normal = glm::normalize(glm::cross(surface->b - surface->a, surface->c - surface->a));
    if (glm::dot(normal, direction) > 0) normal = -normal;
    pixel.surface = surface->emission;
    const glm::dvec3 p = eye + t_surface * direction + 1e-5 * normal;
    for (const shared::Light& light : scene.lights) {
      const auto incident = light_at(scene, light, p);
      if (incident)
        pixel.surface += reflected(*surface, normal, -direction, incident->to_light) * incident->irradiance;
    }
  }
  // The smoke in front of it. In-scatter is constant within a step, and its transmittance there is exact.
  const double voxel = double{scene.volume->layout().voxel_size}, sigma = double{scene.look.extinction};
  walk(inside(*scene.volume, eye, direction, t_surface), scene.view_step * voxel,
       [&](double t, double length) {
         const glm::dvec3 p = eye + t * direction;
         const double density = truth_density(scene, p);
         if (density <= 0) return true;
         glm::dvec3 radiance(0);
         for (const shared::Light& light : scene.lights) {
           const auto incident = light_at(scene, light, p);
           if (!incident) continue;
           radiance +=
               incident->irradiance * phase_value(scene.look.phase, glm::dot(incident->to_light, direction));
         }
         const double passed = std::exp(-sigma * density * length);
         pixel.smoke += pixel.transmittance * (1 - passed) * radiance * glm::dvec3(scene.look.albedo);
         pixel.transmittance *= passed;
         return pixel.transmittance > 1e-6;
       });
  return pixel;
}

}  // namespace

std::vector<TruthTriangle> truth_triangles(const scene::Scene& scene) {
  std::vector<TruthTriangle> triangles;
  for (const scene::Object& object : scene.objects) {
    const scene::Mesh& mesh = scene.meshes[object.mesh];
    const scene::Material& material = scene.materials[object.material];
    const auto corner = [&](std::size_t i) {
      return glm::dvec3(object.world_from_mesh * glm::vec4(mesh.vertices[mesh.indices[i]].position, 1));
    };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      triangles.push_back({corner(i), corner(i + 1), corner(i + 2), glm::dvec3(material.base_color),
                           glm::dvec3(material.emission), double{material.roughness}});
    }
  }
  return triangles;
}

double truth_density(const TruthScene& scene, glm::dvec3 p_world) {
  const shared::VolumeLayout& frame = scene.volume->layout();
  const glm::dvec3 p_voxel = (p_world - glm::dvec3(frame.origin_world)) / double{frame.voxel_size};
  double density = smoke_density(*scene.volume, p_voxel);
  if (density <= 0) return 0;
  const bool eroding = scene.look.erosion > 0;
  const TruthNoise noise =
      eroding || scene.look.hole_rim > 0 ? smoke_noise(scene, p_world, p_voxel) : TruthNoise{};
  if (eroding)
    density = double{shared::erode(scene.look, static_cast<float>(density), glm::vec4(noise.tile),
                                   glm::vec2(noise.detail), scene.look.detail)};
  const double rim_noise = 2 * noise.tile.g - 1 + 1.5 * double{scene.look.detail} * noise.detail.x;
  const double rim = std::clamp(rim_noise, -1.0, 1.0) * double{scene.look.hole_rim};
  for (const shared::Hole& hole : scene.holes) density *= 1 - hole_share(hole, p_world, scene.time, rim);
  return density;
}

std::vector<TruthPixel> trace_truth(const TruthScene& scene) {
  std::vector<TruthPixel> pixels(std::size_t{scene.size_px.x} * scene.size_px.y);
  parallel_for(pixels.size(), scene.size_px.x, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      pixels[i] = trace(scene, {double(i % scene.size_px.x) + 0.5, double(i / scene.size_px.x) + 0.5});
  });
  return pixels;
}

}  // namespace brume::reference
