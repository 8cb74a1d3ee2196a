// TGA and BMP by stb_image, which reads on as zeros, or as what memory held, where a file ends early: what a
// file must hold is checked before.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "image/formats.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace brume::image {
namespace {

// Little-endian numbers; 0 beyond the end.
struct Bytes {
  std::span<const std::byte> all;
  std::uint64_t at(std::uint64_t i, std::uint64_t count = 1) const {
    std::uint64_t value = 0;
    for (std::uint64_t b = 0; b < count && i + b < all.size(); ++b)
      value |= std::to_integer<std::uint64_t>(all[i + b]) << (8 * b);
    return value;
  }
};

// Where the run-length packets of a TGA end that make this many texels of so many bytes each.
std::uint64_t end_of_packets(const Bytes& bytes, std::uint64_t at, std::uint64_t texels, std::uint64_t size) {
  while (texels > 0 && at < bytes.all.size()) {
    const std::uint64_t head = bytes.at(at), count = std::min((head & 127) + 1, texels);
    at += 1 + size * (head >= 128 ? 1 : count);
    texels -= count;
  }
  return texels > 0 ? at + 1 : at;
}

// What a file must reach.
std::uint64_t length_of_tga(const Bytes& bytes) {
  const std::uint64_t palette = bytes.at(1) == 1 ? bytes.at(5, 2) * ((bytes.at(7) + 7) / 8) : 0;
  const std::uint64_t begin = 18 + bytes.at(0) + palette;
  const std::uint64_t texels = bytes.at(12, 2) * bytes.at(14, 2), size = (bytes.at(16) + 7) / 8;
  return bytes.at(2) >= 8 ? end_of_packets(bytes, begin, texels, size) : begin + texels * size;
}

std::uint64_t length_of_bmp(const Bytes& bytes) {
  if (bytes.at(14, 4) == 12)
    return bytes.at(10, 4) + (bytes.at(18, 2) * bytes.at(24, 2) + 31) / 32 * 4 * bytes.at(20, 2);
  const std::uint64_t signed_rows = bytes.at(22, 4);
  const std::uint64_t rows = signed_rows >> 31 != 0 ? (std::uint64_t{1} << 32) - signed_rows : signed_rows;
  return bytes.at(10, 4) + (bytes.at(18, 4) * bytes.at(28, 2) + 31) / 32 * 4 * rows;
}

void mirror(Image8& image) {
  const std::size_t width = image.width;
  for (std::size_t row = 0; row < image.height; ++row)
    for (std::size_t x = 0; x < width / 2; ++x) {
      std::uint8_t* const texels = image.rgba.data() + 4 * width * row;
      std::swap_ranges(texels + 4 * x, texels + 4 * x + 4, texels + 4 * (width - 1 - x));
    }
}

Result<Image8> decode(std::span<const std::byte> bytes, const std::string& name, std::uint64_t needed) {
  const auto failed = [&](const char* what) { return Failure{ErrorCode::bad_input, name + ": " + what}; };
  if (bytes.size() > std::size_t{1} << 31) return failed("larger than 2 GiB");
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0)
    return failed(stbi_failure_reason());
  // A BMP whose rows run down has a height below 0.
  height = std::abs(height);
  if (auto fault = check_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), name);
      !fault)
    return fault.failure();
  if (needed > bytes.size()) return failed("truncated");
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> texels(
      stbi_load_from_memory(data, size, &width, &height, &channels, STBI_rgb_alpha), &stbi_image_free);
  if (!texels) return failed(stbi_failure_reason());
  Image8 image{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  image.rgba.assign(texels.get(), texels.get() + std::size_t{4} * image.width * image.height);
  return image;
}

}  // namespace

Result<Image8> decode_tga(std::span<const std::byte> bytes, const std::string& name) {
  const Bytes header{bytes};
  if (header.at(1) == 1 && header.at(3, 2) != 0)
    return Failure{ErrorCode::bad_input, name + ": its colour map begins at entry " +
                                             std::to_string(header.at(3, 2)) + ", expected 0"};
  auto image = decode(bytes, name, length_of_tga(header));
  // Rows that run to the left, which stb_image takes for others.
  if (image && (header.at(17) & 0x10) != 0) mirror(*image);
  return image;
}

Result<Image8> decode_bmp(std::span<const std::byte> bytes, const std::string& name) {
  // Run-length forms are not among those that stb_image reads; it says so.
  return decode(bytes, name, length_of_bmp({bytes}));
}

}  // namespace brume::image
