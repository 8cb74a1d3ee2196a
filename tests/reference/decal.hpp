// Occlusion by a decal in double precision, and how far floats may be off it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "tests/reference/slice_atlas.hpp"

namespace brume::reference {

/// All values that a computation of limited precision may have.
struct Interval {
  double low = 0, high = 0;
  Interval() = default;
  Interval(double value, double error) : low(value - error), high(value + error) {}
  Interval clamped(double least, double most) const {
    Interval result;
    result.low = std::clamp(low, least, most);
    result.high = std::clamp(high, least, most);
    return result;
  }
};
/// Of values that are not negative.
inline Interval operator*(Interval a, Interval b) {
  a.low *= b.low;
  a.high *= b.high;
  return a;
}
/// By a fraction of the value.
inline Interval widened(Interval a, double relative) {
  a.low -= relative * std::abs(a.low);
  a.high += relative * std::abs(a.high);
  return a;
}

/// What the errors of floats are, as the test derives them.
struct DecalErrors {
  glm::dvec3 uvw{0};
  double value = 0;     ///< Of a sample of the volume, beyond what uvw explains.
  double weight = 0;    ///< Of the weights of both channels.
  double relative = 0;  ///< Of all that follows: a few roundings.
};

struct Decal {
  TexelVolume occlusion;  ///< x: of what faces up, y: of what faces down.
  glm::dmat4 uvw_from_world{1};
  glm::dvec3 up_world{0, 1, 0};
  glm::dvec3 scatter{0};
  glm::dvec3 middle_world{0};
  double radius = 0;
  double strength = 1, gamma_off = 0, falloff = 1, fade = 0;

  glm::dvec3 uvw(glm::dvec3 p_world) const { return glm::dvec3(uvw_from_world * glm::dvec4(p_world, 1)); }
  static bool contains(glm::dvec3 uvw, glm::dvec3 margin = glm::dvec3(0)) {
    return glm::all(glm::greaterThanEqual(uvw, -margin)) && glm::all(glm::lessThanEqual(uvw, 1.0 + margin));
  }

  /// How much of both channels a surface with a unit normal has. In the direction d of the middle, of spread
  /// s, occluders hide W sqrt((d n)^2 + s^2) of both sides of a plane with the normal n, and W d n more
  /// before it than behind it.
  glm::dvec2 weights(glm::dvec3 p_world, glm::dvec3 normal) const {
    const double facing = glm::dot(normal, up_world);
    if (radius == 0) return {(1 + facing) / 2, (1 - facing) / 2};
    const double distance = glm::length(middle_world - p_world), s = std::min(radius / distance, 1.0);
    const glm::dvec3 d = (middle_world - p_world) / distance;
    const double solid_angle = 1 / std::hypot(glm::dot(d, up_world), s);  // for a sum of 1
    const glm::dvec3 across = normal - facing * up_world;
    const double sum = solid_angle * (std::hypot(glm::dot(d, normal), s) + glm::dot(d, across));
    return {(sum + facing) / 2, (sum - facing) / 2};
  }

  /// At a point of the box, with the weights of both channels; 0 outside.
  double at(glm::dvec3 uvw, glm::dvec2 weights) const { return at(uvw, weights, uvw); }
  /// Of a sample for a surface at `own`, which has the exponent and the fade of that place.
  double at(glm::dvec3 uvw, glm::dvec2 weights, glm::dvec3 own) const {
    if (!contains(uvw)) return 0;
    const glm::dvec4 both = occlusion.sample(uvw);
    const double occluded = weights.x * both.x + weights.y * both.y;
    if (occluded <= 0) return 0;
    const double middle = std::max(1 - std::abs(2 * own.y - 1), 1e-6);
    return std::min(std::pow(occluded, 1 + gamma_off * std::pow(middle, falloff)), 1.0) * strength *
           fade_at(own);
  }

  /// Where floats may be.
  Interval at(glm::dvec3 uvw, glm::dvec2 weights, const DecalErrors& errors) const {
    return at(uvw, weights, uvw, errors);
  }
  Interval at(glm::dvec3 uvw, glm::dvec2 weights, glm::dvec3 own, const DecalErrors& errors) const {
    if (!contains(uvw, errors.uvw)) return {};
    // A texel differs from its neighbour by at most 1, so that the sample does by at most `size` times uvw.
    const glm::dvec4 both = occlusion.sample(glm::clamp(uvw, 0.0, 1.0));
    const double off = errors.value + glm::dot(errors.uvw, glm::dvec3(occlusion.size));
    const double off_sum = off * (std::abs(weights.x) + std::abs(weights.y)) + 2 * errors.weight;
    const Interval occluded = Interval(weights.x * both.x + weights.y * both.y, off_sum).clamped(0, 8);
    const Interval middle = Interval(1 - std::abs(2 * own.y - 1), 2 * errors.uvw.y + 1e-7).clamped(1e-6, 1);
    Interval exponent = power(middle, Interval(falloff, 0));
    exponent.low = 1 + gamma_off * exponent.low;
    exponent.high = 1 + gamma_off * exponent.high;
    if (gamma_off < 0) std::swap(exponent.low, exponent.high);
    const Interval powered = power(occluded, widened(exponent, errors.relative)).clamped(0, 1);
    Interval result = powered * Interval(strength, 0);
    for (int axis = 0; axis < 3; ++axis) result = result * fade_along(own[axis], errors.uvw[axis]);
    if (!contains(uvw, -errors.uvw)) result.low = 0;  // a face may be on either side
    return widened(result, errors.relative);
  }

 private:
  static double smooth(double x) { return x * x * (3 - 2 * x); }
  double fade_at(glm::dvec3 uvw) const {
    double product = 1;
    for (int axis = 0; axis < 3; ++axis) product *= fade_along(uvw[axis], 0).low;
    return product;
  }
  Interval fade_along(double x, double error) const {
    const double width = std::max(fade, 1e-4);
    Interval rim =
        Interval(std::min(x, 1 - x) / width, (error + (error > 0 ? 1e-7 : 0)) / width).clamped(0, 1);
    rim.low = smooth(rim.low);
    rim.high = smooth(rim.high);
    return rim;
  }

  /// x^y for x >= 0 and y >= 0, with the errors that Vulkan permits exp2(y log2 x): of log2 2^-21 between 1/2
  /// and 2, 3 ULP elsewhere, of exp2 3 + 2 |exponent| ULP.
  static Interval power(Interval x, Interval y) {
    Interval result;
    result.low = std::min(error_of_power(x.low, y.low, -1), error_of_power(x.low, y.high, -1));
    result.high = std::max(error_of_power(x.high, y.low, 1), error_of_power(x.high, y.high, 1));
    return result;
  }
  static double error_of_power(double x, double y, double sign) {
    if (x <= 0) return y == 0 ? 1 : 0;
    const double log = std::log2(x), power = y * log, ulp = std::ldexp(1.0, -23);
    const double of_log = y * std::max(std::ldexp(1.0, -21), 3 * ulp * std::abs(log)) + std::abs(power) * ulp;
    const double relative = 0.7 * of_log + (3 + 2 * std::abs(power)) * ulp;
    return std::pow(x, y) * (1 + sign * relative);
  }
};

}  // namespace brume::reference
