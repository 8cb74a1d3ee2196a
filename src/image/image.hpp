// Images in memory: the result of decoding and the input of encoding.
#pragma once

#include <cstdint>
#include <vector>

namespace brume::image {

/// Maximum number of texels per axis of an image file.
constexpr std::uint32_t kMaxAxis = 16384;

/// 8-bit RGBA, rows from the top, width * height * 4 bytes.
struct Image8 {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

}  // namespace brume::image
