// The cavity of an explosion: which voxels it reaches and how much smoke remains in them at any tick.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/block_set.hpp"
#include "sim/events.hpp"
#include "sim/walk.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::sim {

/// Remaining fraction of density, of 255, at one tick by BlastField::reach. Equal profiles, equal effect.
struct BlastProfile {
  std::array<std::uint8_t, 256> remaining;
  bool operator==(const BlastProfile&) const = default;
};

class BlastField {
 public:
  /// Finds the free voxels within the radius whose centres are visible from the blast: no solid voxel on the
  /// straight line. A blast inside a solid voxel detonates in the nearest free voxel.
  BlastField(const voxel::BitGrid& grid, const Blast& blast, std::uint32_t ticks_per_second);
  /// From received parts. Fails with bad_input when a voxel lies beyond the radius.
  static Result<BlastField> from_parts(const voxel::GridLayout& layout, const Blast& blast, Position centre,
                                       BlockSet reached, std::uint32_t ticks_per_second);

  const Blast& event() const { return event_; }
  /// Where it detonates: event().at, or the centre of the free voxel that replaced it.
  Position centre() const { return centre_; }
  const BlockSet& reached() const { return reached_; }
  /// Distance from the centre by rank in reached(): 0 there, 255 at the radius.
  std::span<const std::uint8_t> reach() const { return reach_; }
  /// The tick at which the cavity has refilled.
  std::uint32_t end_tick() const { return end_tick_; }

  BlastProfile profile(std::uint32_t tick) const;
  /// Remaining fraction of density in a voxel, of 255; 255 where the blast does not reach.
  std::uint8_t remaining(glm::ivec3 voxel, const BlastProfile& profile) const {
    const std::uint32_t rank = reached_.rank(voxel);
    return rank == BlockSet::kNone ? 255 : profile.remaining[reach_[rank]];
  }

  std::uint64_t hash() const { return hash_; }
  std::uint64_t bytes() const { return reached_.bytes() + reach_.size(); }

 private:
  BlastField() = default;
  void finish(const voxel::GridLayout& layout);
  std::uint64_t arrival_ms(std::uint32_t reach) const;
  std::uint64_t refill_ms(std::uint32_t reach) const;

  Blast event_;
  Position centre_{0};
  std::uint32_t ticks_per_second_ = 0, end_tick_ = 0;
  BlockSet reached_;
  std::vector<std::uint8_t> reach_;
  std::uint64_t hash_ = 0;
};

}  // namespace brume::sim
