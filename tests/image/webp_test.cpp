#include <gtest/gtest.h>
#include <webp/encode.h>

#include <cstdlib>
#include <vector>

#include "image/decode.hpp"
#include "tests/image/image_test_tools.hpp"

namespace brume::image {
namespace {

std::vector<std::byte> taken(std::uint8_t* data, std::size_t size) {
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  std::vector<std::byte> file(bytes, bytes + size);
  WebPFree(data);
  return file;
}

std::vector<std::byte> lossless(const Image8& image) {
  std::uint8_t* data = nullptr;
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  const std::size_t size = WebPEncodeLosslessRGBA(image.rgba.data(), width, height, 4 * width, &data);
  return taken(data, size);
}

TEST(Webp, LosslessKeepsEveryTexel) {
  const Image8 image = random_image(37, 21, true, 1);
  const auto decoded = decode_image(lossless(image), "a.webp").value_or_throw();
  EXPECT_EQ(decoded.width, 37u);
  EXPECT_EQ(decoded.height, 21u);
  EXPECT_EQ(decoded.rgba, image.rgba);
}

TEST(Webp, LossyIsClose) {
  Image8 image{64, 48, {}};
  for (unsigned y = 0; y < 48; ++y) {
    for (unsigned x = 0; x < 64; ++x)
      for (const unsigned value : {40 + 2 * x, 60 + 2 * y, 100u, 255u})
        image.rgba.push_back(static_cast<std::uint8_t>(value));
  }
  std::uint8_t* data = nullptr;
  const std::size_t size = WebPEncodeRGBA(image.rgba.data(), 64, 48, 256, 90, &data);
  const auto decoded = decode_image(taken(data, size), "a.webp").value_or_throw();
  ASSERT_EQ(decoded.rgba.size(), image.rgba.size());
  for (std::size_t i = 0; i < image.rgba.size(); ++i) EXPECT_NEAR(decoded.rgba[i], image.rgba[i], 12);
}

TEST(Webp, RejectsEveryTruncationAndSurvivesDamage) {
  const std::vector<std::byte> file = lossless(random_image(9, 7, false, 2));
  for (std::size_t size = 0; size < file.size() - 1; ++size)
    EXPECT_FALSE(decode_image(std::span(file).first(size), "a.webp")) << size;
  for (std::size_t i = 12; i < file.size(); ++i) {
    std::vector<std::byte> damaged = file;
    damaged[i] ^= std::byte{0x24};
    if (const auto decoded = decode_image(damaged, "a.webp")) {
      EXPECT_EQ(decoded->rgba.size(), std::size_t{decoded->width} * decoded->height * 4);
    }
  }
}

// A header of 16383 x 16383 texels in a few bytes: refused before a gigabyte is allocated.
TEST(Webp, RejectsSizesThatTheFileCannotHold) {
  std::vector<std::byte> file = lossless({1, 1, {1, 2, 3, 255}});
  ASSERT_EQ(std::to_integer<int>(file[20]), 0x2f) << "the signature of the lossless format";
  for (const std::size_t i : {21, 22, 23}) file[i] = std::byte{0xff};
  file[24] = std::byte{0x0f};
  const auto decoded = decode_image(file, "a.webp");
  ASSERT_FALSE(decoded);
  EXPECT_NE(decoded.failure().message.find("too short for the size in its header"), std::string::npos)
      << decoded.failure().message;
}

TEST(Webp, NamesAnimations) {
  // An extended header with the flag of animations, and nothing else.
  const unsigned char header[] = {'R', 'I', 'F', 'F', 22, 0, 0, 0, 'W', 'E', 'B', 'P', 'V', 'P', '8',
                                  'X', 10,  0,   0,   0,  2, 0, 0, 0,   0,   0,   0,   0,   0,   0};
  const auto decoded = decode_image(std::as_bytes(std::span(header)), "a.webp");
  ASSERT_FALSE(decoded);
  EXPECT_NE(decoded.failure().message.find("animated"), std::string::npos) << decoded.failure().message;
}

}  // namespace
}  // namespace brume::image
