// Conversions of colours.
#pragma once

#include <cmath>

namespace brume::scene {

/// A channel of an sRGB colour as a linear one, both in [0, 1] (IEC 61966-2-1).
inline double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace brume::scene
