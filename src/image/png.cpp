#include "image/png.hpp"

#include <spng.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <span>
#include <string_view>

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

}  // namespace brume::image
