// How the light of the sun and the sky changes where the sun is low.
#pragma once

#include "scene/sky.hpp"

namespace brume::scene {

/// Elevation from which on daylight is as at noon [radians]: 28 degrees.
inline constexpr float kDaylightElevation = 0.4887f;

/// The fraction of the sun's red, green and blue that clear air lets through at an elevation [radians],
/// relative to that at kDaylightElevation: 1 from there on, below it less, of blue least. Elevations below 0
/// count as 0. Optical depths: of air by Hansen and Travis 1974, "Light scattering in planetary atmospheres",
/// eq. 2.30, with a thin haze by Angstrom's formula. Air mass: Kasten and Young 1989, "Revised optical air
/// mass tables".
glm::vec3 sunlight_fraction(float elevation);

/// Dims a sky of noon as the sun at this elevation [radians] does, and warms its horizon. Returns the factor
/// of its brightness, 1 from kDaylightElevation on. A look, fitted to no measurement.
float dim_sky(SkyOptions& sky, float elevation);

}  // namespace brume::scene
