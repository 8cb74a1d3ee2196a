// The mean of frames as numbers.
#pragma once

#include "image/image.hpp"

namespace brume::render {

/// The mean of frames with the same layers. R, G and B are those of the last frame, which is the mean of
/// those before (ViewSample); each value of `Z` and `depth_in` is the mean where it is finite.
class LayerMean {
 public:
  void add(image::LayeredImage frame);
  /// Of at least one frame, as it is where there is one.
  image::LayeredImage mean() const;

 private:
  std::uint32_t frames_ = 0;
  image::LayeredImage last_;
  std::vector<std::vector<double>> sums_;
  std::vector<std::vector<std::uint32_t>> finite_;  ///< Summands.
};

}  // namespace brume::render
