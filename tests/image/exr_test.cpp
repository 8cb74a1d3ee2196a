#include "image/exr.hpp"

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/file.hpp"
#include "tests/image/image_test_tools.hpp"

namespace brume::image {
namespace {

// Layers of every bit pattern, those of infinities and NaN included.
LayeredImage random_layers(std::uint32_t width, std::uint32_t height, unsigned seed) {
  std::mt19937 random(seed);
  const std::size_t count = std::size_t{width} * height;
  std::vector<std::uint16_t> red(count), albedo(count);
  std::vector<float> depth(count);
  for (std::size_t i = 0; i < count; ++i) {
    red[i] = static_cast<std::uint16_t>(random());
    albedo[i] = static_cast<std::uint16_t>(random());
    depth[i] = i % 3 == 0 ? std::numeric_limits<float>::infinity() : static_cast<float>(random()) * 1e-3f;
  }
  // Sorted by name, as a file has them.
  return {width, height, {{"R", red}, {"Z", depth}, {"albedo.R", albedo}}};
}

void expect_equal(const LayeredImage& a, const LayeredImage& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  ASSERT_EQ(a.layers.size(), b.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    EXPECT_EQ(a.layers[i].name, b.layers[i].name);
    EXPECT_EQ(a.layers[i].values, b.layers[i].values) << a.layers[i].name;
  }
}

std::vector<std::byte> file_of(const LayeredImage& image, const std::optional<ImageText>& text = {}) {
  const cli::WorkFolder folder;
  const auto path = folder.path() / "a.exr";
  save_exr(path, image, text).value_or_throw();
  EXPECT_EQ(folder.files().size(), 1u);
  return read_file(path).value_or_throw();
}

TEST(Exr, KeepsEveryBitAtEverySize) {
  for (const auto& [width, height] : {std::pair(1u, 1u), {7u, 3u}, {33u, 17u}, {3u, 40u}}) {
    const LayeredImage image = random_layers(width, height, width);
    const auto back = decode_exr(file_of(image), "a.exr").value_or_throw();
    expect_equal(back, image);
  }
}

// What other programs read: the library itself, without our reader.
TEST(Exr, IsReadByOpenExr) {
  const cli::WorkFolder folder;
  const auto path = folder.path() / "a.exr";
  const LayeredImage image = random_layers(7, 3, 5);
  ASSERT_TRUE(save_exr(path, image));
  Imf::InputFile file(path.c_str());
  EXPECT_EQ(file.header().dataWindow().size(), Imath::V2i(6, 2));
  ASSERT_TRUE(file.header().channels().findChannel("Z"));
  EXPECT_EQ(file.header().channels().findChannel("Z")->type, Imf::FLOAT);
  EXPECT_EQ(file.header().channels().findChannel("albedo.R")->type, Imf::HALF);
  ASSERT_TRUE(Imf::hasChromaticities(file.header()));
  EXPECT_EQ(Imf::chromaticities(file.header()).red, Imath::V2f(0.64f, 0.33f)) << "of Rec. 709";
  std::vector<std::uint16_t> red(21);
  Imf::FrameBuffer slices;
  slices.insert("R", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(red.data()), 2, 14));
  file.setFrameBuffer(slices);
  file.readPixels(0, 2);
  EXPECT_EQ(red, std::get<0>(image.layers[0].values));
}

// Pixels need not begin at (0, 0).
TEST(Exr, ReadsWindowsThatBeginElsewhere) {
  const cli::WorkFolder folder;
  const auto path = folder.path() / "a.exr";
  std::vector<float> values{1, 2, 3, 4, 5, 6};
  {
    Imf::Header header(Imath::Box2i({0, 0}, {9, 9}), Imath::Box2i({-4, 5}, {-2, 6}));
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    Imf::FrameBuffer slices;
    char* const first = reinterpret_cast<char*>(values.data());
    slices.insert("Y", Imf::Slice(Imf::FLOAT, first + 4 * 4 - 5 * 12, 4, 12));
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(slices);
    file.writePixels(2);
  }
  const auto image = decode_exr(*read_file(path), "a.exr").value_or_throw();
  expect_equal(image, {3, 2, {{"Y", values}}});
}

TEST(Exr, ListsPartsChannelsAndTexts) {
  const auto bytes = file_of(random_layers(33, 17, 2), ImageText{"Brume frame", "0123abc"});
  const auto parts = decode_exr_parts(bytes, "a.exr").value_or_throw();
  ASSERT_EQ(parts.size(), 1u);
  const ExrPart& part = parts.front();
  EXPECT_EQ(part.width, 33u);
  EXPECT_EQ(part.height, 17u);
  ASSERT_EQ(part.channels.size(), 3u);
  EXPECT_EQ(part.channels[1].name + " " + part.channels[1].type, "Z float");
  EXPECT_EQ(part.channels[2].name + " " + part.channels[2].type, "albedo.R half");
  const auto text = std::find_if(part.texts.begin(), part.texts.end(),
                                 [](const ImageText& t) { return t.keyword == "Brume frame"; });
  ASSERT_NE(text, part.texts.end());
  EXPECT_EQ(text->text, "0123abc");
}

TEST(Exr, EveryTruncationIsAnError) {
  const auto bytes = file_of(random_layers(7, 20, 3));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    // A copy of that length, so that the address sanitizer sees a read past it.
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    const auto image = decode_exr(cut, "cut.exr");
    ASSERT_FALSE(image) << length;
    EXPECT_EQ(image.failure().code, ErrorCode::bad_input);
    EXPECT_EQ(image.failure().message.rfind("cut.exr: ", 0), 0u);
    EXPECT_EQ(image.failure().message.find('\n'), std::string::npos);
    EXPECT_NE(image.failure().message.find("truncated"), std::string::npos) << image.failure().message;
  }
}

TEST(Exr, EndsWithItsLastBlock) {
  for (const auto& [width, height] : {std::pair(1u, 1u), {7u, 3u}, {33u, 40u}}) {
    auto bytes = file_of(random_layers(width, height, width), ImageText{"Brume frame", "0123abc"});
    const std::uint64_t length = bytes.size();
    for (const std::size_t more : {0, 1, 100}) {
      bytes.resize(length + more, std::byte{7});
      EXPECT_EQ(exr_length(bytes, "a.exr").value_or_throw(), length);
    }
    bytes.resize(length - 1);
    EXPECT_FALSE(exr_length(bytes, "a.exr"));
  }
}

TEST(Exr, EveryDamagedValueIsAnError) {
  const LayeredImage image = random_layers(7, 20, 4);
  const auto bytes = file_of(image);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto damaged = bytes;
    damaged[i] ^= std::byte{0x41};
    const auto read = decode_exr(damaged, "damaged.exr");
    refused += read ? 0 : 1;
    // What is read has the values of the original, unless the damage is in a size or the list of channels.
    if (!read || read->layers.size() != image.layers.size()) continue;
    if (read->width != image.width || read->height != image.height) continue;
    for (std::size_t k = 0; k < image.layers.size(); ++k)
      EXPECT_EQ(read->layers[k].values, image.layers[k].values) << i;
  }
  EXPECT_GT(refused, bytes.size() / 2);
}

}  // namespace
}  // namespace brume::image
