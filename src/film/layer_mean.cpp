#include "film/layer_mean.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>

namespace brume::film {
namespace {

bool is_radiance(const image::Layer& layer) {
  return layer.name == "R" || layer.name == "G" || layer.name == "B";
}

float value_at(const image::Layer& layer, std::size_t i) {
  if (const auto* halves = std::get_if<std::vector<std::uint16_t>>(&layer.values))
    return glm::unpackHalf1x16((*halves)[i]);
  return std::get<std::vector<float>>(layer.values)[i];
}

constexpr std::array kColors{"R", "G", "B"};

const image::Layer& layer_of(const image::LayeredImage& image, const std::string& name) {
  return *std::ranges::find(image.layers, name, &image::Layer::name);
}

}  // namespace

/// The device has the mean of the frames so far: n times it, less n - 1 times the one before, is the frame's
/// own.
void LayerMean::add_sky(const image::LayeredImage& frame) {
  const std::size_t count = std::size_t{frame.width} * frame.height;
  const image::Layer& z = layer_of(frame, "Z");
  sees_sky_.resize(count);
  for (std::size_t i = 0; i < count; ++i) sees_sky_[i] += std::isinf(value_at(z, i)) ? 1u : 0u;
  for (std::size_t c = 0; c < 3; ++c) {
    const image::Layer &all = layer_of(frame, kColors[c]),
                       &media = layer_of(frame, std::string("media.") + kColors[c]);
    Sky& sky = sky_[c];
    sky.sum.resize(count);
    sky.mean.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double n = frames_ + 1, mean{value_at(all, i)};
      const double own = n * mean - (n - 1) * double{sky.mean[i]} - double{value_at(media, i)};
      if (std::isinf(value_at(z, i)) && own > 0 && std::isfinite(own)) sky.sum[i] += own;
      sky.mean[i] = static_cast<float>(mean);
    }
  }
}

void LayerMean::take_background(image::LayeredImage& image) const {
  const std::size_t count = std::size_t{image.width} * image.height;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string color = kColors[c];
    std::vector<std::uint16_t> before(count), behind(count);
    const image::Layer &all = layer_of(image, color), &media = layer_of(image, "media." + color);
    for (std::size_t i = 0; i < count; ++i) {
      const float whole = value_at(all, i), of_media = value_at(media, i);
      // Both at a surface's edge alone; what the mean lost to rounding is not seen there.
      float rest = 0;
      if (sees_sky_[i] == frames_)
        rest = std::isfinite(of_media) ? std::max(whole - of_media, 0.0f) : 0;
      else if (sees_sky_[i] > 0)
        rest = std::min(static_cast<float>(sky_[c].sum[i] / frames_), whole);
      behind[i] = glm::packHalf1x16(rest);
      before[i] = glm::packHalf1x16(sees_sky_[i] == frames_ ? of_media : whole - rest);
    }
    std::ranges::find(image.layers, color, &image::Layer::name)->values = std::move(before);
    image.layers.push_back({"background." + color, std::move(behind)});
  }
}

void LayerMean::add(image::LayeredImage frame) {
  add_sky(frame);
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
  for (std::size_t l = 0; frames_ > 1 && l < image.layers.size(); ++l) {
    if (is_radiance(image.layers[l])) continue;
    std::vector<float> means(sums_[l].size(), std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < means.size(); ++i)
      if (finite_[l][i] > 0) means[i] = static_cast<float>(sums_[l][i] / finite_[l][i]);
    image.layers[l].values = std::move(means);
  }
  take_background(image);
  return image;
}

}  // namespace brume::film
