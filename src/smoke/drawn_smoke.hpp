// Smoke as it is drawn at a time: eroded by its noise, with detail of full weight, and cut by holes with
// frayed rims, by the headers that the shaders share. The same bits on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "smoke/mask_atlas.hpp"
#include "smoke/noise_displacement.hpp"
#include "smoke/noise_tile.hpp"
#include "smoke/smoke_input.hpp"

namespace brume::smoke {

/// Safe for several threads at once.
class DrawnSmoke {
 public:
  /// `input` has a volume. What it points to, the noise and the masks must outlive this and stay as they are.
  /// Asks for the noise if it needs any; `masks` may be null where no hole is one.
  DrawnSmoke(const SmokeInput& input, const std::function<const SmokeNoise&()>& noise,
             const MaskAtlas* masks);

  /// At a point; 1: as dense as smoke is before erosion.
  float density(const glm::vec3& p_world) const;

  /// The integral of density over a straight line [m], by its midpoints every kLineStep. Once it is above
  /// `enough` it may stop: the result is then only known to be above that.
  float integral(const glm::dvec3& a_world, const glm::dvec3& b_world, float enough) const;

  /// At most so far apart are the points of a line, in widths of a texel of detail.
  static constexpr double kLineStep = 2;

  const SmokeInput& input() const { return input_; }

 private:
  struct Noise {
    glm::vec4 tile{0.5f};
    glm::vec2 detail{0};
  };
  using BrickDisplacement = std::array<glm::vec3, shared::kTexelsPerBrick>;
  /// The displacement of the noise in one brick, from its first use on.
  struct LazyDisplacement {
    std::once_flag found;
    std::unique_ptr<BrickDisplacement> texels;
  };

  Noise noise_at(const glm::vec3& p_world, const glm::vec3& p_voxel, std::uint32_t slot, float density) const;
  const BrickDisplacement& displacement(std::uint32_t slot) const;
  void find_holes();

  SmokeInput input_;
  const MaskAtlas* masks_;
  const SmokeNoise* noise_ = nullptr;                  // null: none is needed
  std::optional<NoiseDisplacement> advection_;         // none: the noise only rises
  std::unique_ptr<LazyDisplacement[]> displacements_;  // by slot
  std::vector<std::vector<std::uint32_t>> holes_of_;   // by slot: those that may reach its brick
};

}  // namespace brume::smoke
