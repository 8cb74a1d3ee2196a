// Writes PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "image/image.hpp"

namespace brume::image {

/// 16-bit RGBA, rows from the top, width * height * 4 values.
struct Image16 {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint16_t> rgba;
};

/// Writes an sRGB PNG: RGB when every texel is opaque, otherwise RGBA. The file appears under its name only
/// when it is complete. Fails with bad_input when the folder does not exist and with resource_limit when the
/// disk is full.
Result<void> save_png(const std::filesystem::path& path, const Image8& image);
Result<void> save_png(const std::filesystem::path& path, const Image16& image);

}  // namespace brume::image
