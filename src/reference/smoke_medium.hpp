// The smoke of a frame as a medium.
#pragma once

#include <functional>

#include "reference/medium.hpp"
#include "smoke/drawn_smoke.hpp"

namespace brume::reference {

class SmokeMedium final : public Medium {
 public:
  /// As a DrawnSmoke.
  SmokeMedium(const smoke::SmokeInput& smoke, const std::function<const smoke::SmokeNoise&()>& noise,
              const smoke::MaskAtlas* masks);

  float extinction(const glm::vec3& p_world) const override { return look().extinction * density(p_world); }
  glm::vec3 albedo(const glm::vec3&) const override { return look().albedo; }
  glm::vec3 emission(const glm::vec3&) const override { return glm::vec3(0); }

  /// After erosion and holes.
  float density(const glm::vec3& p_world) const { return smoke_.density(p_world); }

 private:
  const shared::SmokeLook& look() const { return smoke_.input().look; }
  void find_majorants();

  smoke::DrawnSmoke smoke_;
};

}  // namespace brume::reference
