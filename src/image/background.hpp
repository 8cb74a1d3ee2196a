// Pictures with and without what is behind all surfaces and media: the sky.
#pragma once

#include "image/image.hpp"

namespace brume::image {

/// Where a picture has its background.
enum class Background {
  none,   ///< Nowhere: RGB is premultiplied by A.
  layer,  ///< In layers of its own, background.R, .G and .B, whose sum with RGB is the whole picture.
  in,     ///< In RGB; A is 1.
};

/// Gives a picture that is Background::layer another form. One without those layers stays as it is: it has no
/// background.
void set_background(LayeredImage& image, Background background);

/// How radiance becomes colour.
struct Display {
  float exposure = 1;      ///< A factor.
  std::uint32_t tone = 0;  ///< shared::kToneNeutral or kToneStandard.
};
/// The colours of a picture that is Background::none, and its alpha, by which they are not multiplied
/// (PNG 2003, 13.16); 0 where it is transparent.
Image8 colors_of(const LayeredImage& image, const Display& display);

}  // namespace brume::image
