// Decodes image files: PNG, JPEG, WebP, TGA and BMP, distinguished by what they hold.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "core/error.hpp"
#include "image/image.hpp"

namespace brume::image {

/// Decodes a PNG (any colour type and depth, 16 bits are rounded down to 8), a JPEG (grey or colour) or a
/// WebP (lossy or lossless, not animated), a TGA or a BMP (without run lengths) to 8-bit RGBA. A TGA without
/// the footer of its second version must be named one. Sizes are checked before anything is allocated: at
/// most kMaxAxis texels per axis. `name` names the bytes in error messages. Fails with bad_input when they
/// are none of these, damaged or truncated, and with resource_limit when the picture is too large.
Result<Image8> decode_image(std::span<const std::byte> bytes, const std::string& name);

/// Reads and decodes a file.
Result<Image8> load_image(const std::filesystem::path& path);

}  // namespace brume::image
