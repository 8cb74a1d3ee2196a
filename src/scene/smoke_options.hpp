// How the smokes of a timeline behave and look.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

namespace brume::scene {

/// Units, ranges and meanings: visit_smoke_options (scene/options.hpp).
struct SmokeOptions {
  std::uint32_t voxels = 1800;
  float bloom = 1.0f;
  float hold = 18.0f;
  float dissolve = 3.0f;
  float extinction = 3.0f;
  glm::vec3 albedo{0.92f};
  float anisotropy = 0.2f;
  std::optional<float> droplet;  ///< Overrides anisotropy when set.
  float multiple_scattering = 1;
  float erosion = 0.5f;
  float noise_size = 1.5f;
  float detail = 1;
  float hole_rim = 0.06f;
  float swirl = 0.2f;
  float swirl_period = 12.0f;
  float rise = 0.12f;
  bool operator==(const SmokeOptions&) const = default;
};

}  // namespace brume::scene
