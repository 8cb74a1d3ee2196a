// What of each light and of the sky reaches the smoke, texel by texel of its bricks, found on the CPU.
//
// Two bytes for each light: v with an optical depth of the smoke of -4 ln(v / 255), which keeps deep smoke
// apart and is almost linear between texels, and how much of the light walls let through. Two bytes for the
// sky, means over all directions: what passes the smoke, and that times the sky's radiance
// (shared/sky_light.h) where no wall hides it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "shared/frame.h"
#include "shared/hole.h"
#include "smoke/mask_atlas.hpp"
#include "smoke/noise_tile.hpp"
#include "smoke/sight.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::textures {

/// A light, as rays to it need it.
struct Light {
  bool directional = false;
  glm::vec3 at_world{0};  ///< Its position, or the unit vector towards it.
};

/// What light meets at a time.
struct LitSmoke {
  const smoke::SmokeVolume* volume = nullptr;
  const smoke::Sight* sight = nullptr;  ///< Sees the level's walls.
  std::span<const shared::Hole> holes;  ///< Open ones.
  const smoke::MaskAtlas* masks = nullptr;
  shared::SmokeLook look{};  ///< With its extinction.
  float seconds = 0;
  std::span<const Light> lights;
};

class LightVolume {
 public:
  /// For at most `light_count` lights, and the sky or not.
  LightVolume(std::uint32_t light_count, bool sky);

  /// Groups of four bytes of a texel: two lights each, the sky counts as the last light.
  std::uint32_t groups() const { return groups_; }

  /// The displacement of the noise in a slot at each texel, or at every other one along each axis [m].
  using Displacements = std::span<const glm::u16vec4>;

  /// Follows the smoke: brings `fraction` of the texels up to date, in turn, and all of the bricks that are
  /// new. `slots` hold smoke; `displacements` are theirs, or empty where there are none.
  void update(const LitSmoke& smoke, std::span<const std::uint32_t> slots,
              std::span<const Displacements> displacements, float fraction);
  /// The texels of a group of a slot after an update that brought any of them up to date.
  std::span<const glm::u8vec4> texels(std::uint32_t slot, std::uint32_t group) const;

 private:
  struct Brick {
    glm::ivec3 brick{0};
    bool fresh = true;  // no texel has been lit
    std::array<float, shared::kTexelsPerBrick>
        retained;                                        // fraction of the density that noise and holes leave
    std::array<float, shared::kTexelsPerBrick> density;  // for light: filtered, into the walls, too
    std::vector<glm::u8vec4> texels;                     // by group
  };
  /// The texels that an update is for: those of some phases (shared/smoke_light.h).
  struct Phases {
    std::uint32_t first = 0, count = 0;
    bool has(std::uint32_t phase) const;
  };

  float remaining(const LitSmoke& smoke, float density, glm::vec3 p_world, glm::vec3 displacement) const;
  void find_retained(const LitSmoke& smoke, Brick& brick, std::uint32_t slot, Displacements displacements,
                     const Phases& phases) const;
  void find_density(const LitSmoke& smoke, Brick& brick, std::uint32_t slot) const;
  void light(const LitSmoke& smoke, Brick& brick, const Phases& phases) const;
  float density_at(const LitSmoke& smoke, glm::vec3 p_voxel, bool& empty) const;
  float depth(const LitSmoke& smoke, glm::vec3 p_voxel, glm::vec3 direction, float reach_m,
              float coarse) const;
  glm::u8vec2 light_texel(const LitSmoke& smoke, glm::vec3 p_voxel, const Light& light) const;
  glm::u8vec2 sky_texel(const LitSmoke& smoke, glm::vec3 p_voxel) const;

  std::uint32_t light_count_;
  bool sky_;
  std::uint32_t groups_;
  std::uint32_t turn_ = 0;                      // phase of the next update
  std::vector<std::unique_ptr<Brick>> bricks_;  // by slot
};

}  // namespace brume::textures
