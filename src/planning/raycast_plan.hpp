// What a frame of raycast volumes needs to be drawn: spaces, steps and order. No device.
#pragma once

#include <span>
#include <vector>

#include "planning/media_plan.hpp"
#include "shared/frame.h"
#include "shared/raycast.h"

namespace brume::planning {

/// One directional light, and light from all directions.
struct RaycastLight {
  glm::vec3 to_sun{0, 1, 0};    ///< Unit.
  glm::vec3 sun_irradiance{0};  ///< On a surface that faces the sun.
  glm::vec3 ambient{0};         ///< Mean radiance.
  shared::Phase phase = shared::phase_of_hg(0);
};

/// Lengths are in metres along the normalized ray. Where the samples of a ray at that length do not reach
/// across the longest diagonal of a volume, its steps are longer, so that they do.
struct RaycastSteps {
  float length = 0;                          ///< Step of view rays; 0: half the shortest edge of the voxels.
  std::uint32_t samples = 1024;              ///< Per view ray and volume, >= 2.
  float light_length = 0;                    ///< Step of light rays; 0: twice that edge.
  std::uint32_t light_samples = 64;          ///< Per light ray, >= 1.
  float opaque_transmittance = 1.0f / 1024;  ///< Below it a ray is opaque; [0, 1].
};

struct RaycastPlan {
  shared::RaycastView view{};
  std::vector<shared::RaycastVolume> volumes;  ///< As the instances.
  /// The box of a volume, back to front by the distance of their middles: right where boxes do not overlap.
  struct Box {
    std::uint32_t volume = 0;
    bool mirrored = false;  ///< Front faces are wound as back faces.
    bool around_eye = false;
  };
  std::vector<Box> boxes;
};

/// The camera is device_camera's. Throws bad_input for a transform without an inverse.
RaycastPlan plan_raycast(const shared::Camera& camera, glm::uvec2 size_px,
                         std::span<const PlacedVolume> volumes, const RaycastLight& light,
                         const RaycastSteps& steps);

}  // namespace brume::planning
