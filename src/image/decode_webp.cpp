#include <webp/decode.h>

#include "image/formats.hpp"

namespace brume::image {
namespace {

// A picture of one colour takes a few dozen bytes at any size. From 4096 x 4096 texels on, a file must have a
// byte per 1024 of them, so that a small file cannot request gigabytes.
constexpr std::uint64_t kAlwaysAllowedTexels = std::uint64_t{1} << 24;
constexpr std::uint64_t kMostTexelsPerByte = 1024;

const char* reason_of(VP8StatusCode status) {
  switch (status) {
    case VP8_STATUS_OUT_OF_MEMORY:
      return "out of memory";
    case VP8_STATUS_NOT_ENOUGH_DATA:
      return "its end is missing";
    case VP8_STATUS_UNSUPPORTED_FEATURE:
      return "it uses an unknown feature";
    default:
      return "its contents are damaged";
  }
}

Failure webp_failure(const std::string& name, const char* reason) {
  return {ErrorCode::bad_input, name + ": not a complete, valid WebP file: " + reason + "; save it again"};
}

}  // namespace

Result<Image8> decode_webp(std::span<const std::byte> bytes, const std::string& name) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());

  // Check the size before allocating.
  WebPDecoderConfig config;
  if (!WebPInitDecoderConfig(&config)) return webp_failure(name, "libwebp has another version");
  const VP8StatusCode header = WebPGetFeatures(data, bytes.size(), &config.input);
  if (header != VP8_STATUS_OK) return webp_failure(name, reason_of(header));
  if (config.input.has_animation) {
    return Failure{ErrorCode::bad_input, name + ": is an animated WebP file; save one of its pictures"};
  }
  const auto width = static_cast<std::uint32_t>(config.input.width);
  const auto height = static_cast<std::uint32_t>(config.input.height);
  if (auto size = check_size(width, height, name); !size) return size.failure();
  const std::uint64_t texels = std::uint64_t{width} * height;
  if (texels > kAlwaysAllowedTexels && texels / kMostTexelsPerByte > bytes.size())
    return webp_failure(name, "it is too short for the size in its header");

  // Decode.
  Image8 image{width, height, {}};
  image.rgba.resize(texels * 4);
  config.output.colorspace = MODE_RGBA;
  config.output.is_external_memory = 1;
  config.output.u.RGBA = {image.rgba.data(), static_cast<int>(width * 4), image.rgba.size()};
  const VP8StatusCode status = WebPDecode(data, bytes.size(), &config);
  WebPFreeDecBuffer(&config.output);
  if (status != VP8_STATUS_OK) return webp_failure(name, reason_of(status));
  return image;
}

}  // namespace brume::image
