#include "image/decode.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/file.hpp"
#include "image/formats.hpp"

namespace brume::image {
namespace {

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<std::uint8_t, 3> kJpegSignature{0xff, 0xd8, 0xff};
constexpr std::array<std::uint8_t, 4> kRiffSignature{'R', 'I', 'F', 'F'}, kWebpForm{'W', 'E', 'B', 'P'};

constexpr std::array<std::uint8_t, 2> kBmpSignature{'B', 'M'};
constexpr std::string_view kTgaFooter{"TRUEVISION-XFILE.\0", 18};

// Files of the first version have no mark of their own: their name must say what they are.
bool is_tga(std::span<const std::byte> bytes, std::string name) {
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".tga") || name.ends_with(".tga\"")) return true;
  return bytes.size() >= kTgaFooter.size() && std::memcmp(bytes.data() + bytes.size() - kTgaFooter.size(),
                                                          kTgaFooter.data(), kTgaFooter.size()) == 0;
}

template <std::size_t N>
bool starts_with(std::span<const std::byte> bytes, const std::array<std::uint8_t, N>& signature) {
  return bytes.size() >= N && std::equal(signature.begin(), signature.end(), bytes.begin(),
                                         [](std::uint8_t a, std::byte b) { return std::byte{a} == b; });
}

}  // namespace

Result<void> check_size(std::uint64_t width, std::uint64_t height, const std::string& name) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  if (width == 0 || height == 0) {
    return Failure{ErrorCode::bad_input, name + ": the picture is " + size + ", it has no texels"};
  }
  if (width > kMaxAxis || height > kMaxAxis) {
    return Failure{ErrorCode::resource_limit, name + ": the picture is " + size + ", at most " +
                                                  std::to_string(kMaxAxis) +
                                                  " texels per axis are accepted; scale it down"};
  }
  return {};
}

Result<Image8> decode_image(std::span<const std::byte> bytes, const std::string& name) {
  if (starts_with(bytes, kPngSignature)) return decode_png(bytes, name);
  if (starts_with(bytes, kJpegSignature)) return decode_jpeg(bytes, name);
  // RIFF, the size of the rest, then the kind of the container.
  if (starts_with(bytes, kRiffSignature) &&
      starts_with(bytes.subspan(std::min<std::size_t>(bytes.size(), 8)), kWebpForm))
    return decode_webp(bytes, name);
  // No TGA begins so, whatever its name: its second byte is 0 or 1.
  if (starts_with(bytes, kBmpSignature)) return decode_bmp(bytes, name);
  if (is_tga(bytes, name)) return decode_tga(bytes, name);
  return Failure{ErrorCode::bad_input,
                 name + ": none of PNG, JPEG, WebP, TGA and BMP; convert it to one of these"};
}

Result<Image8> load_image(const std::filesystem::path& path) {
  auto bytes = read_file(path);
  if (!bytes) return bytes.failure();
  return decode_image(*bytes, path.string());
}

}  // namespace brume::image
