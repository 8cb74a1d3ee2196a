// Transfer functions: how the values of a volume become opacity and colour. Positions are relative to a range
// of values: 0 is its low end, 1 its high end.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace brume::scene {

/// A corner of an opacity curve.
struct OpacityPoint {
  float at = 0;       ///< Position, [0, 1].
  float opacity = 0;  ///< Factor of the extinction, [0, 1].
  bool operator==(const OpacityPoint&) const = default;
};

/// A corner of a colour map.
struct ColorPoint {
  float at = 0;        ///< Position, [0, 1].
  glm::vec3 color{0};  ///< Linear, [0, 1].
  bool operator==(const ColorPoint&) const = default;
};

/// A colour map: one of color_map_names(), or points; neither: none.
struct ColorMap {
  std::string name = {};
  std::vector<ColorPoint> points = {};
  bool empty() const { return name.empty() && points.empty(); }
  bool operator==(const ColorMap&) const = default;
};

/// The most points of a curve; the least are two.
constexpr std::size_t kMostPoints = 64;
/// Largest absolute value of a range.
constexpr double kFarthestValue = 1e30;

/// The curve at a position in [0, 1]: linear between its points, which are valid, and constant before the
/// first and behind the last. Two points at one position are a step.
double opacity_at(std::span<const OpacityPoint> curve, double at);
/// Its integral from 0 to a position in [0, 1].
double opacity_integral(std::span<const OpacityPoint> curve, double at);

/// "cool-warm", "cubehelix", "grey", "inferno", "magma", "plasma", "viridis".
std::span<const std::string_view> color_map_names();

/// The linear colour of a map at a position in [0, 1], each component in [0, 1]; of a valid map that is not
/// empty. Between points colours are linear.
///
/// - cool-warm: Moreland 2009, "Diverging Color Maps for Scientific Visualization", in his Msh space;
/// - cubehelix: Green 2011, "A colour scheme for the display of astronomical intensity images";
/// - viridis, inferno, magma, plasma: shaders/shared/ramp.h;
/// - grey: from black to white in equal steps of sRGB.
glm::dvec3 color_at(const ColorMap& map, double at);

/// The first fault of a list of points.
struct PointFault {
  std::optional<std::size_t> point;  ///< Empty: of the list.
  std::string what;                  ///< What was expected, and what to do.
};
/// nullopt: the points are valid. Two to kMostPoints, all numbers in [0, 1], positions that do not fall.
std::optional<PointFault> fault_of(std::span<const OpacityPoint> curve);
std::optional<PointFault> fault_of(std::span<const ColorPoint> points);
/// What is wrong with a name or the points of a map; an empty map is valid.
std::optional<PointFault> fault_of(const ColorMap& map);
/// The same for a range of values.
std::optional<std::string> fault_of_range(glm::vec2 range);

}  // namespace brume::scene
