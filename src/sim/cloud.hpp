// One smoke: the voxels that it fills, and how dense it is in each at any tick.
//
//             bloom_ticks      hold_ticks             dissolve_ticks
//   off |------------------|------------------|------------------------| nothing left
//       the front runs out   nothing changes    eaten from the edges, by distance and noise
//
// An edit of the level lets it flow on (Cloud::flowed): the nearest voxels are found anew from its source;
// what is cut off from it stays where it is and counts; each voxel gained takes, when the flow gets there,
// what the farthest of the voxels lost gives up.
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
#include "voxel/bit_grid.hpp"

namespace brume::sim {

/// Distance of a cloud's front: chamfer units / 256.
using Front = std::uint64_t;
constexpr Front kFrontUnit = 256;

/// Where a smoke comes from; all else follows from it and the level.
struct CloudOrigin {
  glm::ivec3 source{0};  ///< A voxel; where the grenade went off.
  SmokeSettings settings;
  std::uint32_t detonation_tick = 0;
  bool operator==(const CloudOrigin&) const = default;
};

/// All of a cloud's state, as it travels. The rest of a Cloud is computed from it.
struct CloudParts {
  CloudOrigin origin;
  BlockSet fill;  ///< Voxels that the flood from the source reached: connected, with the source.
  BlockSet detached;  ///< Other voxels that hold smoke of before an edit: trapped, or flowing off.
  /// When it began to flow on; 0 when it never did or has come to rest.
  std::uint32_t flow_tick = 0;
  /// By rank in `fill`, empty when flow_tick = 0: density at flow_tick, and ticks after flow_tick until the
  /// voxel turns to its new density, + 1; 0: it has it at once.
  std::vector<std::uint8_t> fill_base;
  std::vector<std::uint16_t> fill_delay;
  /// By rank in `rest`: density at flow_tick; ticks until it begins to leave, + 1, or 0: it is trapped and
  /// stays; Cloud::survival.
  std::vector<std::uint8_t> detached_base;
  std::vector<std::uint16_t> detached_delay;
  std::vector<std::uint8_t> detached_survival;
  bool operator==(const CloudParts&) const = default;
};

/// What a cloud's densities depend on besides its voxels, at one tick: equal moments, equal densities.
struct CloudPhase {
  Front front = 0;              ///< 0: nothing is out.
  std::uint32_t dissolved = 0;  ///< Fraction of the dissolve that is over, of 65536.
  std::uint32_t flowed = 0;     ///< Ticks since flow_tick, at most until it has come to rest.
  bool operator==(const CloudPhase&) const = default;
};

class Cloud {
 public:
  /// Floods the grid from the source. The cloud has no voxel when the source is not free.
  Cloud(const voxel::BitGrid& grid, const CloudOrigin& origin);

  /// From what travelled; it may come from anywhere. Fails with bad_input when the parts contradict each
  /// other: numbers out of range, a fill that is not connected or without its source, sets that overlap,
  /// lists of the wrong length. Distances are those of the flood that made the fill: its shortest ways run
  /// through voxels of the fill only.
  static Result<Cloud> from_parts(CloudParts parts);

  /// Whether an edit of the level changes where this smoke is or can go.
  bool touched_by(std::span<const EditBlock> edits) const;
  /// The cloud after an edit of the level that is in effect from `tick` on. Where it gains voxels it flows in
  /// at half the mean pace of its bloom, from the first one gained on.
  Cloud flowed(const voxel::BitGrid& grid, std::uint32_t tick) const;
  /// The same cloud at rest: what flowed off is forgotten. Equal densities from settle_tick() on.
  Cloud settled() const;

  const CloudParts& parts() const { return parts_; }
  const CloudOrigin& origin() const { return parts_.origin; }
  /// Every voxel in which there may be smoke at some tick: fill and rest.
  const BlockSet& voxels() const { return parts_.detached.empty() ? parts_.fill : both_; }
  /// Low corner of the lowest and high corner of the highest voxel; empty clouds: low > high.
  glm::ivec3 low() const { return voxels().low(); }
  glm::ivec3 high() const { return voxels().high(); }
  /// When the last smoke is gone.
  std::uint32_t end_tick() const;
  /// When it has come to rest after an edit; nothing when it is at rest.
  std::optional<std::uint32_t> settle_tick() const;

  /// Amount of smoke that is out at a tick, in voxels / 2^20. Rises from the detonation, fastest after a
  /// quarter of the bloom, to the whole budget after bloom_ticks, then stays.
  std::uint64_t amount(std::uint32_t tick) const;
  CloudPhase phase(std::uint32_t tick) const;
  /// The same as if it never dissolved.
  CloudPhase undissolved_phase(std::uint32_t tick) const;
  /// Density in [0, 255] of the voxel with this rank in voxels().
  std::uint8_t density(std::uint32_t rank, const CloudPhase& phase) const;
  /// The density of any voxel; 0 where the cloud never is.
  std::uint8_t density(glm::ivec3 voxel, const CloudPhase& phase) const;

  /// Density in [0, 255] where smoke arrives with a front at this distance: 0 at and beyond the front, 255
  /// from a taper before it, even between them. The taper is a third of the front, at least two voxels, so
  /// that the rim fades in open air while walls, which the fill reaches early, see full density.
  static std::uint8_t profile(std::uint32_t distance, Front front);

  static constexpr std::uint32_t kNoDistance = ~std::uint32_t{0};
  /// How far the front must have come for a voxel's smoke to be there, by rank in voxels(): its distance and
  /// up to a quarter more, so that the cloud bulges in lobes. kNoDistance for those of parts().detached.
  std::uint32_t reach(std::uint32_t rank) const {
    const std::uint32_t distance = distances_[rank];
    if (distance == kNoDistance) return kNoDistance;
    return distance + static_cast<std::uint32_t>((std::uint64_t{distance} * lag_[rank]) >> kLagBits);
  }
  /// Distance from the source by rank in voxels(); kNoDistance for those of parts().detached.
  std::span<const std::uint32_t> distances() const { return distances_; }
  /// How long a voxel's smoke withstands the dissolve, of 255, by rank in voxels(): less far from the source,
  /// and by noise.
  std::span<const std::uint8_t> survival() const { return survival_; }

  /// Hash of all parts and all that was computed from them.
  std::uint64_t hash() const { return hash_; }
  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  Cloud() = default;
  void finish(std::span<const FilledVoxel> filled);
  std::uint64_t content_hash() const;
  /// Ticks that a voxel takes to turn to its new density.
  std::uint32_t flow_ramp() const { return std::max(1u, parts_.origin.settings.bloom_ticks / 4); }
  Front front(std::uint32_t tick) const;

  /// Distinct distances in rising order, and how many fill voxels lie within each.
  struct Level {
    std::uint32_t distance;
    std::uint64_t count;
  };

  CloudParts parts_;
  BlockSet both_;  // fill and rest, where there is a rest
  std::vector<std::uint32_t> distances_;
  std::vector<std::uint8_t> survival_;
  static constexpr int kLagBits = 10;
  std::vector<std::uint8_t> lag_;   // of the distance, / 2^kLagBits
  std::vector<std::uint8_t> base_;  // of fill and rest, by rank in voxels(); empty when there are none
  std::vector<std::uint16_t> delay_;
  std::uint32_t trapped_ = 0;  // voxels of the rest that stay
  std::vector<Level> levels_;
  std::uint32_t flow_length_ = 0;  // ticks from flow_tick to rest
  std::uint64_t hash_ = 0;
};

}  // namespace brume::sim
