// The exposure that fits an image.
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace brume::planning {

/// The factor that brings the geometric mean of the luminance to a middle brightness, nearly: dark scenes
/// stay darker than bright ones. At least one pixel; the fourth component does not count.
float exposure_of(std::span<const glm::vec4> radiance);

}  // namespace brume::planning
