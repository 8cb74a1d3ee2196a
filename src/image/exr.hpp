// Writes and reads OpenEXR files: images of named layers of half floats or floats.
//
// Files are untrusted: sizes are checked before anything is allocated for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "image/image.hpp"

namespace brume::image {

/// Writes the layers as channels of these names and precisions, ZIP compressed, with a checksum of all values
/// and, if given, a `text` (attributes). The names must be distinct. The file appears under its name only
/// when it is complete. Fails as save_png does.
Result<void> save_exr(const std::filesystem::path& path, const LayeredImage& image,
                      const std::optional<ImageText>& text = std::nullopt);

/// Reads an image of one part. Layers are sorted by name, as in the file. Fails with bad_input for bytes that
/// are no OpenEXR file, damaged or truncated, for more than kMaxAxis texels per axis, for deep, subsampled or
/// integer channels, and for values that do not match the checksum of save_exr.
Result<LayeredImage> decode_exr(std::span<const std::byte> bytes, const std::string& name);

/// The length of a file up to the end of its image: bytes may follow. Reads all values, and fails as
/// decode_exr does; the message of a file that ends early contains "truncated".
Result<std::uint64_t> exr_length(std::span<const std::byte> bytes, const std::string& name);

/// What the header of a part of a file says.
struct ExrPart {
  std::string name;  ///< Empty in most files of one part.
  std::uint32_t width = 0, height = 0;
  struct Channel {
    std::string name, type;  ///< "half", "float" or "uint".
  };
  std::vector<Channel> channels;  ///< Sorted by name.
  std::vector<ImageText> texts;   ///< Its attributes that are texts.
};

/// The parts of a file, of any kind; does not read its values. Fails as decode_exr does for its headers.
Result<std::vector<ExrPart>> decode_exr_parts(std::span<const std::byte> bytes, const std::string& name);

}  // namespace brume::image
