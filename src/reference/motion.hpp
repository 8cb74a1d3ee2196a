// What moves while the shutter is open.
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace brume::reference {

/// The most steps of a shutter's time.
constexpr std::size_t kMostSteps = 9;

/// Values at equal steps of the shutter's time, from 0 to 1: that at a time, linear in between. At least one.
template <typename Value>
Value at_time(std::span<const Value> steps, float time) {
  if (steps.size() == 1) return steps.front();
  const float scaled = time * static_cast<float>(steps.size() - 1);
  const auto i = glm::min(static_cast<std::size_t>(scaled), steps.size() - 2);
  const float f = scaled - static_cast<float>(i);
  return (1 - f) * steps[i] + f * steps[i + 1];
}

}  // namespace brume::reference
