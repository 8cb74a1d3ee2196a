#include <spng.h>

#include <memory>

#include "core/checked.hpp"
#include "image/formats.hpp"

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

}  // namespace

Result<Image8> decode_png(std::span<const std::byte> bytes, const std::string& name) {
  const std::unique_ptr<spng_ctx, FreeContext> context(spng_ctx_new(0));
  if (!context) return Failure{ErrorCode::resource_limit, name + ": out of memory"};
  const auto failed = [&](int error) { return png_failure(name, spng_strerror(error)); };

  // Set the limits first: they apply while the header is read.
  spng_set_image_limits(context.get(), 0x7fffffff, 0x7fffffff);
  spng_set_chunk_limits(context.get(), kMaxChunkBytes, kMaxChunkBytes);
  if (const int error = spng_set_png_buffer(context.get(), bytes.data(), bytes.size())) return failed(error);

  // Check the size before allocating.
  spng_ihdr header{};
  if (const int error = spng_get_ihdr(context.get(), &header)) return failed(error);
  if (auto size = check_size(header.width, header.height, name); !size) return size.failure();
  const std::uint64_t least_bits = std::uint64_t{header.width} * header.height * header.bit_depth;
  if (least_bits / 8 / kMaxInflation > bytes.size()) {
    return png_failure(name, "it is too short for the size in its header");
  }

  // Decode.
  Image8 image{header.width, header.height, {}};
  image.rgba.resize(std::size_t{header.width} * header.height * 4);
  if (const int error = spng_decode_image(context.get(), image.rgba.data(), image.rgba.size(), SPNG_FMT_RGBA8,
                                          SPNG_DECODE_TRNS)) {
    return failed(error);
  }
  if (!has_end(bytes)) return png_failure(name, "its end is missing");
  return image;
}

}  // namespace brume::image
