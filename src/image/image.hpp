// Images in memory: the result of decoding and the input of encoding.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace brume::image {

/// Maximum number of texels per axis of an image file.
constexpr std::uint32_t kMaxAxis = 16384;

/// 8-bit RGBA, rows from the top, width * height * 4 bytes.
struct Image8 {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// A channel of numbers, rows from the top.
struct Layer {
  std::string name;  ///< As OpenEXR names channels: "R", "Z", "albedo.R".
  /// Half floats as their bits, or floats.
  std::variant<std::vector<std::uint16_t>, std::vector<float>> values;
};

/// Numbers instead of colours, width * height of them in each layer.
struct LayeredImage {
  std::uint32_t width = 0, height = 0;
  std::vector<Layer> layers;
};

/// A text that an image file holds. Keyword: 1 to 79 letters; both in ASCII.
struct ImageText {
  std::string keyword, text;
};

}  // namespace brume::image
