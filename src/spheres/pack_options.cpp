#include "spheres/pack_options.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>

namespace brume::spheres {
namespace {

std::string to_text(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", number);
  return text;
}

std::string check_size(const glm::uvec3& size) {
  const std::string found = "size: " + std::to_string(size.x) + "x" + std::to_string(size.y) + "x" +
                            std::to_string(size.z) + " voxels; expected ";
  for (int axis = 0; axis < 3; ++axis)
    if (size[axis] < 1 || size[axis] > kMostVoxelsPerAxis)
      return found + "1 to " + std::to_string(kMostVoxelsPerAxis) + " along each axis";
  if (std::uint64_t{size.x} * size.y * size.z > kMostVoxels)
    return found + "at most " + std::to_string(kMostVoxels) + " in all";
  return "";
}

std::string check_radius(const PackOptions& options) {
  const float most = static_cast<float>(std::min({options.size.x, options.size.y, options.size.z})) / 2;
  const glm::vec2 radius = options.radius;
  if (radius.x > 0 && radius.x <= radius.y && radius.y <= most) return "";
  return "radius: from " + to_text(radius.x) + " to " + to_text(radius.y) +
         " voxels; expected 0 < least <= largest <= " + to_text(most) +
         ", which is half of the tank's shortest side";
}

/// What is out of range, or nothing.
std::string fault_of(const PackOptions& options) {
  const auto number = [](const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return std::string();
    return name + (": " + to_text(value)) + "; expected " + to_text(low) + " to " + to_text(high);
  };
  const std::string checks[] = {
      check_size(options.size),
      options.voxel > 0 && options.voxel <= std::numeric_limits<float>::max()
          ? ""
          : "voxel: " + to_text(double{options.voxel}) + "; expected a finite edge above 0",
      options.count <= kMostSpheres ? ""
                                    : "count: " + std::to_string(options.count) + " spheres; expected 0 to " +
                                          std::to_string(kMostSpheres),
      check_radius(options),
      number("distribution", double{options.distribution}, 0, 8),
      options.arrangement <= Arrangement::coral ? "" : "arrangement: unknown",
      number("noise_size", double{options.noise_size}, 1, 65536),
      number("opacity", double{options.opacity}, 0, 1)};
  for (const std::string& check : checks)
    if (!check.empty()) return check;
  return "";
}

/// The mean of the cubes of radii of the power law.
double mean_cube(const PackOptions& options) {
  const double low = double{options.radius.x}, high = double{options.radius.y};
  if (low == high) return low * low * low;
  // The integral of radius^(exponent - distribution).
  const auto moment = [&](double exponent) {
    const double power = exponent - double{options.distribution} + 1;
    return std::abs(power) < 1e-6 ? std::log(high / low)
                                  : (std::pow(high, power) - std::pow(low, power)) / power;
  };
  return moment(3) / moment(0);
}

}  // namespace

glm::vec2 default_radius(const glm::uvec3& size) {
  const float most = static_cast<float>(std::min({size.x, size.y, size.z})) / 2;
  const glm::vec2 radius = PackOptions().radius;
  return {std::min(radius.x, most / 2), std::min(radius.y, most)};
}

std::uint32_t default_count(const PackOptions& options) {
  // Less than the 0.38 that equal spheres fill which are thrown at random until none finds room.
  constexpr double kFill = 1.0 / 3;
  const glm::dvec3 size(options.size);
  const double volume = 4.0 / 3 * std::numbers::pi * mean_cube(options);
  const double fitting = kFill * size.x * size.y * size.z / volume;
  return static_cast<std::uint32_t>(std::clamp(fitting, 1.0, static_cast<double>(PackOptions().count)));
}

Result<void> check_options(const PackOptions& options) {
  if (const std::string fault = fault_of(options); !fault.empty()) return Failure{ErrorCode::usage, fault};
  return {};
}

}  // namespace brume::spheres
