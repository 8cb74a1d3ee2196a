// The smoke of a frame as a medium.
#pragma once

#include <functional>
#include <vector>

#include "planning/frame_input.hpp"
#include "reference/medium.hpp"
#include "smoke/mask_atlas.hpp"
#include "smoke/noise_tile.hpp"

namespace brume::reference {

/// Density, erosion and holes by the headers that the shaders share.
class SmokeMedium final : public Medium {
 public:
  /// `smoke` has a volume; it and what it points to, the noise and the masks must outlive the medium. Asks
  /// for the noise if it needs any.
  SmokeMedium(const planning::SmokeInput& smoke, const std::function<const smoke::SmokeNoise&()>& noise,
              const smoke::MaskAtlas* masks);

  float extinction(const glm::vec3& p_world) const override {
    return input_.look.extinction * density(p_world);
  }
  glm::vec3 albedo(const glm::vec3&) const override { return input_.look.albedo; }
  glm::vec3 emission(const glm::vec3&) const override { return glm::vec3(0); }

  /// After erosion and holes.
  float density(const glm::vec3& p_world) const;

 private:
  /// Noise at a point.
  struct Noise {
    glm::vec4 tile{0.5f};
    glm::vec2 detail{0};
  };
  Noise noise_at(const glm::vec3& p_world, const glm::vec3& p_voxel, std::uint32_t slot,
                 const glm::ivec3& brick, float density) const;
  void find_majorants();
  void find_holes();

  const planning::SmokeInput& input_;
  const smoke::MaskAtlas* masks_;
  const smoke::SmokeNoise* noise_ = nullptr;          // null: none is needed
  std::vector<glm::vec3> displacements_;              // of the noise, by slot and texel; empty: none
  std::vector<std::vector<std::uint32_t>> holes_of_;  // by slot: those that may reach its brick
};

}  // namespace brume::reference
