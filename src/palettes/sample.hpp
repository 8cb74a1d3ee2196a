// Colours of palettes at any position.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "palettes/palette.hpp"

namespace brume::palettes {

/// In which space colours between two colours of a palette lie on a line.
enum class Space {
  oklab,    ///< Perceptual: steps look equally large (oklab.hpp).
  linear,   ///< Linear light, as lights mix.
  srgb,     ///< The numbers of the bytes, as most programs mix.
  nearest,  ///< No others than the palette's own; each has an equal part of [0, 1].
};

/// "oklab", "linear", "srgb", "nearest"; nothing for another name.
std::optional<Space> space_of(std::string_view name);

/// sRGB in [0, 1] at a position: 0 is the first colour, 1 the last, others are at equal distances, except for
/// `nearest`. Positions outside of [0, 1] are clamped to it, and colours that leave sRGB between two of
/// its colours in Oklab, channel by channel.
glm::dvec3 sample(const Palette& palette, double at, Space space = Space::oklab);
/// The same rounded to bytes.
glm::u8vec3 sample_byte(const Palette& palette, double at, Space space = Space::oklab);

/// `count` colours at equal distances from `low` to `high`, which they include; one is in the middle. Both in
/// [0, 1]; with low > high the palette is read backwards. A colour has red as the lowest byte, then green and
/// blue, the fourth is zero: as PackOptions::palette (spheres/pack.hpp) takes them. Empty for count = 0.
std::vector<std::uint32_t> sample_range(const Palette& palette, double low, double high, std::size_t count,
                                        Space space = Space::oklab);

}  // namespace brume::palettes
