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
#include "textures/smoky_brick.hpp"

namespace brume::textures {

/// A light, as rays to it need it.
struct Light {
  bool directional = false;
  glm::vec3 at_world{0};  ///< Its position, or the unit vector towards it.
  bool operator==(const Light&) const = default;
};

/// What light meets at a time.
struct LitSmoke {
  const smoke::SmokeVolume* volume = nullptr;
  const smoke::Sight* sight = nullptr;           ///< Sees the walls of a level
  std::shared_ptr<const sim::EditBlocks> edits;  ///< with these edits.
  std::span<const shared::Hole> holes;           ///< Open ones.
  const smoke::MaskAtlas* masks = nullptr;
  shared::SmokeLook look{};  ///< With its extinction.
  float seconds = 0;
  std::span<const Light> lights;
};

class LightVolume {
 public:
  static constexpr std::uint32_t kMostLights = 15;
  /// For at most `light_count` lights, up to kMostLights, and the sky or not.
  LightVolume(std::uint32_t light_count, bool sky);

  /// Groups of four bytes of a texel: two lights each, the sky counts as the last light.
  std::uint32_t groups() const { return groups_; }

  /// Follows the smoke in all bricks that have any: brings `fraction` of the texels up to date, in turn, and
  /// those that smoke has come near.
  void update(const LitSmoke& smoke, std::span<const SmokyBrick> smoky, float fraction);
  /// The texels of a group of a slot that held smoke in the last update; 0 where no shader reads them.
  std::span<const glm::u8vec4> texels(std::uint32_t slot, std::uint32_t group) const;

 private:
  struct Brick {
    glm::ivec3 brick{0};
    smoke::TexelSet read, lit;  // texels that shaders may read, and the lit ones among them
    std::array<float, shared::kTexelsPerBrick>
        retained;                                        // fraction of the density that noise and holes leave
    std::array<float, shared::kTexelsPerBrick> density;  // for light: filtered, into the walls, too
    std::vector<glm::u8vec4> texels;                     // by group
    // A bit for each light, then for each ray to the sky: whether walls let it through, where that is known.
    std::array<std::uint32_t, shared::kTexelsPerBrick> known, seen;
  };
  /// The texels that an update is for: those of some phases (shared/smoke_light.h).
  struct Phases {
    std::uint32_t first = 0, count = 0;
    bool has(std::uint32_t phase) const;
  };

  /// Whether an update lights a texel.
  static bool is_due(const Brick& brick, std::uint32_t texel, const Phases& phases);
  void follow_bricks(const smoke::SmokeVolume& volume, std::span<const SmokyBrick> smoky);
  void forget_walls(const LitSmoke& smoke);
  static void find_read(Brick& brick, smoke::TexelSet smoke);
  float remaining(const LitSmoke& smoke, float density, glm::vec3 p_world, glm::vec3 displacement) const;
  void find_retained(const LitSmoke& smoke, Brick& brick, const SmokyBrick& from, const Phases& phases) const;
  void find_density(const LitSmoke& smoke, Brick& brick, std::uint32_t slot) const;
  void light(const LitSmoke& smoke, Brick& brick, const Phases& phases) const;
  float density_at(const LitSmoke& smoke, glm::vec3 p_voxel, bool& empty) const;
  float depth(const LitSmoke& smoke, glm::vec3 p_voxel, glm::vec3 direction, float reach_m,
              float coarse) const;
  /// A texel of a brick that is lit.
  struct Place {
    Brick& brick;
    std::uint32_t texel;
    glm::vec3 p_voxel, p_world;
  };
  static bool is_seen(const LitSmoke& smoke, const Place& from, glm::vec3 to_world, std::uint32_t bit);
  glm::u8vec2 light_texel(const LitSmoke& smoke, const Place& place, std::uint32_t light) const;
  glm::u8vec2 sky_texel(const LitSmoke& smoke, const Place& place) const;

  std::uint32_t light_count_;
  bool sky_;
  std::uint32_t groups_;
  std::uint32_t turn_ = 0;                      // phase of the next update
  std::vector<std::unique_ptr<Brick>> bricks_;  // by slot
  // What walls were remembered for.
  std::shared_ptr<const sim::EditBlocks> edits_;
  std::vector<Light> lights_;
};

}  // namespace brume::textures
