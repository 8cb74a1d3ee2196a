#include "image/png.hpp"

#include <spng.h>

#include <cstdlib>
#include <memory>
#include <span>

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

template <typename Value>
Result<void> save(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                  const std::vector<Value>& rgba) {
  BRUME_ASSERT(rgba.size() == std::size_t{width} * height * 4, path.string());
  if (auto size = check_size(width, height, path.string()); !size) return size;
  const bool has_alpha = !opaque(rgba);
  const std::vector<Value> rgb = has_alpha ? std::vector<Value>() : without_alpha(rgba);
  const std::vector<Value>& values = has_alpha ? rgba : rgb;

  // Encode into memory.
  const std::unique_ptr<spng_ctx, FreeContext> context(spng_ctx_new(SPNG_CTX_ENCODER));
  const auto failed = [&](int error) {
    return Failure{ErrorCode::internal, path.string() + ": cannot encode the PNG: " + spng_strerror(error)};
  };
  if (!context) return failed(SPNG_EMEM);
  spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_ihdr header{};
  header.width = width;
  header.height = height;
  header.bit_depth = sizeof(Value) * 8;
  header.color_type = has_alpha ? SPNG_COLOR_TYPE_TRUECOLOR_ALPHA : SPNG_COLOR_TYPE_TRUECOLOR;
  if (const int error = spng_set_ihdr(context.get(), &header)) return failed(error);
  if (const int error = spng_set_srgb(context.get(), 0)) return failed(error);  // 0: perceptual intent
  if (const int error = spng_encode_image(context.get(), values.data(), values.size() * sizeof(Value),
                                          SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE)) {
    return failed(error);
  }

  // Write the file.
  std::size_t size = 0;
  int error = 0;
  const std::unique_ptr<void, FreeBytes> bytes(spng_get_png_buffer(context.get(), &size, &error));
  if (!bytes) return failed(error);
  return write_file_atomic(path, std::span(static_cast<const std::byte*>(bytes.get()), size));
}

}  // namespace

Result<void> save_png(const std::filesystem::path& path, const Image8& image) {
  return save(path, image.width, image.height, image.rgba);
}

Result<void> save_png(const std::filesystem::path& path, const Image16& image) {
  return save(path, image.width, image.height, image.rgba);
}

}  // namespace brume::image
