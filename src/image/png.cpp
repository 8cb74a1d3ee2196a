#include "image/png.hpp"

#include <spng.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/checked.hpp"
#include "core/file.hpp"
#include "image/formats.hpp"

namespace brume::image {
namespace {

struct FreeContext {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
struct FreeBytes {
  void operator()(void* bytes) const { std::free(bytes); }
};

template <typename Value>
bool opaque(const std::vector<Value>& rgba) {
  for (std::size_t i = 3; i < rgba.size(); i += 4) {
    if (rgba[i] != static_cast<Value>(~Value{0})) return false;
  }
  return true;
}

template <typename Value>
std::vector<Value> without_alpha(const std::vector<Value>& rgba) {
  std::vector<Value> rgb;
  rgb.reserve(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size(); i += 4) rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  return rgb;
}

/// What a PNG is besides its values.
struct PngKind {
  std::uint32_t width = 0, height = 0;
  std::uint8_t bits = 8;
  spng_color_type color = SPNG_COLOR_TYPE_TRUECOLOR;
  bool is_srgb = true;
  std::optional<ImageText> text;
};

Result<void> encode(const std::filesystem::path& path, const PngKind& kind,
                    std::span<const std::byte> values) {
  if (auto size = check_size(kind.width, kind.height, path.string()); !size) return size;

  // Encode into memory.
  const std::unique_ptr<spng_ctx, FreeContext> context(spng_ctx_new(SPNG_CTX_ENCODER));
  const auto failed = [&](int error) {
    return Failure{ErrorCode::internal, path.string() + ": cannot encode the PNG: " + spng_strerror(error)};
  };
  if (!context) return failed(SPNG_EMEM);
  spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  // A seventh of the time of the defaults for a seventh more bytes: films write many.
  spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, 2);
  spng_set_option(context.get(), SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_SUB);
  spng_ihdr header{};
  header.width = kind.width;
  header.height = kind.height;
  header.bit_depth = kind.bits;
  header.color_type = static_cast<std::uint8_t>(kind.color);
  if (const int error = spng_set_ihdr(context.get(), &header)) return failed(error);
  if (kind.is_srgb)
    if (const int error = spng_set_srgb(context.get(), 0)) return failed(error);  // 0: perceptual intent
  std::string text_until_encoded;  // libspng keeps a pointer to it.
  if (kind.text) {
    text_until_encoded = kind.text->text;
    spng_text chunk{};
    kind.text->keyword.copy(chunk.keyword, sizeof chunk.keyword - 1);
    chunk.type = SPNG_TEXT;
    chunk.text = text_until_encoded.data();
    chunk.length = text_until_encoded.size();
    if (const int error = spng_set_text(context.get(), &chunk, 1)) return failed(error);
  }
  if (const int error =
          spng_encode_image(context.get(), values.data(), values.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE))
    return failed(error);

  // Write the file.
  std::size_t size = 0;
  int error = 0;
  const std::unique_ptr<void, FreeBytes> bytes(spng_get_png_buffer(context.get(), &size, &error));
  if (!bytes) return failed(error);
  return write_file_atomic(path, std::span(static_cast<const std::byte*>(bytes.get()), size));
}

template <typename Value>
Result<void> save_colors(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                         const std::vector<Value>& rgba, const std::optional<ImageText>& text) {
  BRUME_ASSERT(rgba.size() == std::size_t{width} * height * 4, path.string());
  const bool has_alpha = !opaque(rgba);
  const std::vector<Value> rgb = has_alpha ? std::vector<Value>() : without_alpha(rgba);
  const PngKind kind{width,
                     height,
                     sizeof(Value) * 8,
                     has_alpha ? SPNG_COLOR_TYPE_TRUECOLOR_ALPHA : SPNG_COLOR_TYPE_TRUECOLOR,
                     true,
                     text};
  return encode(path, kind, std::as_bytes(std::span(has_alpha ? rgba : rgb)));
}

// Decodes images.

// Deflate expands a byte to at most 1032: a shorter file cannot hold the texels it declares.
constexpr std::uint64_t kMaxInflation = 1032;
constexpr std::size_t kMaxChunkBytes = std::size_t{64} << 20;

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

Result<void> save_png(const std::filesystem::path& path, const Image8& image,
                      const std::optional<ImageText>& text) {
  return save_colors(path, image.width, image.height, image.rgba, text);
}

Result<void> save_png(const std::filesystem::path& path, const Image16& image) {
  return save_colors(path, image.width, image.height, image.rgba, std::nullopt);
}

Result<void> save_png(const std::filesystem::path& path, const NumberImage& image) {
  BRUME_ASSERT(image.values.size() == std::size_t{image.width} * image.height * image.channels,
               path.string());
  const spng_color_type color = image.channels == 1   ? SPNG_COLOR_TYPE_GRAYSCALE
                                : image.channels == 3 ? SPNG_COLOR_TYPE_TRUECOLOR
                                                      : SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
  const PngKind kind{image.width, image.height, static_cast<std::uint8_t>(image.bits), color, false, {}};
  if (image.bits == 16) return encode(path, kind, std::as_bytes(std::span(image.values)));
  std::vector<std::uint8_t> narrow(image.values.size());
  std::ranges::transform(image.values, narrow.begin(),
                         [](std::uint16_t value) { return static_cast<std::uint8_t>(value); });
  return encode(path, kind, std::as_bytes(std::span(narrow)));
}

// A chunk is its length, a type of four letters, the data and a four-byte checksum. The data of a tEXt chunk
// is the keyword, a zero byte and the text.
std::optional<std::string> find_png_text(std::span<const std::byte> bytes, const std::string& keyword) {
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string wanted = keyword + '\0';
  for (std::size_t at = 8; at + 12 <= all.size();) {
    std::uint64_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | std::to_integer<std::uint64_t>(bytes[at + i]);
    if (length > all.size() - at - 12) return std::nullopt;
    const std::string_view data = all.substr(at + 8, length);
    if (all.substr(at + 4, 4) == "tEXt" && data.substr(0, wanted.size()) == wanted)
      return std::string(data.substr(wanted.size()));
    at += 12 + length;
  }
  return std::nullopt;
}

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
