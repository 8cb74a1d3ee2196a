// The sky and the sun of a timeline.
#pragma once

#include <glm/glm.hpp>

namespace brume::scene {

/// Linear radiance of the sky where no surface covers it, and of the ambient light.
struct SkyOptions {
  glm::vec3 zenith{0.20f, 0.36f, 0.70f};
  glm::vec3 horizon{0.55f, 0.65f, 0.78f};
  glm::vec3 ambient{0.25f, 0.29f, 0.35f};
  float stars = 0;
  float bounce = 0.2f;
};

/// The one sun of a scene, in the place of its own.
struct SunOptions {
  float azimuth = 0.87266463f;    ///< 50 degrees.
  float elevation = 0.87266463f;  ///< 50 degrees.
  glm::vec3 irradiance{2.6f, 2.4f, 2.1f};
};

}  // namespace brume::scene
