#include "scenario/ticks.hpp"

#include <algorithm>
#include <cmath>

namespace brume::scenario {

std::uint32_t tick_at(double seconds, std::uint32_t ticks_per_second) {
  // A time meant as an exact tick may lie below it by a rounding error.
  return static_cast<std::uint32_t>(std::floor(std::max(0.0, seconds) * ticks_per_second + 1e-9));
}

}  // namespace brume::scenario
