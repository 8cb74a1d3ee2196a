// Pictures as linear numbers, and what a display shows of them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "image/image.hpp"

namespace brume::image {

/// Linear numbers, rows from the top: width * height of them. Colours are premultiplied by alpha unless a
/// function says otherwise.
struct Texels {
  std::uint32_t width = 0, height = 0;
  std::vector<glm::vec4> rgba;
};

/// The values of a layer, half floats or not.
std::vector<float> to_floats(const Layer& layer);

/// R, G, B and A of a picture that is Background::none.
Texels to_texels(const LayeredImage& picture);

/// How radiance becomes colour.
struct Display {
  float exposure = 1;      ///< A factor.
  std::uint32_t tone = 0;  ///< shared::kToneNeutral or kToneStandard.
};

/// Colours as a display shows them, linear in [0, 1] and premultiplied. Alpha stays, within [0, 1]; where
/// it is 0, what glows stays.
Texels displayed(const Texels& picture, const Display& display);
/// The same straight: not multiplied by alpha. Alpha is raised where light is brighter than colours of at
/// most 1 can be, as flames are; 0 where nothing is.
Texels displayed_straight(const Texels& picture, const Display& display);

/// Divides colours by alpha; 0 where it is 0.
void make_straight(Texels& picture);
/// Continues straight colours into what is transparent, or nearly so, so that filtering shows no dark rim.
/// Alpha stays.
void fill_transparent(Texels& straight);

/// Linear colours as 8 bits of sRGB, and alpha.
Image8 to_colors(const Texels& shown);

}  // namespace brume::image
