// The decoders behind decode_image, one per format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/error.hpp"
#include "image/image.hpp"

namespace brume::image {

Result<Image8> decode_png(std::span<const std::byte> bytes, const std::string& name);
Result<Image8> decode_jpeg(std::span<const std::byte> bytes, const std::string& name);
Result<Image8> decode_webp(std::span<const std::byte> bytes, const std::string& name);
Result<Image8> decode_tga(std::span<const std::byte> bytes, const std::string& name);
Result<Image8> decode_bmp(std::span<const std::byte> bytes, const std::string& name);

/// Fails for images without texels (bad_input) or with more than kMaxAxis per axis (resource_limit).
Result<void> check_size(std::uint64_t width, std::uint64_t height, const std::string& name);

}  // namespace brume::image
