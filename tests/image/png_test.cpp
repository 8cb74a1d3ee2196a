#include "image/png.hpp"

#include <gtest/gtest.h>
#include <spng.h>

#include <algorithm>
#include <array>

#include "core/file.hpp"
#include "image/decode.hpp"
#include "tests/image/image_test_tools.hpp"

namespace brume::image {
namespace {

// A PNG file has width and height big-endian at byte 16, the depth at 24, the colour type at 25.
std::uint8_t byte_at(const std::filesystem::path& path, std::size_t offset) {
  return static_cast<std::uint8_t>((*read_file(path)).at(offset));
}

TEST(Png, RoundTripsEveryTexel) {
  const cli::WorkFolder folder;
  const std::array<std::array<std::uint32_t, 2>, 4> sizes{{{1, 1}, {7, 5}, {33, 17}, {1, 300}}};
  for (const auto& [width, height] : sizes) {
    for (const bool opaque : {true, false}) {
      const Image8 image = random_image(width, height, opaque, width * 2 + opaque);
      ASSERT_TRUE(save_png(folder.path() / "a.png", image));
      const auto back = load_image(folder.path() / "a.png").value_or_throw();
      EXPECT_EQ(back.width, width);
      EXPECT_EQ(back.height, height);
      EXPECT_EQ(back.rgba, image.rgba);
    }
  }
  EXPECT_EQ(folder.files().size(), 1u);
}

TEST(Png, HasAlphaOnlyWhereNeeded) {
  const cli::WorkFolder folder;
  ASSERT_TRUE(save_png(folder.path() / "rgb.png", random_image(3, 3, true, 1)));
  ASSERT_TRUE(save_png(folder.path() / "rgba.png", random_image(3, 3, false, 1)));
  EXPECT_EQ(byte_at(folder.path() / "rgb.png", 25), SPNG_COLOR_TYPE_TRUECOLOR);
  EXPECT_EQ(byte_at(folder.path() / "rgba.png", 25), SPNG_COLOR_TYPE_TRUECOLOR_ALPHA);
}

TEST(Png, Saves16BitImages) {
  const cli::WorkFolder folder;
  Image16 image{33, 17, {}};
  for (std::uint32_t i = 0; i < 33 * 17 * 4; ++i) {
    image.rgba.push_back(static_cast<std::uint16_t>(i % 4 == 3 ? 65535 : i * 29));
  }
  ASSERT_TRUE(save_png(folder.path() / "a.png", image));
  EXPECT_EQ(byte_at(folder.path() / "a.png", 24), 16);
  const auto back = load_image(folder.path() / "a.png").value_or_throw();
  for (std::size_t i = 0; i < image.rgba.size(); ++i) ASSERT_EQ(back.rgba[i], image.rgba[i] >> 8) << i;
}

TEST(Png, HoldsAText) {
  const cli::WorkFolder folder;
  const auto path = folder.path() / "a.png";
  const auto with = random_image(9, 5, true, 1);
  ASSERT_TRUE(save_png(path, with, ImageText{"Made from", "0123abc"}));
  const auto bytes = read_file(path);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(find_png_text(*bytes, "Made from"), "0123abc");
  EXPECT_EQ(find_png_text(*bytes, "Made"), std::nullopt);
  EXPECT_EQ(load_image(path)->rgba, with.rgba);
  ASSERT_TRUE(save_png(path, with));
  EXPECT_EQ(find_png_text(*read_file(path), "Made from"), std::nullopt);
  for (std::size_t length = 0; length < bytes->size(); ++length) {
    const auto found = find_png_text(std::span(*bytes).first(length), "Made from");
    EXPECT_TRUE(!found || *found == "0123abc") << length;
  }
}

TEST(Png, EveryTruncationIsAnError) {
  const cli::WorkFolder folder;
  ASSERT_TRUE(save_png(folder.path() / "a.png", random_image(7, 5, false, 3)));
  const auto bytes = *read_file(folder.path() / "a.png");
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    // A copy of that length, so that the address sanitizer sees a read past it.
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    const auto image = decode_image(cut, "cut.png");
    ASSERT_FALSE(image) << length;
    EXPECT_EQ(image.failure().code, ErrorCode::bad_input);
    EXPECT_EQ(image.failure().message.rfind("cut.png: ", 0), 0u);
  }
}

TEST(Png, EveryDamagedByteIsAnErrorOrAnImage) {
  const cli::WorkFolder folder;
  ASSERT_TRUE(save_png(folder.path() / "a.png", random_image(7, 5, true, 4)));
  const auto bytes = *read_file(folder.path() / "a.png");
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto damaged = bytes;
    damaged[i] ^= std::byte{0x41};
    if (const auto image = decode_image(damaged, "damaged.png")) {
      EXPECT_EQ(image->rgba.size(), std::size_t{image->width} * image->height * 4);
    }
  }
}

// A PNG whose header says this size; libspng cannot write it, so the header of a small one is patched
// with a correct checksum (CRC-32 of the PNG standard, annex D).
std::vector<std::byte> hollow_png(std::uint32_t width, std::uint32_t height) {
  const cli::WorkFolder folder;
  EXPECT_TRUE(save_png(folder.path() / "a.png", random_image(1, 1, true, 6)));
  auto bytes = *read_file(folder.path() / "a.png");
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (unsigned i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::byte>(value >> (24 - 8 * i));
  };
  put(16, width);
  put(20, height);
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= std::to_integer<std::uint32_t>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  put(29, ~crc);
  return bytes;
}

TEST(Png, RejectsSizesBeforeItAllocates) {
  const auto wide = decode_image(hollow_png(kMaxAxis + 1, 1), "wide.png");
  ASSERT_FALSE(wide);
  EXPECT_EQ(wide.failure().code, ErrorCode::resource_limit);
  // 16384^2 texels out of a hundred bytes: impossible, and 1 GiB were it believed.
  const auto hollow = decode_image(hollow_png(kMaxAxis, kMaxAxis), "hollow.png");
  ASSERT_FALSE(hollow);
  EXPECT_EQ(hollow.failure().code, ErrorCode::bad_input);
  EXPECT_NE(hollow.failure().message.find("too short"), std::string::npos);
}

TEST(Png, NamesTheMissingFolder) {
  const auto missing = save_png("/nonexistent/a.png", random_image(2, 2, true, 5));
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.failure().code, ErrorCode::bad_input);
  EXPECT_NE(missing.failure().message.find("/nonexistent"), std::string::npos);
}

TEST(Decode, RejectsOtherFormats) {
  const std::string text = "GIF89a, or anything else";
  const auto image = decode_image(std::as_bytes(std::span(text)), "a.gif");
  ASSERT_FALSE(image);
  EXPECT_EQ(image.failure().code, ErrorCode::bad_input);
  EXPECT_EQ(load_image("/nonexistent.png").failure().code, ErrorCode::bad_input);
}

}  // namespace
}  // namespace brume::image
