#include "image/background.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/packing.hpp>

#include "image/texels.hpp"

namespace brume::image {
namespace {

constexpr std::array kColors{"R", "G", "B"};

Layer* find(LayeredImage& image, const std::string& name) {
  const auto found = std::ranges::find(image.layers, name, &Layer::name);
  return found == image.layers.end() ? nullptr : &*found;
}

void set_values(const std::vector<float>& values, Layer& layer) {
  if (std::holds_alternative<std::vector<float>>(layer.values)) {
    layer.values = values;
    return;
  }
  std::vector<std::uint16_t> halves(values.size());
  std::ranges::transform(values, halves.begin(), [](float value) { return glm::packHalf1x16(value); });
  layer.values = std::move(halves);
}

}  // namespace

void set_background(LayeredImage& image, Background background) {
  if (background == Background::layer || !find(image, "background.R")) return;
  if (background == Background::in) {
    for (const std::string color : kColors) {
      Layer& layer = *find(image, color);
      std::vector<float> sum = to_floats(layer);
      const std::vector<float> behind = to_floats(*find(image, "background." + color));
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += behind[i];
      set_values(sum, layer);
    }
    Layer& alpha = *find(image, "A");
    set_values(std::vector<float>(std::size_t{image.width} * image.height, 1), alpha);
  }
  std::erase_if(image.layers, [](const Layer& layer) { return layer.name.starts_with("background."); });
}

}  // namespace brume::image
