#include "image/background.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>

namespace brume::image {
namespace {

/// One pixel: a half-transparent white medium before a blue sky, then a surface, then the sky alone.
LayeredImage picture() {
  LayeredImage image{3, 1, {}};
  const auto add = [&](const char* name, std::vector<float> values) {
    std::vector<std::uint16_t> halves;
    for (const float value : values) halves.push_back(glm::packHalf1x16(value));
    image.layers.push_back({name, halves});
  };
  add("R", {0.25f, 0.125f, 0});
  add("G", {0.25f, 0.125f, 0});
  add("B", {0.25f, 0.125f, 0});
  add("A", {0.5f, 1, 0});
  add("background.R", {0, 0, 0});
  add("background.G", {0, 0, 0});
  add("background.B", {0.5f, 0, 1});
  image.layers.push_back({"Z", std::vector<float>{3, 2, 1}});
  return image;
}

std::vector<float> values_of(const LayeredImage& image, const std::string& name) {
  for (const Layer& layer : image.layers) {
    if (layer.name != name) continue;
    if (const auto* floats = std::get_if<std::vector<float>>(&layer.values)) return *floats;
    std::vector<float> values;
    for (const std::uint16_t half : std::get<std::vector<std::uint16_t>>(layer.values))
      values.push_back(glm::unpackHalf1x16(half));
    return values;
  }
  return {};
}

using Values = std::vector<float>;

TEST(Background, IsALayerInThePictureOrNowhere) {
  LayeredImage layer = picture(), none = picture(), in = picture();
  set_background(layer, Background::layer);
  EXPECT_EQ(layer.layers.size(), picture().layers.size());
  set_background(none, Background::none);
  EXPECT_EQ(none.layers.size(), 5u);
  EXPECT_EQ(values_of(none, "B"), (Values{0.25f, 0.125f, 0}));
  EXPECT_EQ(values_of(none, "A"), (Values{0.5f, 1, 0}));
  set_background(in, Background::in);
  EXPECT_EQ(in.layers.size(), 5u);
  EXPECT_EQ(values_of(in, "R"), (Values{0.25f, 0.125f, 0}));
  EXPECT_EQ(values_of(in, "B"), (Values{0.75f, 0.125f, 1}));
  EXPECT_EQ(values_of(in, "A"), (Values{1, 1, 1}));
  EXPECT_EQ(values_of(in, "Z"), (Values{3, 2, 1}));
}

TEST(Background, APictureWithoutOneStaysAsItIs) {
  LayeredImage image{1, 1, {{"R", Values{2}}}};
  set_background(image, Background::in);
  EXPECT_EQ(values_of(image, "R"), Values{2});
}

}  // namespace
}  // namespace brume::image
