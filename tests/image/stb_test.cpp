// TGA and BMP.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "image/decode.hpp"

namespace brume::image {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::span<const std::byte> span_of(const Bytes& bytes) {
  return std::as_bytes(std::span(bytes));
}

/// A TGA of 3 x 2: type 2 (colours) or 10 (run-length); origin at the bottom left, or at the top left.
Bytes tga(std::uint8_t type, std::uint8_t bits, bool from_top, const Bytes& texels) {
  Bytes bytes{0, 0, type, 0, 0, 0, 0, 0,    0,
              0, 0, 0,    3, 0, 2, 0, bits, static_cast<std::uint8_t>(from_top ? 0x20 : 0)};
  bytes.insert(bytes.end(), texels.begin(), texels.end());
  return bytes;
}

/// A BMP of 3 x 2 and 24 bits, from the bottom; rows are filled up to 12 bytes.
Bytes bmp() {
  Bytes bytes(54);
  const auto set = [&](std::size_t at, std::uint32_t value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  };
  bytes[0] = 'B';
  bytes[1] = 'M';
  set(2, 54 + 24);
  set(10, 54);
  set(14, 40);
  set(18, 3);
  set(22, 2);
  bytes[26] = 1;
  bytes[28] = 24;
  const Bytes texels{4, 0, 0, 5, 0, 0, 6, 0, 0, 9, 9, 9, 1, 0, 0, 2, 0, 0, 3, 0, 0, 9, 9, 9};
  bytes.insert(bytes.end(), texels.begin(), texels.end());
  return bytes;
}

/// Blue of 1 to 6 from the top left.
void expect_counts(const Result<Image8>& image) {
  ASSERT_TRUE(image) << image.failure().message;
  EXPECT_EQ(image->width, 3u);
  EXPECT_EQ(image->height, 2u);
  for (std::uint8_t i = 0; i < 6; ++i) {
    EXPECT_EQ(int{image->rgba[4 * std::size_t{i} + 2]}, i + 1);
    EXPECT_EQ(image->rgba[4 * std::size_t{i} + 3], 255);
  }
}

const Bytes kFromBottom{4, 0, 0, 5, 0, 0, 6, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0};
const Bytes kFromTop{1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0, 6, 0, 0};

TEST(Tga, RowsAreFromTheBottomOrFromTheTop) {
  expect_counts(decode_image(span_of(tga(2, 24, false, kFromBottom)), "a.tga"));
  expect_counts(decode_image(span_of(tga(2, 24, true, kFromTop)), "textures/A.TGA"));
}

TEST(Tga, AlphaAndRunLengths) {
  // Three texels alike, then three one by one.
  const Bytes packets{0x82, 7, 8, 9, 128, 0x02, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const auto image = decode_image(span_of(tga(10, 32, true, packets)), "a.tga").value_or_throw();
  EXPECT_EQ(image.rgba,
            (Bytes{9, 8, 7, 128, 9, 8, 7, 128, 9, 8, 7, 128, 3, 2, 1, 4, 7, 6, 5, 8, 11, 10, 9, 12}));
}

TEST(Tga, RowsMayRunToTheLeft) {
  Bytes bytes = tga(2, 24, true, {3, 0, 0, 2, 0, 0, 1, 0, 0, 6, 0, 0, 5, 0, 0, 4, 0, 0});
  bytes[17] |= 0x10;
  expect_counts(decode_image(span_of(bytes), "a.tga"));
}

TEST(Tga, AFooterSaysWhatItIs) {
  Bytes bytes = tga(2, 24, true, kFromTop);
  EXPECT_FALSE(decode_image(span_of(bytes), "a.img"));
  for (const char c : std::string_view("\0\0\0\0\0\0\0\0TRUEVISION-XFILE.\0", 26))
    bytes.push_back(static_cast<std::uint8_t>(c));
  expect_counts(decode_image(span_of(bytes), "a.img"));
}

TEST(Bmp, RowsAreFromTheBottom) {
  expect_counts(decode_image(span_of(bmp()), "a.bmp"));
}

TEST(Bmp, RowsAreFromTheTopWhereItsHeightIsNegative) {
  Bytes bytes = bmp();
  const std::int32_t height = -2;
  std::memcpy(bytes.data() + 22, &height, sizeof height);
  std::swap_ranges(bytes.begin() + 54, bytes.begin() + 66, bytes.begin() + 66);
  expect_counts(decode_image(span_of(bytes), "a.bmp"));
}

// A large picture of a few bytes is refused before it is made, also where its name says another format.
TEST(Bmp, IsOneByItsBeginning) {
  expect_counts(decode_image(span_of(bmp()), "a.tga"));
  Bytes large = bmp();
  const std::uint32_t width = 10000, height = 16000;
  std::memcpy(large.data() + 18, &width, sizeof width);
  std::memcpy(large.data() + 22, &height, sizeof height);
  const auto image = decode_image(span_of(large), "a.tga");
  ASSERT_FALSE(image);
  EXPECT_NE(image.failure().message.find("truncated"), std::string::npos);
}

// Of either, each shorter file is refused: none reads on as zeros.
TEST(TgaAndBmp, EveryTruncationIsAnError) {
  const Bytes packets{0x82, 7, 8, 9, 128, 0x02, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  for (const Bytes& whole : {tga(2, 24, false, kFromBottom), tga(10, 32, true, packets), bmp()}) {
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
      const auto image = decode_image(span_of(part), whole[0] == 'B' ? "a.bmp" : "a.tga");
      EXPECT_FALSE(image) << length;
    }
  }
}

TEST(TgaAndBmp, EveryDamagedByteIsAnErrorOrAnImage) {
  const Bytes packets{0x82, 7, 8, 9, 128, 0x02, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  for (const Bytes& whole : {tga(2, 24, false, kFromBottom), tga(10, 32, true, packets), bmp()}) {
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const int value : {0, 1, 2, 8, 16, 32, 127, 128, 255}) {
        Bytes damaged = whole;
        damaged[at] = static_cast<std::uint8_t>(value);
        const auto image = decode_image(span_of(damaged), "a.tga");
        if (image) {
          EXPECT_EQ(image->rgba.size(), std::size_t{4} * image->width * image->height);
        }
      }
    }
  }
}

}  // namespace
}  // namespace brume::image
