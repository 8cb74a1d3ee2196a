// Writes PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "image/image.hpp"

namespace brume::image {

/// 16-bit RGBA, rows from the top, width * height * 4 values.
struct Image16 {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint16_t> rgba;
};

/// Numbers instead of colours, whole and without a colour space: rows from the top, channels interleaved.
struct NumberImage {
  std::uint32_t width = 0, height = 0;
  std::uint32_t channels = 1;         ///< 1, 3 or 4: grey, RGB, RGBA.
  std::uint32_t bits = 8;             ///< 8 or 16.
  std::vector<std::uint16_t> values;  ///< width * height * channels, each below 2^bits.
};

/// Writes an sRGB PNG: RGB when every texel is opaque, otherwise RGBA. The file appears under its name only
/// when it is complete. Fails with bad_input when the folder does not exist and with resource_limit when the
/// disk is full. With a `text` the file holds it too (a tEXt chunk).
Result<void> save_png(const std::filesystem::path& path, const Image8& image,
                      const std::optional<ImageText>& text = std::nullopt);
Result<void> save_png(const std::filesystem::path& path, const Image16& image);

/// Writes a PNG whose numbers read back as they are. Fails as save_png for colours.
Result<void> save_png(const std::filesystem::path& path, const NumberImage& image);

/// Decodes a PNG of 8 or 16 bits without converting anything. Fails as decode_image, and with bad_input for
/// other depths, palettes, and grey with alpha.
Result<NumberImage> decode_png_numbers(std::span<const std::byte> bytes, const std::string& name);

/// The text of the first tEXt chunk with this keyword. Does not check whether the file is complete.
std::optional<std::string> find_png_text(std::span<const std::byte> bytes, const std::string& keyword);

/// Whether all checksums of a PNG hold, and nothing follows its end.
bool is_intact_png(std::span<const std::byte> bytes);

}  // namespace brume::image
