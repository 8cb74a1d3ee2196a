// The colour of what glows with heat.
#pragma once

#include <glm/glm.hpp>

namespace brume::planning {

/// Temperature at which glowing has a radiance of 1 [K]: a candle's flame.
constexpr float kUnitGlow = 1900;

/// Linear sRGB of a black body, negative components cut off. Its luminance grows with the fourth power of the
/// temperature (Stefan and Boltzmann: all of its radiation, other than what is visible, which would leave
/// little between dark and blinding) and is 1 at kUnitGlow. 0 below 400 K. Planck's law through the fit to
/// the colour matching functions of 1931 by Wyman, Sloan and Shirley 2013.
glm::vec3 blackbody_color(float kelvin);

}  // namespace brume::planning
