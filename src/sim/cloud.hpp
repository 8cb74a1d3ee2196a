// One smoke: the voxels it fills and its density in each of them at any tick.
//
//             bloom_ticks      hold_ticks             dissolve_ticks
//   off |------------------|------------------|------------------------| nothing remains
//       the front expands    steady             thins in patches, by noise and distance
//
// When the level is edited the cloud flows again (Cloud::flowed): the flood from its source is repeated;
// smoke cut off from the source stays in place and counts against the amount; each voxel gained receives,
// when the flow reaches it, the smoke of the farthest voxel lost.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/block_set.hpp"
#include "sim/events.hpp"
#include "sim/fill.hpp"
#include "sim/fill_values.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::sim {

/// Distance of a cloud's front, in 1/256 chamfer units.
using Front = std::uint64_t;
constexpr Front kFrontUnit = 256;

/// Where and when a smoke starts; everything else follows from this and the level.
struct CloudOrigin {
  glm::ivec3 source{0};  ///< The voxel where the grenade detonated.
  SmokeSettings settings;
  std::uint32_t detonation_tick = 0;
  bool operator==(const CloudOrigin&) const = default;
};

/// The complete state of a cloud, as serialized. The rest of a Cloud is derived from it.
struct CloudParts {
  CloudOrigin origin;
  BlockSet fill;      ///< Voxels that the flood from the source reached: connected, source included.
  BlockSet detached;  ///< Other voxels with smoke from before an edit: trapped, or flowing off.
  /// When it last began to flow; 0 when it never did or has settled.
  std::uint32_t flow_tick = 0;
  /// By rank in `fill`, empty when flow_tick = 0: density at flow_tick, and 1 + the ticks from flow_tick
  /// until the voxel starts to change to its new density; 0: it has that density at once.
  std::vector<std::uint8_t> fill_base;
  std::vector<std::uint16_t> fill_delay;
  /// By rank in `detached`: density at flow_tick; 1 + the ticks until the smoke starts to leave, or 0: it is
  /// trapped and stays; Cloud::survival.
  std::vector<std::uint8_t> detached_base;
  std::vector<std::uint16_t> detached_delay;
  std::vector<std::uint8_t> detached_survival;
  bool operator==(const CloudParts&) const = default;
};

/// The time-dependent input of a cloud's densities at one tick: equal phases give equal densities.
struct CloudPhase {
  Front front = 0;              ///< 0: no smoke yet.
  std::uint32_t dissolved = 0;  ///< Elapsed fraction of the dissolve, [0, 65536].
  std::uint32_t flowed = 0;     ///< Ticks since flow_tick, clamped at the settle tick.
  bool operator==(const CloudPhase&) const = default;
};

class Cloud {
 public:
  /// Floods the grid from the source. The cloud has no voxel when the source is not free.
  Cloud(const voxel::BitGrid& grid, const CloudOrigin& origin);

  /// From untrusted, received parts. Fails with bad_input when they are inconsistent: numbers out of range, a
  /// fill that is disconnected or lacks its source, overlapping sets, lists of the wrong length. Distances
  /// equal the flood's that made the fill, because its shortest paths run through the fill only.
  static Result<Cloud> from_parts(CloudParts parts);

  /// Whether an edit of the level changes where this smoke is or can flow.
  bool touched_by(std::span<const EditBlock> edits) const;
  /// The cloud after a level edit that takes effect at `tick`; `grid` is the edited level. It flows into the
  /// voxels gained at half the mean speed of its bloom, nearest first.
  Cloud flowed(const voxel::BitGrid& grid, std::uint32_t tick) const;
  /// The settled cloud, without the voxels that smoke has left. Equal densities from settle_tick() on.
  Cloud settled() const;

  const CloudParts& parts() const { return parts_; }
  const CloudOrigin& origin() const { return parts_.origin; }
  /// Every voxel that may hold smoke at some tick: fill and detached.
  const BlockSet& voxels() const { return parts_.detached.empty() ? parts_.fill : all_voxels_; }
  /// Per-axis minimum and maximum of the voxels; empty clouds: low > high.
  glm::ivec3 low() const { return voxels().low(); }
  glm::ivec3 high() const { return voxels().high(); }
  /// The tick at which the last smoke is gone.
  std::uint32_t end_tick() const;
  /// The tick at which it settles after an edit; nothing when it is not flowing.
  std::optional<std::uint32_t> settle_tick() const;

  /// Amount of smoke released by a tick, in voxels / 2^20. Rises from the detonation, fastest after a quarter
  /// of the bloom, to the whole amount after bloom_ticks, then stays constant.
  std::uint64_t amount(std::uint32_t tick) const;
  CloudPhase phase(std::uint32_t tick) const;
  /// The phase without the dissolve.
  CloudPhase undissolved_phase(std::uint32_t tick) const;
  /// Density in [0, 255] of the voxel with this rank in voxels().
  std::uint8_t density(std::uint32_t rank, const CloudPhase& phase) const;
  /// The density of any voxel; 0 outside voxels().
  std::uint8_t density(glm::ivec3 voxel, const CloudPhase& phase) const;

  /// Density in [0, 255] at this distance behind a front: 0 at and beyond the front, 255 at the taper's
  /// length behind it and farther, linear in between. The taper is a third of the front's distance, at least
  /// two voxels, so that the rim fades in open air while walls, which the fill reaches early, get full
  /// density.
  static std::uint8_t profile(std::uint32_t distance, Front front);
  static Front taper(Front front) { return std::max<Front>(2 * kFaceStep * kFrontUnit, front / 3); }

  static constexpr std::uint32_t kNoDistance = ~std::uint32_t{0};
  /// Front distance at which smoke reaches a voxel, by rank in voxels(): its own distance plus up to a
  /// quarter, so that the cloud bulges in lobes. kNoDistance for parts().detached.
  std::uint32_t reach(std::uint32_t rank) const {
    const std::uint32_t distance = distances_[rank];
    if (distance == kNoDistance) return kNoDistance;
    return reach_of(distance, lag_[rank]);
  }
  /// Geodesic distance from the source by rank in voxels(); kNoDistance for parts().detached.
  std::span<const std::uint32_t> distances() const { return distances_; }
  /// How long a voxel's smoke withstands the dissolve, [0, 255], by rank in voxels(): decreases with distance
  /// from the source, varied by noise.
  std::span<const std::uint8_t> survival() const { return survival_; }

  /// Hash of all parts and everything derived from them.
  std::uint64_t hash() const { return hash_; }
  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  Cloud() = default;
  void finish(FillValues fill, std::vector<Flood::Count> counts);
  std::uint64_t content_hash() const;
  /// Ticks a voxel takes to change to its new density.
  std::uint32_t flow_ramp() const { return std::max(1u, parts_.origin.settings.bloom_ticks / 4); }
  Front front(std::uint32_t tick) const;
  /// The front that an amount released, less the voxels trapped, reaches by the distances of a flood.
  static Front front_of(std::uint64_t out, std::uint32_t trapped_voxels,
                        std::span<const Flood::Count> counts);

  CloudParts parts_;
  BlockSet all_voxels_;  // fill and detached; empty when nothing is detached
  std::vector<std::uint32_t> distances_;
  std::vector<std::uint8_t> survival_;
  std::vector<std::uint8_t> lag_;     // fraction of the distance, / 2^kLagBits
  std::vector<std::uint8_t> base_;    // fill_base and detached_base by rank in voxels(); empty without both
  std::vector<std::uint16_t> delay_;  // the same for fill_delay and detached_delay
  std::uint32_t trapped_ = 0;         // number of detached voxels that stay
  std::vector<Flood::Count> distance_counts_;  // how many voxels of the fill have each distance
  std::uint32_t flow_length_ = 0;              // ticks from flow_tick to settle_tick()
  std::uint64_t hash_ = 0;
};

}  // namespace brume::sim
