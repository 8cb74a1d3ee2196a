#include "tests/reference/multiple_scattering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/tasks.hpp"
#include "tests/reference/phase.hpp"

namespace brume::reference {
namespace {

constexpr double kPi = std::numbers::pi, kFar = 1e6;
constexpr int kLongestWalk = 4000;

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

glm::dvec3 turned(glm::dvec3 axis, double cosine, double angle) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const glm::dvec3 helper = std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(axis, helper)), v = glm::cross(axis, u);
  return glm::normalize(cosine * axis + sine * (std::cos(angle) * u + std::sin(angle) * v));
}

/// A cosine spread as Henyey-Greenstein (their distribution inverted).
double henyey_greenstein_cosine(double g, double u) {
  if (std::abs(g) < 1e-6) return 2 * u - 1;
  const double s = (1 - g * g) / (1 - g + 2 * g * u);
  return std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0);
}

/// The light at a point of the body: its direction, its irradiance without smoke, the optical depth.
struct Arrival {
  glm::dvec3 direction;
  double irradiance, depth;
};
Arrival arrival(const Body& body, const BodyLight& light, glm::dvec3 p) {
  if (light.directional) {
    const double off_axis = glm::length(glm::cross(p, light.direction));
    return {light.direction, off_axis < light.beam ? 1.0 : 0.0, body.exit_distance(p, -light.direction)};
  }
  const glm::dvec3 offset = p - light.position;
  const double d2 = glm::dot(offset, offset), d = std::sqrt(d2);
  return {offset / d, glm::dot(light.position, light.position) / d2,
          std::min(d, body.exit_distance(p, -offset / d))};
}

double escape_probability(const Body& body, glm::dvec3 p) {
  constexpr int kDirections = 2000;
  double sum = 0;
  for (int i = 0; i < kDirections; ++i) {  // a spiral of even directions
    const double z = 1 - (2 * i + 1.0) / kDirections, angle = i * kPi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    sum += std::exp(-body.exit_distance(p, {r * std::cos(angle), r * std::sin(angle), z}));
  }
  return sum / kDirections;
}

}  // namespace

bool Body::contains(glm::dvec3 p) const {
  if (shape == Shape::slab) return std::abs(p.z) < half;
  if (shape == Shape::sphere) return glm::dot(p, p) < half * half;
  return glm::all(glm::lessThan(glm::abs(p), glm::dvec3(half)));
}

double Body::exit_distance(glm::dvec3 p, glm::dvec3 direction) const {
  if (shape == Shape::sphere) {
    const double b = glm::dot(p, direction), c = glm::dot(p, p) - half * half;
    return std::max(0.0, -b + std::sqrt(std::max(0.0, b * b - c)));
  }
  double distance = kFar;
  for (int axis = shape == Shape::slab ? 2 : 0; axis < 3; ++axis) {
    const double d = direction[axis];
    if (std::abs(d) > 1e-9) distance = std::min(distance, ((d > 0 ? half : -half) - p[axis]) / d);
  }
  return std::max(distance, 0.0);
}

std::vector<ScatteringSample> walk_light(const Body& body, const BodyLight& light, double g,
                                         const std::vector<double>& albedos, glm::dvec3 p, glm::dvec3 out,
                                         std::uint32_t walks, std::uint64_t seed) {
  const Arrival here = arrival(body, light, p);
  ScatteringSample common;
  common.g = g;
  common.depth = here.depth;
  common.cos_angle = glm::dot(here.direction, out);
  common.escape = escape_probability(body, p);
  common.irradiance = here.irradiance;
  common.once = here.irradiance * std::exp(-here.depth) * draine(g, 0, common.cos_angle);
  std::vector<ScatteringSample> samples(albedos.size(), common);
  std::vector<double> squares(albedos.size(), 0), sums(albedos.size()), weights(albedos.size());

  Random random(seed);
  for (std::uint32_t walk = 0; walk < walks; ++walk) {
    std::fill(sums.begin(), sums.end(), 0);
    std::fill(weights.begin(), weights.end(), 1);
    glm::dvec3 at = p, direction = out;  // backwards: `direction` is that of the light
    for (int bounce = 0; bounce < kLongestWalk; ++bounce) {
      direction = turned(direction, henyey_greenstein_cosine(g, random.next()), 2 * kPi * random.next());
      const double step = -std::log1p(-random.next());
      if (step >= body.exit_distance(at, -direction)) break;
      at -= step * direction;
      const Arrival there = arrival(body, light, at);
      const double scattered =
          there.irradiance * std::exp(-there.depth) * draine(g, 0, glm::dot(there.direction, direction));
      for (std::size_t i = 0; i < albedos.size(); ++i) {
        weights[i] *= albedos[i];
        sums[i] += weights[i] * scattered;
      }
    }
    for (std::size_t i = 0; i < albedos.size(); ++i) {
      samples[i].more += sums[i] / walks;
      squares[i] += sums[i] * sums[i] / walks;
    }
  }
  for (std::size_t i = 0; i < albedos.size(); ++i) {
    samples[i].albedo = albedos[i];
    samples[i].error = std::sqrt(std::max(0.0, squares[i] - samples[i].more * samples[i].more) / walks);
  }
  return samples;
}

std::vector<ScatteringSample> scattering_samples(const std::vector<double>& gs,
                                                 const std::vector<double>& albedos, std::uint32_t walks,
                                                 std::uint64_t seed) {
  struct Place {
    Body body;
    BodyLight light;
    glm::dvec3 p;
  };
  std::vector<Place> places;
  using Shape = Body::Shape;
  const glm::dvec3 oblique = glm::normalize(glm::dvec3(0.8, 0.1, 0.6));
  for (const double half : {0.25, 1.0, 4.0})  // slabs, lit from the front and obliquely
    for (const double z : {-0.95, -0.7, -0.3, 0.2, 0.8})
      for (const glm::dvec3 direction : {glm::dvec3(0, 0, 1), oblique})
        places.push_back({{Shape::slab, half}, {true, direction, {}}, {0, 0, z * half}});
  for (const Shape shape : {Shape::sphere, Shape::box})  // bodies, lit from afar and from nearby
    for (const double half : {0.4, 1.5, 3.5, 7.0})
      for (const glm::dvec3 at : {glm::dvec3(0, 0, -0.95), glm::dvec3(0.1, 0, -0.6), glm::dvec3(0, 0.6, -0.2),
                                  glm::dvec3(0), glm::dvec3(0.7, 0, 0.3), glm::dvec3(0, 0.1, 0.85)})
        for (const bool afar : {true, false})
          places.push_back({{shape, half}, {afar, {0, 0, 1}, {0, 0, -2 * half}}, half * at});
  constexpr double kCosines[] = {-0.95, -0.4, 0.1, 0.6, 0.95};
  const std::size_t per_g = places.size() * std::size(kCosines);
  std::vector<std::vector<ScatteringSample>> all(gs.size() * per_g);
  parallel_for(all.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Place& place = places[i % per_g / std::size(kCosines)];
      const glm::dvec3 direction = arrival(place.body, place.light, place.p).direction;
      const glm::dvec3 out =
          turned(direction, kCosines[i % std::size(kCosines)], 2.4 * static_cast<double>(i));
      all[i] = walk_light(place.body, place.light, gs[i / per_g], albedos, place.p, out, walks,
                          seed + 1000003 * i);
    }
  });
  std::vector<ScatteringSample> samples;
  for (const auto& some : all) samples.insert(samples.end(), some.begin(), some.end());
  return samples;
}

}  // namespace brume::reference
