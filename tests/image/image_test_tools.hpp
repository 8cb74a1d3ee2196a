// Helpers of the image tests.
#pragma once

#include <random>

#include "image/image.hpp"
#include "tests/work_folder.hpp"

namespace brume::image {

inline Image8 random_image(std::uint32_t width, std::uint32_t height, bool opaque, unsigned seed) {
  std::mt19937 random(seed);
  Image8 image{width, height, {}};
  image.rgba.resize(std::size_t{width} * height * 4);
  for (auto& value : image.rgba) value = static_cast<std::uint8_t>(random());
  if (opaque) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  }
  return image;
}

}  // namespace brume::image
