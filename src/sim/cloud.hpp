// One smoke: the voxels that it fills, and how dense it is in each at any tick.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "sim/fill.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::sim {

struct SmokeSettings {
  std::uint32_t voxels = 1800;     ///< Amount of smoke: voxels that it fills, [1, kMaxFillVoxels].
  std::uint32_t bloom_ticks = 64;  ///< From the detonation to the full amount [ticks], at least 1.
};

/// Distance of a cloud's front: chamfer units / 256.
using Front = std::uint64_t;
constexpr Front kFrontUnit = 256;

class Cloud {
 public:
  /// Floods the grid from `source`. The cloud has no voxel when `source` is not free.
  Cloud(const voxel::BitGrid& grid, glm::ivec3 source, const SmokeSettings& settings,
        std::uint32_t detonation_tick);

  /// All voxels that the cloud ever reaches, by (distance, index).
  std::span<const FilledVoxel> voxels() const { return voxels_; }
  std::uint32_t detonation_tick() const { return detonation_tick_; }
  /// Low corner of the lowest and high corner of the highest voxel; empty clouds: low > high.
  glm::ivec3 low() const { return low_; }
  glm::ivec3 high() const { return high_; }

  /// Amount of smoke that is out at a tick, in voxels / 2^20. Rises from the detonation, fastest early, to
  /// the whole budget after bloom_ticks, then stays.
  std::uint64_t amount(std::uint32_t tick) const;

  /// How far the smoke has come at a tick: never falls, rises with each tick of the bloom, and the
  /// amount's nearest voxels lie within it. Where the cloud has filled all that it can reach the front goes
  /// on as before: what no longer fits makes the rim denser.
  Front front(std::uint32_t tick) const;

  /// Density in [0, 255] at a distance from the source for a front: 0 at and beyond the front, 255 from a
  /// taper before it; between them a smoothstep. The taper is a quarter of the front, at least two voxels, so
  /// that the rim fades in open air while walls, which the fill reaches early, see full density.
  static std::uint8_t density_at(std::uint32_t distance, Front front);

  /// The distance of a voxel from the source, where the cloud reaches it.
  std::optional<std::uint32_t> distance(glm::ivec3 voxel) const;

  /// Hash of the source, the settings and every filled voxel.
  std::uint64_t hash() const { return hash_; }

 private:
  void keep_distances();

  /// Distinct distances in rising order, and how many voxels lie within each.
  struct Level {
    std::uint32_t distance;
    std::uint64_t count;
  };

  SmokeSettings settings_;
  std::uint32_t detonation_tick_;
  std::vector<FilledVoxel> voxels_;
  std::vector<Level> levels_;
  std::unordered_map<std::uint64_t, std::uint32_t> brick_of_;  // brick coordinates -> into bricks_
  std::vector<std::array<std::uint32_t, 512>> bricks_;         // distance + 1 of each voxel, or 0
  glm::ivec3 low_{0}, high_{-1};
  std::uint64_t hash_ = 0;
};

}  // namespace brume::sim
