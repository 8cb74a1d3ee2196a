// Where the smoke of a state comes from and what takes it away, its clouds and its sinks, and which of them
// came, went or changed since the state before.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/state.hpp"
#include "smoke/smoke_brick.hpp"

namespace brume::smoke {

/// Ticks from `first` to `last`; none when first > last.
struct TickSpan {
  std::uint32_t first = 1, last = 0;
};

/// The least and the greatest reach of the voxels of a block.
struct ReachSpan {
  std::uint32_t nearest = 0, farthest = 0;
};

/// A cloud, as the last update saw it.
struct SmokeSource {
  std::uint32_t id = 0;
  std::shared_ptr<const sim::Cloud> cloud;
  std::optional<sim::CloudPhase> phase;      ///< None before the first update.
  std::vector<std::uint32_t> slot_of_block;  ///< For each block of its voxels.
  std::vector<ReachSpan> reach_of_block;     ///< The same.
  std::vector<std::uint32_t> slots;          ///< All bricks around it, each once.
  TickSpan steady;                           ///< When its phase is known not to change.

  /// By rank, at the phase; computed when they are read. One thread at a time.
  std::span<const std::uint8_t> densities() const;

 private:
  mutable std::vector<std::uint8_t> densities_;
  mutable std::optional<sim::CloudPhase> densities_at_;
  friend class SmokeSources;
};

/// A cavity in the smoke, as the last update saw it.
struct SmokeSink {
  std::uint32_t id = 0;
  std::shared_ptr<const sim::BlastField> field;
  sim::BlastProfile profile{};
  std::vector<glm::ivec3> bricks;  ///< Where it reaches, each once.
};

/// A cloud's blocks in one brick.
struct CloudPart {
  const SmokeSource* source;
  BrickBlocks blocks;
};
/// A sink's blocks in one brick.
struct SinkPart {
  const SmokeSink* sink;
  BrickBlocks blocks;
};

/// No block at all.
BrickBlocks no_blocks();
/// The voxels that a cloud has at some tick.
BrickBits voxels_of(std::span<const CloudPart> clouds);
/// What the clouds add up to, at most 255, and the sinks leave of it one after the other.
BrickDensities densities_of(std::span<const CloudPart> clouds, std::span<const SinkPart> sinks);
/// Inserts the part of the brick that the sink reaches, if any, by rising id.
void add_sink_part(glm::ivec3 brick, const SmokeSink& sink, std::vector<SinkPart>& parts);

/// The bricks, sorted, that hold a voxel of the cloud or are within two voxels of one: a surface may run that
/// far beyond the smoke.
std::vector<glm::ivec3> bricks_around(const sim::Cloud& cloud);

class SmokeSources {
 public:
  template <typename Source>
  struct Exchange {
    std::vector<Source*> added;                    ///< By id; held from now on.
    std::vector<std::unique_ptr<Source>> removed;  ///< By id.
    bool any() const { return !added.empty() || !removed.empty(); }
  };
  /// Takes over the clouds of a state. Clouds with the same id and content stay the same source.
  Exchange<SmokeSource> take_clouds(const sim::State& state);
  /// Takes over the sinks of a state, likewise.
  Exchange<SmokeSink> take_sinks(const sim::State& state);

  /// Brings clouds and sinks to a tick. Appends the clouds with another phase, the slots in which their
  /// densities may differ, and the bricks in which sinks changed; both with repeats.
  void advance_to(std::uint32_t tick, std::vector<const SmokeSource*>& moved,
                  std::vector<std::uint32_t>& slots, std::vector<glm::ivec3>& bricks);

  /// By id.
  std::span<const std::unique_ptr<SmokeSource>> clouds() const { return clouds_; }
  std::span<const std::unique_ptr<SmokeSink>> sinks() const { return sinks_; }

  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  static bool advance_cloud(SmokeSource& source, std::uint32_t tick, std::vector<std::uint32_t>& slots);

  std::vector<std::unique_ptr<SmokeSource>> clouds_;  // by id
  std::vector<std::unique_ptr<SmokeSink>> sinks_;     // by id
  // What each tick reads of all clouds, in one piece: what the state had, and whether anything can be new.
  std::vector<sim::LiveCloud> live_clouds_;
  std::vector<TickSpan> steady_;
};

}  // namespace brume::smoke
