#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
// jpeglib.h needs size_t and FILE declared before it.
#include <jpeglib.h>

#include <vector>

#include "image/decode.hpp"
#include "tests/image/image_test_tools.hpp"

namespace brume::image {
namespace {

struct JpegKind {
  J_COLOR_SPACE space = JCS_RGB;
  int channels = 3;
  bool progressive = false;
};

std::vector<std::byte> encode(std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> texels,
                              const JpegKind& kind) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &data, &size);
  jpeg.image_width = width;
  jpeg.image_height = height;
  jpeg.input_components = kind.channels;
  jpeg.in_color_space = kind.space;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  if (kind.progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  while (jpeg.next_scanline < height) {
    JSAMPROW row = &texels[std::size_t{jpeg.next_scanline} * width * static_cast<unsigned>(kind.channels)];
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  std::vector<std::byte> file(bytes, bytes + size);
  std::free(data);
  return file;
}

std::vector<std::uint8_t> ramp(std::uint32_t width, std::uint32_t height, int channels) {
  std::vector<std::uint8_t> texels;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        texels.push_back(static_cast<std::uint8_t>(40 + 3 * x + 2 * y + static_cast<unsigned>(c)));
  return texels;
}

TEST(Jpeg, DecodesASmoothPictureClosely) {
  for (const bool progressive : {false, true}) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {7u, 5u}, {33u, 17u}}) {
      const auto texels = ramp(width, height, 3);
      const auto image = decode_image(encode(width, height, texels, {JCS_RGB, 3, progressive}), "a.jpg");
      ASSERT_TRUE(image) << image.failure().message;
      ASSERT_EQ(image->width, width);
      ASSERT_EQ(image->height, height);
      for (std::size_t i = 0; i < texels.size() / 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          // Quality 95 has quantizer steps up to 10 for the highest of 64 frequencies, most near 2.
          ASSERT_NEAR(image->rgba[i * 4 + c], texels[i * 3 + c], 8) << width << " " << i;
        }
        ASSERT_EQ(image->rgba[i * 4 + 3], 255);
      }
    }
  }
}

TEST(Jpeg, ExpandsGreyToAllChannels) {
  const auto image = decode_image(encode(7, 5, ramp(7, 5, 1), {JCS_GRAYSCALE, 1}), "grey.jpg");
  ASSERT_TRUE(image) << image.failure().message;
  for (std::size_t i = 0; i < image->rgba.size(); i += 4) {
    EXPECT_EQ(image->rgba[i], image->rgba[i + 1]);
    EXPECT_EQ(image->rgba[i], image->rgba[i + 2]);
  }
}

TEST(Jpeg, RejectsCmykWithAMessage) {
  const auto image = decode_image(encode(8, 8, ramp(8, 8, 4), {JCS_CMYK, 4}), "ink.jpg");
  ASSERT_FALSE(image);
  EXPECT_EQ(image.failure().code, ErrorCode::bad_input);
  EXPECT_EQ(image.failure().message.rfind("ink.jpg: ", 0), 0u);
}

TEST(Jpeg, EveryTruncationIsAnError) {
  for (const bool progressive : {false, true}) {
    const auto bytes = encode(17, 9, ramp(17, 9, 3), {JCS_RGB, 3, progressive});
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
      const auto image = decode_image(cut, "cut.jpg");
      ASSERT_FALSE(image) << length << " of " << bytes.size();
      EXPECT_EQ(image.failure().code, ErrorCode::bad_input);
      EXPECT_EQ(image.failure().message.rfind("cut.jpg: ", 0), 0u);
    }
  }
}

TEST(Jpeg, EveryDamagedByteIsAnErrorOrAnImage) {
  const auto bytes = encode(17, 9, ramp(17, 9, 3), {JCS_RGB, 3, true});
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto damaged = bytes;
    damaged[i] ^= std::byte{0x2b};
    if (const auto image = decode_image(damaged, "damaged.jpg")) {
      EXPECT_EQ(image->rgba.size(), std::size_t{image->width} * image->height * 4);
    }
  }
}

TEST(Jpeg, RejectsSizesBeforeItAllocates) {
  auto bytes = encode(8, 8, ramp(8, 8, 3), {});
  // The frame header: FF C0, length, depth, then height and width, big-endian.
  for (std::size_t i = 0; i + 8 < bytes.size(); ++i) {
    if (bytes[i] == std::byte{0xff} && bytes[i + 1] == std::byte{0xc0}) {
      bytes[i + 5] = bytes[i + 7] = std::byte{0xff};
      break;
    }
  }
  const auto image = decode_image(bytes, "huge.jpg");
  ASSERT_FALSE(image);
  EXPECT_EQ(image.failure().code, ErrorCode::resource_limit);
}

}  // namespace
}  // namespace brume::image
