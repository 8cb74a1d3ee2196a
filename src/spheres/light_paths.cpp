#include "spheres/light_paths.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/progress.hpp"
#include "core/same_bytes.hpp"
#include "core/tasks.hpp"
#include "shared/dda.h"

namespace brume::spheres {
namespace {

constexpr std::size_t kPathsOfTask = 4096;
/// Crossings of the glass at most: light that total reflection keeps inside is lost.
constexpr int kMostCrossings = 64;
/// Photons within the radius of a chosen one, about.
constexpr double kGathered = 30;
constexpr double kLeastRadius = 0.25, kMostRadius = 8;  // [voxels]
constexpr float kNever = std::numeric_limits<float>::infinity();

double largest(const glm::vec3& v) {
  return static_cast<double>(std::max({v.x, v.y, v.z}));
}

/// Numbers in [0, 1) of one path.
class PathRandom {
 public:
  PathRandom(std::uint32_t path, std::uint32_t light, std::uint64_t seed)
      : seed_(path, light << 24, static_cast<std::uint32_t>(seed ^ seed >> 32)) {}
  glm::vec3 next() {
    ++seed_.y;
    return shared::hash3(seed_);
  }
  /// Names a ray.
  std::uint32_t name() {
    ++seed_.y;
    return shared::pcg3d(seed_).x;
  }

 private:
  glm::uvec3 seed_;
};

/// Paths of a light: in all directions in which it may shine on the glass.
struct Beam {
  const LightBall* light = nullptr;
  glm::dvec3 axis{0, 0, 1};
  double height = 2;  ///< 1 - cosine of the cone's half angle; 2: all directions.
  std::uint32_t first = 0, count = 0;
  double solid_angle() const { return 2 * std::numbers::pi * height; }
};

Beam make_beam(const LightBall& light, const shared::Glass& glass) {
  // A ball around the glass, and the lines through all of the light.
  Beam beam{&light};
  const glm::dvec3 apart = glm::dvec3(glass.center) - glm::dvec3(light.position);
  const double distance = glm::length(apart);
  const double reach = largest(glass.radii) + static_cast<double>(light.radius);
  if (distance <= reach) return beam;
  const double sine = reach / distance;
  beam.axis = apart / distance;
  beam.height = sine * sine / (1 + std::sqrt(1 - sine * sine));
  return beam;
}

/// Beams with numbers of paths in proportion to their power, at least one.
std::vector<Beam> make_beams(const LightPathScene& scene, std::uint32_t count) {
  std::vector<Beam> beams;
  double power = 0;
  for (const LightBall& light : scene.lights) {
    if (!(largest(light.intensity) > 0)) continue;
    beams.push_back(make_beam(light, scene.glass));
    power += largest(light.intensity) * beams.back().solid_angle();
  }
  std::uint32_t first = 0;
  for (Beam& beam : beams) {
    const double part = largest(beam.light->intensity) * beam.solid_angle() / power;
    beam.first = first;
    beam.count = std::max(1u, static_cast<std::uint32_t>(part * count));
    first += beam.count;
  }
  return beams;
}

/// Two unit vectors across a third.
void across(const glm::dvec3& n, glm::dvec3& x, glm::dvec3& y) {
  x = glm::normalize(glm::cross(std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), n));
  y = glm::cross(n, x);
}

struct Line {
  glm::vec3 origin{0}, direction{0};
};

/// Line i of a beam. The lines of one direction are spread over the disk across it that the light's ball
/// shows: that is what a ball of constant radiance emits, and from afar it shines as its intensity says.
Line line_of(const Beam& beam, std::uint32_t i, PathRandom& random, const glm::dvec2& shift) {
  // Directions by the sequence of Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences".
  const glm::dvec2 u =
      glm::fract(shift + static_cast<double>(i) * glm::dvec2(0.7548776662466927, 0.5698402909980532));
  glm::dvec3 x, y;
  across(beam.axis, x, y);
  const double cosine = 1 - u.x * beam.height, sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double turn = 2 * std::numbers::pi * u.y;
  const glm::dvec3 direction =
      glm::normalize(cosine * beam.axis + sine * (std::cos(turn) * x + std::sin(turn) * y));

  const glm::dvec3 v(random.next());
  const double radius = static_cast<double>(beam.light->radius), out = std::sqrt(v.x);
  across(direction, x, y);
  const double angle = 2 * std::numbers::pi * v.y;
  const glm::dvec3 on_ball =
      out * (std::cos(angle) * x + std::sin(angle) * y) + std::sqrt(1 - v.x) * direction;
  return {glm::vec3(glm::dvec3(beam.light->position) + radius * on_ball), glm::vec3(direction)};
}

/// Where a ray ends among the spheres.
struct Event {
  float t = kNever;
  std::uint32_t sphere = 0;
  enum class Kind { none, surface, medium, hidden } kind = Kind::none;
};

class Tracer {
 public:
  Tracer(const Tank& tank, const BrickLists& bricks, const shared::Glass& glass)
      : tank_(tank), bricks_(bricks), glass_(glass) {}

  /// The photon at the end of a path; nothing where it has not met the glass, or meets no sphere.
  std::optional<shared::Photon> trace(const Line& line, const glm::vec3& flux, PathRandom& random) const;

 private:
  void meet(const Line& ray, std::uint32_t sphere, std::uint32_t name, Event& nearest) const;
  Event event(const Line& ray, float end, std::uint32_t name) const;
  /// Reflects or refracts a ray at the surface of the glass; true: it passes.
  bool cross(Line& ray, bool inside, float random) const;

  const Tank& tank_;
  const BrickLists& bricks_;
  shared::Glass glass_;
};

/// The event of one sphere. In a medium it depends on the ray and the sphere alone: it may be tried in many
/// bricks.
void Tracer::meet(const Line& ray, std::uint32_t sphere, std::uint32_t name, Event& nearest) const {
  const Sphere& ball = tank_.spheres[sphere];
  const glm::dvec3 apart = glm::dvec3(ball.center) - glm::dvec3(ray.origin), direction(ray.direction);
  const double middle = glm::dot(apart, direction), radius = static_cast<double>(ball.radius);
  const glm::dvec3 beside = apart - middle * direction;
  const double squared = radius * radius - glm::dot(beside, beside);
  if (squared < 0) return;
  const double half = std::sqrt(squared), enter = middle - half, leave = middle + half;
  if (leave <= 0 || enter >= static_cast<double>(nearest.t)) return;
  const std::uint32_t opacity = tank_.colors[sphere] >> 24;
  if (opacity == 255) {
    // What begins inside of an opaque sphere stays there.
    nearest = {static_cast<float>(std::max(enter, 0.0)), sphere,
               enter < 0 ? Event::Kind::hidden : Event::Kind::surface};
    return;
  }
  if (opacity == 0) return;
  const float random = shared::hash3({name, sphere, 0x2545f491u}).x;
  const double free_path = std::log1p(-static_cast<double>(random)) / std::log(1 - opacity / 255.0);
  const double t = std::max(enter, 0.0) + free_path;
  if (t < leave && t < static_cast<double>(nearest.t))
    nearest = {static_cast<float>(t), sphere, Event::Kind::medium};
}

Event Tracer::event(const Line& ray, float end, std::uint32_t name) const {
  Event nearest;
  nearest.t = end;
  shared::Dda dda = shared::dda_begin(ray.origin, ray.direction, glm::ivec3(0), bricks_.bricks,
                                      shared::kSphereBrick, 0, end);
  while (dda.t < dda.t_end) {
    const shared::SphereBrick& brick = bricks_.ranges[bricks_.index(dda.cell)];
    for (std::uint32_t i = 0; i < brick.count; ++i)
      meet(ray, bricks_.spheres[std::size_t{brick.first} + i], name, nearest);
    dda = shared::dda_step(dda);
    // Events of spheres that reach out of the brick count when all bricks before them have been visited.
    if (nearest.t <= dda.t) break;
  }
  return nearest;
}

bool Tracer::cross(Line& ray, bool inside, float random) const {
  glm::vec3 normal = shared::glass_normal(glass_, ray.origin);
  if (inside) normal = -normal;
  const float ratio = inside ? glass_.index : 1 / glass_.index;
  const float cosine = std::clamp(-glm::dot(ray.direction, normal), 0.0f, 1.0f);
  const glm::vec3 behind = shared::refracted(ray.direction, normal, ratio);
  if (random < shared::fresnel_reflectance(cosine, ratio) || behind == glm::vec3(0)) {
    ray.direction = shared::mirrored(ray.direction, normal);
    return false;
  }
  ray.direction = behind;
  return true;
}

std::optional<shared::Photon> Tracer::trace(const Line& line, const glm::vec3& flux,
                                            PathRandom& random) const {
  Line ray = line;
  const glm::vec3 scaled = (ray.origin - glass_.center) / glass_.radii;
  bool inside = glm::dot(scaled, scaled) < 1, met = inside, left = false;
  for (int crossings = 0; crossings <= kMostCrossings; ++crossings) {
    // The glass, which is convex: what has left it does not meet it again.
    float to_glass = kNever;
    const glm::vec2 crossed = shared::glass_crossings(glass_, ray.origin, ray.direction);
    if (inside)
      to_glass = std::max(crossed.y, 0.0f);
    else if (!left && crossed.x < crossed.y && crossed.x > 0)
      to_glass = crossed.x;
    if (!met && to_glass == kNever) return {};

    // A sphere.
    const Event nearest = event(ray, to_glass, random.name());
    if (nearest.kind != Event::Kind::none) {
      if (!met || nearest.kind == Event::Kind::hidden) return {};
      glm::vec3 at = ray.origin + nearest.t * ray.direction;
      const Sphere& ball = tank_.spheres[nearest.sphere];
      if (nearest.kind == Event::Kind::surface)
        at = ball.center + ball.radius * glm::normalize(at - ball.center);
      const float index = inside ? glass_.index : 1.0f;
      return shared::Photon{at, nearest.sphere + 1, flux / (index * index),
                            shared::packed_direction(ray.direction)};
    }
    if (to_glass == kNever) return {};
    ray.origin += to_glass * ray.direction;
    inside = inside != cross(ray, inside, random.next().x);
    left = !inside;
    met = true;
  }
  return {};
}

/// A radius within which the photon in the middle of all that are sorted by the light around them has about
/// kGathered others: as if the photons of a sphere were spread over half of its surface, or its ball.
float chosen_radius(const Tank& tank, const std::vector<shared::Photon>& photons) {
  if (photons.empty()) return 1;
  std::vector<std::uint32_t> counts(tank.spheres.size());
  for (const shared::Photon& photon : photons) ++counts[photon.id - 1];
  std::vector<double> radii;
  for (const shared::Photon& photon : photons) {
    const double radius = static_cast<double>(tank.spheres[photon.id - 1].radius),
                 count = counts[photon.id - 1];
    const bool is_surface = tank.colors[photon.id - 1] >> 24 == 255;
    radii.push_back(radius * (is_surface ? std::sqrt(2 * kGathered / count) : std::cbrt(kGathered / count)));
  }
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return static_cast<float>(std::clamp(*middle, kLeastRadius, kMostRadius));
}

}  // namespace

bool same_light(const LightPathScene& a, const LightPathScene& b) {
  return same_bytes(a.glass, b.glass) && std::ranges::equal(a.lights, b.lights, same_bytes<LightBall>);
}

LightPaths trace_light_paths(const Tank& tank, const BrickLists& bricks, const LightPathScene& scene,
                             const LightPathOptions& options, const std::function<bool()>& stopped) {
  if (!(scene.glass.index > 0) || options.count == 0) return {};
  const std::vector<Beam> beams = make_beams(scene, std::min(options.count, shared::kMostPhotons - 64));
  if (beams.empty()) return {};
  const std::size_t count = std::size_t{beams.back().first} + beams.back().count;
  Progress progress("light paths", count);

  // Each task writes what it finds in the order of its paths.
  const std::size_t tasks = (count + kPathsOfTask - 1) / kPathsOfTask;
  std::vector<std::vector<shared::Photon>> found(tasks);
  std::atomic<bool> over = false;
  const Tracer tracer(tank, bricks, scene.glass);
  parallel_for(tasks, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t task = begin; task < end; ++task) {
      if (over || (stopped && stopped())) {
        over = true;
        return;
      }
      const std::size_t last = std::min(count, (task + 1) * kPathsOfTask);
      for (std::size_t path = task * kPathsOfTask; path < last; ++path) {
        std::size_t k = beams.size() - 1;
        while (beams[k].first > path) --k;
        const Beam& beam = beams[k];
        const auto index = static_cast<std::uint32_t>(k), i = static_cast<std::uint32_t>(path) - beam.first;
        const glm::dvec2 shift(PathRandom(UINT32_MAX, index, options.seed).next());
        PathRandom random(i, index, options.seed);
        const Line line = line_of(beam, i, random, shift);
        const glm::vec3 flux = beam.light->intensity * static_cast<float>(beam.solid_angle() / beam.count);
        if (const auto photon = tracer.trace(line, flux, random)) found[task].push_back(*photon);
      }
      progress.advance(last - task * kPathsOfTask);
    }
  });
  if (over) return {};

  std::vector<shared::Photon> photons;
  for (std::vector<shared::Photon>& part : found) {
    photons.insert(photons.end(), part.begin(), part.end());
    part = {};
  }
  const float radius = options.radius > 0 ? options.radius : chosen_radius(tank, photons);
  return sort_photons(std::move(photons), radius);
}

LightPaths sort_photons(std::vector<shared::Photon> photons, float radius) {
  LightPaths paths;
  if (photons.empty()) return paths;
  const std::uint32_t hashes = std::bit_ceil(static_cast<std::uint32_t>(photons.size()));
  paths.grid = {radius, hashes - 1};
  std::vector<std::uint32_t> keys(photons.size());
  parallel_for(photons.size(), 1u << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      keys[i] = shared::photon_hash(paths.grid, shared::photon_cell(paths.grid, photons[i].position));
  });

  // By counting.
  paths.cells.assign(std::size_t{hashes} + 1, 0);
  for (const std::uint32_t key : keys) ++paths.cells[std::size_t{key} + 1];
  for (std::size_t i = 1; i < paths.cells.size(); ++i) paths.cells[i] += paths.cells[i - 1];
  std::vector<std::uint32_t> next(paths.cells.begin(), paths.cells.end() - 1);
  paths.photons.resize(photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i) paths.photons[next[keys[i]]++] = photons[i];
  return paths;
}

glm::vec3 LightPaths::gather(const glm::vec3& at, std::uint32_t sphere, const Sphere& ball,
                             float extinction) const {
  glm::vec3 sum(0);
  if (photons.empty()) return sum;
  const bool is_medium = extinction > 0;
  const glm::vec3 normal = glm::normalize(at - ball.center);
  const glm::ivec3 corner = shared::photon_corner(grid, at);
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 cell = corner + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
    const std::uint32_t hash = shared::photon_hash(grid, cell);
    for (std::uint32_t k = cells[hash]; k < cells[std::size_t{hash} + 1]; ++k) {
      const shared::Photon& photon = photons[k];
      if (!shared::photon_counts(grid, photon, cell, sphere + 1, at)) continue;
      const float cosine = -glm::dot(normal, shared::unpacked_direction(photon.direction));
      sum += photon.flux * (is_medium ? 1.0f : shared::photon_per_area(grid.radius, ball.radius, cosine));
    }
  }
  if (!is_medium) return sum;
  return sum *
         shared::photon_per_volume(grid.radius, ball.radius, glm::distance(at, ball.center), extinction);
}

glm::dvec3 LightPaths::flux() const {
  glm::dvec3 sum(0);
  for (const shared::Photon& photon : photons) sum += glm::dvec3(photon.flux);
  return sum;
}

}  // namespace brume::spheres
