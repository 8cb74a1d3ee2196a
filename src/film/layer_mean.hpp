// The mean of the layers of the frames of one picture, and its background apart.
#pragma once

#include <array>
#include <vector>

#include "image/image.hpp"

namespace brume::film {

/// Takes the frames of a picture as FrameLayers reads them, in order.
class LayerMean {
 public:
  void add(image::LayeredImage frame);
  /// The mean of at least one frame. R, G and B are halves; other layers are floats unless there is one
  /// frame. The radiance of the sky, as far as media let it through, is in layers of its own
  /// (image::Background::layer): before it, R, G and B are the radiance of the media alone, to the bit where
  /// there is one frame.
  image::LayeredImage mean() const;

 private:
  /// What frames that saw the sky saw of it, in one colour of each pixel.
  struct Sky {
    std::vector<double> sum;
    std::vector<float> mean;  ///< Over all frames so far, with the sky or not.
  };
  void add_sky(const image::LayeredImage& frame);
  void take_background(image::LayeredImage& image) const;

  std::uint32_t frames_ = 0;
  image::LayeredImage last_;
  std::vector<std::vector<double>> sums_;
  std::vector<std::vector<std::uint32_t>> finite_;  ///< Summands.
  std::array<Sky, 3> sky_;                          ///< R, G, B.
  std::vector<std::uint32_t> sees_sky_;             ///< Frames.
};

}  // namespace brume::film
