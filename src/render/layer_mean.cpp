#include "render/layer_mean.hpp"

#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>

namespace brume::render {
namespace {

bool is_radiance(const image::Layer& layer) {
  return layer.name == "R" || layer.name == "G" || layer.name == "B";
}

float value_at(const image::Layer& layer, std::size_t i) {
  if (const auto* halves = std::get_if<std::vector<std::uint16_t>>(&layer.values))
    return glm::unpackHalf1x16((*halves)[i]);
  return std::get<std::vector<float>>(layer.values)[i];
}

}  // namespace

void LayerMean::add(image::LayeredImage frame) {
  const std::size_t count = std::size_t{frame.width} * frame.height;
  sums_.resize(frame.layers.size());
  finite_.resize(frame.layers.size());
  for (std::size_t l = 0; l < frame.layers.size(); ++l) {
    if (is_radiance(frame.layers[l])) continue;
    sums_[l].resize(count);
    finite_[l].resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const float value = value_at(frame.layers[l], i);
      if (!std::isfinite(value)) continue;
      sums_[l][i] += double{value};
      ++finite_[l][i];
    }
  }
  last_ = std::move(frame);
  ++frames_;
}

image::LayeredImage LayerMean::mean() const {
  image::LayeredImage image = last_;
  if (frames_ == 1) return image;
  for (std::size_t l = 0; l < image.layers.size(); ++l) {
    if (is_radiance(image.layers[l])) continue;
    std::vector<float> means(sums_[l].size(), std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < means.size(); ++i)
      if (finite_[l][i] > 0) means[i] = static_cast<float>(sums_[l][i] / finite_[l][i]);
    image.layers[l].values = std::move(means);
  }
  return image;
}

}  // namespace brume::render
