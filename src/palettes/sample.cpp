#include "palettes/sample.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "palettes/oklab.hpp"

namespace brume::palettes {
namespace {

glm::dvec3 mixed(const glm::dvec3& a, const glm::dvec3& b, double t, Space space) {
  if (space == Space::srgb) return glm::mix(a, b, t);
  const glm::dvec3 x = linear_from_srgb(a), y = linear_from_srgb(b);
  const glm::dvec3 linear = space == Space::linear
                                ? glm::mix(x, y, t)
                                : linear_from_oklab(glm::mix(oklab_from_linear(x), oklab_from_linear(y), t));
  return srgb_from_linear(glm::clamp(linear, 0.0, 1.0));
}

}  // namespace

std::optional<Space> space_of(std::string_view name) {
  if (name == "oklab") return Space::oklab;
  if (name == "linear") return Space::linear;
  if (name == "srgb") return Space::srgb;
  if (name == "nearest") return Space::nearest;
  return std::nullopt;
}

glm::dvec3 sample(const Palette& palette, double at, Space space) {
  BRUME_ASSERT(!palette.colors.empty() && std::isfinite(at), palette.name + " at " + std::to_string(at));
  const std::size_t count = palette.colors.size();
  const auto color = [&](std::size_t i) { return glm::dvec3(palette.colors[i]) / 255.0; };
  const double t = std::clamp(at, 0.0, 1.0);
  if (space == Space::nearest)
    return color(std::min(static_cast<std::size_t>(t * static_cast<double>(count)), count - 1));
  const double x = t * static_cast<double>(count - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), count - 1);
  const double between = x - static_cast<double>(i);
  // Exactly the palette's own colours, without a round trip.
  if (between <= 0 || i + 1 == count) return color(i);
  return mixed(color(i), color(i + 1), between, space);
}

glm::u8vec3 sample_byte(const Palette& palette, double at, Space space) {
  return glm::u8vec3(glm::round(255.0 * sample(palette, at, space)));
}

std::vector<std::uint32_t> sample_range(const Palette& palette, double low, double high, std::size_t count,
                                        Space space) {
  std::vector<std::uint32_t> colors(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double part = count == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(count - 1);
    const glm::u8vec3 c = sample_byte(palette, low + (high - low) * part, space);
    colors[i] = std::uint32_t{c.x} | std::uint32_t{c.y} << 8 | std::uint32_t{c.z} << 16;
  }
  return colors;
}

}  // namespace brume::palettes
