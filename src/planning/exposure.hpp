// The exposure that fits an image.
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace brume::planning {

/// The factor that brings the geometric mean of the luminance to a middle brightness, but the brightest
/// quarter of the pixels to no more than 0.65: a black car does not burn the ground, nor a small light the sky.
/// Twice the light gives half of it. At least one pixel; the fourth component does not count.
float exposure_of(std::span<const glm::vec4> radiance);

}  // namespace brume::planning
