#include "scene/transfer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/color_space.hpp>
#include <glm/gtc/constants.hpp>

#include "core/similar.hpp"
#include "scene/text_reader.hpp"
#include "shared/ramp.h"

namespace brume::scene {
namespace {

constexpr std::array<std::string_view, 7> kNames{"cool-warm", "cubehelix", "grey",   "inferno",
                                                 "magma",     "plasma",    "viridis"};

/// CIE 1976 L*a*b* for the white of sRGB, D65.
constexpr glm::dvec3 kWhite(0.95047, 1, 1.08883);
glm::dvec3 to_lab(glm::dvec3 linear) {
  const glm::dvec3 xyz(0.4124564 * linear.r + 0.3575761 * linear.g + 0.1804375 * linear.b,
                       0.2126729 * linear.r + 0.7151522 * linear.g + 0.0721750 * linear.b,
                       0.0193339 * linear.r + 0.1191920 * linear.g + 0.9503041 * linear.b);
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const glm::dvec3 at(f(xyz.x / kWhite.x), f(xyz.y / kWhite.y), f(xyz.z / kWhite.z));
  return {116 * at.y - 16, 500 * (at.x - at.y), 200 * (at.y - at.z)};
}
glm::dvec3 to_linear(glm::dvec3 lab) {
  const double y = (lab.x + 16) / 116;
  const auto f = [](double t) { return t > 6.0 / 29 ? t * t * t : (116 * t - 16) * 27 / 24389; };
  const glm::dvec3 xyz = kWhite * glm::dvec3(f(y + lab.y / 500), f(y), f(y - lab.z / 200));
  return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
          -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
          0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

/// Moreland's polar form of L*a*b*: magnitude, saturation angle, hue angle.
glm::dvec3 to_msh(glm::dvec3 srgb) {
  const glm::dvec3 lab = to_lab(glm::convertSRGBToLinear(srgb));
  const double magnitude = glm::length(lab);
  return {magnitude, std::acos(lab.x / magnitude), std::atan2(lab.z, lab.y)};
}
glm::dvec3 linear_of_msh(glm::dvec3 msh) {
  const double radius = msh.x * std::sin(msh.y);
  return to_linear({msh.x * std::cos(msh.y), radius * std::cos(msh.z), radius * std::sin(msh.z)});
}

/// The hue with which an unsaturated colour of this magnitude meets a saturated one.
double hue_towards(glm::dvec3 saturated, double magnitude) {
  if (saturated.x >= magnitude) return saturated.z;
  const double spin = saturated.y * std::sqrt(magnitude * magnitude - saturated.x * saturated.x) /
                      (saturated.x * std::sin(saturated.y));
  return saturated.z > -glm::pi<double>() / 3 ? saturated.z + spin : saturated.z - spin;
}

glm::dvec3 cool_warm(double at) {
  static const glm::dvec3 cool = to_msh(glm::dvec3(59, 76, 192) / 255.0);
  static const glm::dvec3 warm = to_msh(glm::dvec3(180, 4, 38) / 255.0);
  constexpr double kMiddle = 88;
  const glm::dvec3 end = at < 0.5 ? cool : warm;
  const double magnitude = std::max({cool.x, warm.x, kMiddle});
  const glm::dvec3 middle(magnitude, 0, hue_towards(end, magnitude));
  return linear_of_msh(glm::mix(middle, end, std::abs(2 * at - 1)));
}

glm::dvec3 cubehelix(double at) {
  const double angle = 2 * glm::pi<double>() * (0.5 / 3 + 1 - 1.5 * at);
  const double amplitude = at * (1 - at) / 2, c = std::cos(angle), s = std::sin(angle);
  const glm::dvec3 srgb(at + amplitude * (-0.14861 * c + 1.78277 * s),
                        at + amplitude * (-0.29227 * c - 0.90649 * s), at + amplitude * 1.97294 * c);
  return glm::convertSRGBToLinear(glm::clamp(srgb, 0.0, 1.0));
}

glm::dvec3 named_color(std::string_view name, double at) {
  if (name == "cool-warm") return cool_warm(at);
  if (name == "cubehelix") return cubehelix(at);
  if (name == "grey") return glm::convertSRGBToLinear(glm::dvec3(at));
  const std::uint32_t ramp = name == "viridis"   ? shared::kRampViridis
                             : name == "inferno" ? shared::kRampInferno
                             : name == "magma"   ? shared::kRampMagma
                                                 : shared::kRampPlasma;
  return glm::convertSRGBToLinear(glm::dvec3(shared::ramp_colour(ramp, static_cast<float>(at))));
}

/// Between which points a position is: that before and that behind it, and how far from one to the other.
struct Between {
  std::size_t before, behind;
  double fraction;
};
template <typename Point>
Between place_among(std::span<const Point> points, double at) {
  const auto behind = std::upper_bound(points.begin(), points.end(), at,
                                       [](double x, const Point& point) { return x < double{point.at}; });
  const auto i = static_cast<std::size_t>(behind - points.begin());
  if (i == 0) return {0, 0, 0};
  if (i == points.size()) return {i - 1, i - 1, 0};
  const double low = double{points[i - 1].at}, high = double{points[i].at};
  return {i - 1, i, (at - low) / (high - low)};
}

template <typename Point, typename NumbersOf>
std::optional<PointFault> find_fault(std::span<const Point> points, NumbersOf numbers_of, const char* form) {
  if (points.size() < 2 || points.size() > kMostPoints)
    return PointFault{std::nullopt, std::string("expected 2 to ")
                                        .append(std::to_string(kMostPoints))
                                        .append(" points ")
                                        .append(form)
                                        .append(", found ")
                                        .append(std::to_string(points.size()))};
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const float number : numbers_of(points[i]))
      if (!(number >= 0 && number <= 1))
        return PointFault{
            i, std::string("expected numbers from 0 to 1, ") + form + ", found " + shown(double{number})};
    if (i > 0 && points[i].at < points[i - 1].at)
      return PointFault{i, "expected a position from " + shown(double{points[i - 1].at}) +
                               " on, that of the point before, found " + shown(double{points[i].at}) +
                               "; sort the points by position"};
  }
  return std::nullopt;
}

}  // namespace

double opacity_at(std::span<const OpacityPoint> curve, double at) {
  const Between place = place_among(curve, at);
  return glm::mix(double{curve[place.before].opacity}, double{curve[place.behind].opacity}, place.fraction);
}

double opacity_integral(std::span<const OpacityPoint> curve, double at) {
  double sum = std::min(at, double{curve[0].at}) * double{curve[0].opacity};
  for (std::size_t i = 0; i < curve.size() && double{curve[i].at} < at; ++i) {
    // To the next point, or to the position before it.
    const double end = i + 1 < curve.size() ? std::min(at, double{curve[i + 1].at}) : at;
    const double begin = double{curve[i].at}, first = double{curve[i].opacity};
    double last = first;
    if (end > begin && i + 1 < curve.size())
      last = glm::mix(first, double{curve[i + 1].opacity}, (end - begin) / (double{curve[i + 1].at} - begin));
    sum += (end - begin) * 0.5 * (first + last);
  }
  return sum;
}

std::span<const std::string_view> color_map_names() {
  return kNames;
}

glm::dvec3 color_at(const ColorMap& map, double at) {
  if (!map.name.empty()) return glm::clamp(named_color(map.name, at), 0.0, 1.0);
  const Between place = place_among(std::span(map.points), at);
  return glm::mix(glm::dvec3(map.points[place.before].color), glm::dvec3(map.points[place.behind].color),
                  place.fraction);
}

std::optional<PointFault> fault_of(std::span<const OpacityPoint> curve) {
  return find_fault(
      curve,
      [](const OpacityPoint& point) {
        return std::array{point.at, point.opacity};
      },
      "[position, opacity]");
}

std::optional<PointFault> fault_of(std::span<const ColorPoint> points) {
  return find_fault(
      points,
      [](const ColorPoint& point) {
        return std::array{point.at, point.color.r, point.color.g, point.color.b};
      },
      "[position, red, green, blue]");
}

std::optional<PointFault> fault_of(const ColorMap& map) {
  if (map.empty()) return std::nullopt;
  if (map.name.empty()) return fault_of(std::span(map.points));
  if (!map.points.empty()) return PointFault{std::nullopt, "expected a name or points, not both"};
  if (std::ranges::find(kNames, map.name) != kNames.end()) return std::nullopt;
  const std::vector<std::string> known(kNames.begin(), kNames.end());
  return PointFault{std::nullopt, "no colour map " + in_quotes(map.name) + suggestion(map.name, known, "\"")};
}

std::optional<std::string> fault_of_range(glm::vec2 range) {
  for (int end = 0; end < 2; ++end)
    if (!(std::abs(double{range[end]}) <= kFarthestValue))
      return "expected numbers from -1e30 to 1e30, found " + shown(double{range[end]});
  if (range.x < range.y) return std::nullopt;
  return "expected the lower value first, such as [0.0, 1.0], found [" + shown(double{range.x}) + ", " +
         shown(double{range.y}) + "]";
}

}  // namespace brume::scene
