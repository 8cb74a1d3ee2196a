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

}  // namespace brume::image
