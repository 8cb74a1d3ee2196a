// What moves while the shutter is open.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <span>

namespace brume::surfaces {

/// The most steps of a shutter's time.
constexpr std::size_t kMostSteps = 9;

/// The value at a time of values at equal steps of the shutter's time, from 0 to 1. At least one. `mix`: as
/// glm::mix.
template <typename Value, typename Mix>
Value at_time(std::span<const Value> steps, float time, Mix mix) {
  if (steps.size() == 1) return steps.front();
  const float scaled = time * static_cast<float>(steps.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(scaled), steps.size() - 2);
  return mix(steps[i], steps[i + 1], scaled - static_cast<float>(i));
}
/// Linear in between.
template <typename Value>
Value at_time(std::span<const Value> steps, float time) {
  return at_time(steps, time, [](const Value& a, const Value& b, float f) { return (1 - f) * a + f * b; });
}

}  // namespace brume::surfaces
