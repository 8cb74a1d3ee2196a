#include "image/texels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <string>

#include "shared/tone.h"

namespace brume::image {
namespace {

float largest_of(glm::vec3 color) {
  return std::max({color.r, color.g, color.b});
}

// Half as wide and high, rounded up: sums of what is opaque, weighted by alpha.
Texels halved(const Texels& from) {
  Texels half{(from.width + 1) / 2, (from.height + 1) / 2, {}};
  half.rgba.resize(std::size_t{half.width} * half.height, glm::vec4(0));
  for (std::uint32_t y = 0; y < from.height; ++y)
    for (std::uint32_t x = 0; x < from.width; ++x)
      half.rgba[std::size_t{y / 2} * half.width + x / 2] += from.rgba[std::size_t{y} * from.width + x];
  return half;
}

// Gives each texel the colour of the finest level that knows one.
void fill_from_coarser(Texels& texels) {
  if (texels.width == 1 && texels.height == 1) return;
  Texels coarser = halved(texels);
  fill_from_coarser(coarser);
  for (std::uint32_t y = 0; y < texels.height; ++y) {
    for (std::uint32_t x = 0; x < texels.width; ++x) {
      glm::vec4& texel = texels.rgba[std::size_t{y} * texels.width + x];
      if (texel.a <= 0) texel = coarser.rgba[std::size_t{y / 2} * coarser.width + x / 2];
    }
  }
}

// Straight colours before the tone curve, at most 1 in alpha's place where alpha can be raised.
glm::vec4 straight_of(glm::vec4 texel, float exposure) {
  const float alpha = std::clamp(texel.a, 0.0f, 1.0f);
  // Beside lights radiance may be infinite.
  const glm::vec3 radiance = glm::clamp(glm::vec3(texel) * exposure, 0.0f, 65504.0f);
  const float raised = std::clamp(largest_of(radiance), alpha, 1.0f);
  return raised > 0 ? glm::vec4(radiance / raised, raised) : glm::vec4(0);
}

glm::vec3 shown_of(glm::vec3 color, const Display& display) {
  return glm::clamp(shared::tone_curve(display.tone, color), 0.0f, 1.0f);
}

}  // namespace

std::vector<float> to_floats(const Layer& layer) {
  if (const auto* floats = std::get_if<std::vector<float>>(&layer.values)) return *floats;
  const auto& halves = std::get<std::vector<std::uint16_t>>(layer.values);
  std::vector<float> values(halves.size());
  std::ranges::transform(halves, values.begin(),
                         [](std::uint16_t half) { return glm::unpackHalf1x16(half); });
  return values;
}

Texels to_texels(const LayeredImage& picture) {
  Texels texels{picture.width, picture.height, {}};
  texels.rgba.resize(std::size_t{picture.width} * picture.height, glm::vec4(0));
  constexpr std::array kNames{"R", "G", "B", "A"};
  for (int channel = 0; channel < 4; ++channel) {
    const auto layer = std::ranges::find(
        picture.layers, std::string(kNames[static_cast<std::size_t>(channel)]), &Layer::name);
    if (layer == picture.layers.end()) continue;
    const std::vector<float> values = to_floats(*layer);
    for (std::size_t i = 0; i < texels.rgba.size(); ++i) texels.rgba[i][channel] = values[i];
  }
  return texels;
}

Texels displayed(const Texels& picture, const Display& display) {
  Texels shown = picture;
  for (glm::vec4& texel : shown.rgba) {
    const glm::vec4 straight = straight_of(texel, display.exposure);
    texel = glm::vec4(shown_of(glm::vec3(straight), display) * straight.a, std::clamp(texel.a, 0.0f, 1.0f));
  }
  return shown;
}

Texels displayed_straight(const Texels& picture, const Display& display) {
  Texels shown = picture;
  for (glm::vec4& texel : shown.rgba) {
    const glm::vec4 straight = straight_of(texel, display.exposure);
    texel = glm::vec4(straight.a > 0 ? shown_of(glm::vec3(straight), display) : glm::vec3(0), straight.a);
  }
  return shown;
}

void make_straight(Texels& picture) {
  for (glm::vec4& texel : picture.rgba)
    texel = glm::vec4(texel.a > 0 ? glm::vec3(texel) / texel.a : glm::vec3(0), texel.a);
}

void fill_transparent(Texels& straight) {
  // The colour of what is next to transparent is a quotient of two roundings: it counts as transparent, too.
  constexpr float kLeastKnown = 3.5f / 255;
  Texels filled = straight;
  for (glm::vec4& texel : filled.rgba) {
    const float known = texel.a < kLeastKnown ? 0 : texel.a;
    texel = glm::vec4(glm::vec3(texel) * known, known);
  }
  fill_from_coarser(filled);
  for (std::size_t i = 0; i < straight.rgba.size(); ++i) {
    const glm::vec4 from = filled.rgba[i];
    const float alpha = straight.rgba[i].a;
    if (alpha < kLeastKnown && from.a > 0) straight.rgba[i] = glm::vec4(glm::vec3(from) / from.a, alpha);
  }
}

Image8 to_colors(const Texels& shown) {
  Image8 image{shown.width, shown.height, std::vector<std::uint8_t>(4 * shown.rgba.size())};
  const auto byte = [](float value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
  };
  for (std::size_t i = 0; i < shown.rgba.size(); ++i) {
    const glm::vec3 color = shared::srgb_from_linear(glm::vec3(shown.rgba[i]));
    for (int c = 0; c < 3; ++c) image.rgba[4 * i + static_cast<std::size_t>(c)] = byte(color[c]);
    image.rgba[4 * i + 3] = byte(shown.rgba[i].a);
  }
  return image;
}

}  // namespace brume::image
