// What images show beyond their edges.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>

namespace brume::scene {

enum class Wrap : std::uint8_t { repeat, mirror, clamp };

/// How an image continues along u and v.
struct Wraps {
  Wrap u = Wrap::repeat, v = Wrap::repeat;
  auto operator<=>(const Wraps&) const = default;
};

/// The texel, [0, size), that stands for any texel of an axis; size > 0.
inline std::uint32_t wrapped_texel(std::int64_t texel, std::uint32_t size, Wrap wrap) {
  const std::int64_t count = size, period = wrap == Wrap::mirror ? 2 * count : count;
  if (wrap == Wrap::clamp) return static_cast<std::uint32_t>(std::clamp<std::int64_t>(texel, 0, count - 1));
  const std::int64_t within = (texel % period + period) % period;
  return static_cast<std::uint32_t>(within < count ? within : period - 1 - within);
}

/// A coordinate in [-1, 2] that shows the same, in images; integers of any size can follow from it.
template <typename Real>
Real wrapped_coordinate(Real at, Wrap wrap) {
  if (wrap == Wrap::clamp) return std::clamp(at, Real(-1), Real(2));
  return wrap == Wrap::mirror ? at - 2 * std::floor(at / 2) : at - std::floor(at);
}

}  // namespace brume::scene
