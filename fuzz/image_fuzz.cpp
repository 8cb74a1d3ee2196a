// decode_image accepts any bytes without undefined behaviour, under a name that says TGA or not.
#include <cstdint>
#include <span>

#include "image/decode.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  for (const char* name : {"a.tga", "a"}) {
    const auto image = brume::image::decode_image(bytes, name);
    if (image && image->rgba.size() != std::size_t{4} * image->width * image->height) __builtin_trap();
  }
  return 0;
}
