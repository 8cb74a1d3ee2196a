// The exposure that fits an image.
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace brume::planning {

/// The factor that brings the geometric mean of the luminance to a middle brightness, but the third of the
/// pixels that are brightest to no more than 60 % of white (the darkest of them), and the brightest quarter
/// to no more than 0.65: before a black car the ground is no brighter than before a grey one. A small light
/// may burn out. Twice the light gives half of it. At least one pixel; the fourth component does not count.
float exposure_of(std::span<const glm::vec4> radiance);

}  // namespace brume::planning
