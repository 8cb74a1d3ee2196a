#include <spng.h>
#include <zlib.h>

#include <memory>
#include <vector>

#include "core/checked.hpp"
#include "image/formats.hpp"
#include "image/png.hpp"

namespace brume::image {
namespace {

// Deflate expands a byte to at most 1032: a shorter file cannot hold the texels it declares.
constexpr std::uint64_t kMaxInflation = 1032;
constexpr std::size_t kMaxChunkBytes = std::size_t{64} << 20;

struct FreeContext {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};

Failure png_failure(const std::string& name, const char* reason) {
  return {ErrorCode::bad_input, name + ": not a complete, valid PNG file: " + reason + "; save it again"};
}

std::uint64_t big_endian(std::span<const std::byte> bytes) {
  std::uint64_t value = 0;
  for (const std::byte byte : bytes) value = value << 8 | std::to_integer<std::uint64_t>(byte);
  return value;
}

// Whether the file extends to its end marker, which libspng does not check. A chunk is its length, a type of
// four letters, the data and a four-byte checksum.
bool has_end(std::span<const std::byte> bytes) {
  constexpr std::uint64_t kIend = 0x49454e44;
  std::uint64_t at = 8;
  while (at + 12 <= bytes.size()) {
    if (big_endian(bytes.subspan(at + 4, 4)) == kIend) return true;
    at += 12 + big_endian(bytes.subspan(at, 4));
  }
  return false;
}

/// A decoder with its limits set, and the header that it has checked.
struct OpenPng {
  std::unique_ptr<spng_ctx, FreeContext> context;
  spng_ihdr header{};
};

Result<OpenPng> open_png(std::span<const std::byte> bytes, const std::string& name) {
  OpenPng png{std::unique_ptr<spng_ctx, FreeContext>(spng_ctx_new(0))};
  spng_ctx* const context = png.context.get();
  if (!context) return Failure{ErrorCode::resource_limit, name + ": out of memory"};
  const auto failed = [&](int error) { return png_failure(name, spng_strerror(error)); };

  // Set the limits first: they apply while the header is read.
  spng_set_image_limits(context, 0x7fffffff, 0x7fffffff);
  spng_set_chunk_limits(context, kMaxChunkBytes, kMaxChunkBytes);
  if (const int error = spng_set_png_buffer(context, bytes.data(), bytes.size())) return failed(error);

  // Check the size before anything is allocated for it.
  if (const int error = spng_get_ihdr(context, &png.header)) return failed(error);
  if (auto size = check_size(png.header.width, png.header.height, name); !size) return size.failure();
  const std::uint64_t least_bits = std::uint64_t{png.header.width} * png.header.height * png.header.bit_depth;
  if (least_bits / 8 / kMaxInflation > bytes.size())
    return png_failure(name, "it is too short for the size in its header");
  return png;
}

/// Channels of a PNG of numbers; 0: of another kind.
std::uint32_t channels_of(const spng_ihdr& header) {
  if (header.bit_depth != 8 && header.bit_depth != 16) return 0;
  switch (header.color_type) {
    case SPNG_COLOR_TYPE_GRAYSCALE:
      return 1;
    case SPNG_COLOR_TYPE_TRUECOLOR:
      return 3;
    case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

bool is_intact_png(std::span<const std::byte> bytes) {
  constexpr std::uint64_t kIend = 0x49454e44;
  // Chunks: length, type, data, checksum of type and data.
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::uint64_t length = big_endian(bytes.subspan(at, 4));
    if (length > bytes.size() - at - 12) return false;
    const auto checked = bytes.subspan(at + 4, 4 + length);
    const uLong sum = crc32_z(0, reinterpret_cast<const Bytef*>(checked.data()), checked.size());
    at += 12 + length;
    if (sum != big_endian(bytes.subspan(at - 4, 4))) return false;
    if (big_endian(checked.first(4)) == kIend) return at == bytes.size();
  }
  return false;
}

Result<Image8> decode_png(std::span<const std::byte> bytes, const std::string& name) {
  const auto png = open_png(bytes, name);
  if (!png) return png.failure();
  Image8 image{png->header.width, png->header.height, {}};
  image.rgba.resize(std::size_t{image.width} * image.height * 4);
  if (const int error = spng_decode_image(png->context.get(), image.rgba.data(), image.rgba.size(),
                                          SPNG_FMT_RGBA8, SPNG_DECODE_TRNS))
    return png_failure(name, spng_strerror(error));
  if (!has_end(bytes)) return png_failure(name, "its end is missing");
  return image;
}

Result<NumberImage> decode_png_numbers(std::span<const std::byte> bytes, const std::string& name) {
  const auto png = open_png(bytes, name);
  if (!png) return png.failure();
  const std::uint32_t channels = channels_of(png->header);
  if (channels == 0)
    return Failure{ErrorCode::bad_input,
                   name + ": expected a PNG of 8 or 16 bits, grey, RGB or RGBA, without a palette"};
  NumberImage image{png->header.width, png->header.height, channels, png->header.bit_depth, {}};
  image.values.resize(std::size_t{image.width} * image.height * channels);
  std::vector<std::uint8_t> narrow(image.bits == 8 ? image.values.size() : 0);
  void* const to = image.bits == 8 ? static_cast<void*>(narrow.data()) : image.values.data();
  const std::size_t length = image.values.size() * image.bits / 8;
  if (const int error = spng_decode_image(png->context.get(), to, length, SPNG_FMT_PNG, 0))
    return png_failure(name, spng_strerror(error));
  if (!has_end(bytes)) return png_failure(name, "its end is missing");
  if (image.bits == 8) image.values.assign(narrow.begin(), narrow.end());
  return image;
}

}  // namespace brume::image
