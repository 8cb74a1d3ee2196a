#include "image/background.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

#include "shared/tone.h"

namespace brume::image {
namespace {

constexpr std::array kColors{"R", "G", "B"};

Layer* find(LayeredImage& image, const std::string& name) {
  const auto found = std::ranges::find(image.layers, name, &Layer::name);
  return found == image.layers.end() ? nullptr : &*found;
}

std::vector<float> floats_of(const Layer& layer) {
  if (const auto* floats = std::get_if<std::vector<float>>(&layer.values)) return *floats;
  const auto& halves = std::get<std::vector<std::uint16_t>>(layer.values);
  std::vector<float> values(halves.size());
  std::ranges::transform(halves, values.begin(),
                         [](std::uint16_t half) { return glm::unpackHalf1x16(half); });
  return values;
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
      std::vector<float> sum = floats_of(layer);
      const std::vector<float> behind = floats_of(*find(image, "background." + color));
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += behind[i];
      set_values(sum, layer);
    }
    Layer& alpha = *find(image, "A");
    set_values(std::vector<float>(std::size_t{image.width} * image.height, 1), alpha);
  }
  std::erase_if(image.layers, [](const Layer& layer) { return layer.name.starts_with("background."); });
}

Image8 colors_of(const LayeredImage& image, const Display& display) {
  LayeredImage copy = image;
  std::array<std::vector<float>, 4> channels;
  for (std::size_t c = 0; c < 3; ++c) channels[c] = floats_of(*find(copy, kColors[c]));
  channels[3] = floats_of(*find(copy, "A"));
  Image8 out{image.width, image.height, std::vector<std::uint8_t>(4 * channels[3].size())};
  for (std::size_t i = 0; i < channels[3].size(); ++i) {
    const float alpha = std::clamp(channels[3][i], 0.0f, 1.0f);
    const auto byte = [](float value) { return static_cast<std::uint8_t>(std::lround(255 * value)); };
    out.rgba[4 * i + 3] = byte(alpha);
    if (out.rgba[4 * i + 3] == 0) continue;
    const glm::vec3 radiance(channels[0][i], channels[1][i], channels[2][i]);
    // Next to lights it may be infinite.
    const glm::vec3 shown = glm::min(radiance * (display.exposure / alpha), glm::vec3(65504));
    const glm::vec3 color = shared::srgb_from_linear(shared::tone_curve(display.tone, shown));
    for (int c = 0; c < 3; ++c) out.rgba[4 * i + static_cast<std::size_t>(c)] = byte(color[c]);
  }
  return out;
}

}  // namespace brume::image
