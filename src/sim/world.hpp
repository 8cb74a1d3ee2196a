// The simulation: a level and an event log in, the state of any tick out. The same log gives the same bits
// regardless of machine, number of threads and ticks visited in between.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/edited_level.hpp"
#include "sim/events.hpp"
#include "sim/made_clouds.hpp"
#include "sim/state.hpp"
#include "voxel/solids.hpp"

namespace brume::sim {

struct WorldSettings {
  std::uint32_t ticks_per_second = 64;  ///< [1, 1000]
  MaskKey masks = {};                   ///< The masks its shots may refer to: MaskAtlas::key().
  /// voxel::level_hash of the world's level; 0: not known. States carry it, so that states of another level
  /// are refused.
  std::uint64_t level_hash = 0;
};

constexpr std::uint32_t kGrenadeMetresPerSecond = 20;

/// The next tick at which a grenade detonates, or anything else in the state settles or ends; 2^32 - 1 when
/// nothing will.
std::uint32_t next_end(const State& state);
/// Removes all but grenades and bodies that has ended by the state's tick, as World does. Does not detonate
/// grenades.
void remove_ended(State& state);

/// A tick is processed in this order: its events, as appended; detonation of arriving grenades; removal of
/// everything that has ended. Nothing is computed between ticks at which something starts or ends.
class World {
 public:
  /// The grids of `level` must outlive the world unchanged. Throws Error(bad_input) for a layout that
  /// VoxelRuler rejects or ticks_per_second out of range.
  explicit World(const voxel::Solids& level, const WorldSettings& settings = {});

  /// Adds an event to the log. One at or before the present tick changes the past: the world rolls back and
  /// replays to the present. Fails with bad_input as check_event does, for a shot with a mask that the
  /// settings lack, and for an event before first_open_tick(); the world is then unchanged.
  Result<void> append(Event event);
  /// The same for many events with a single replay. Adds all or none.
  Result<void> append(std::vector<Event> events);
  /// Replaces the log's events at or after a tick by others, as if they had been appended in their stead;
  /// each must be of that tick or later. Fails as `append` does; the world is then unchanged.
  Result<void> replace_from(std::uint32_t tick, std::vector<Event> events) {
    return replace_from(tick, std::move(events), settings_.masks);
  }
  /// The same, and replaces the masks of all shots, those before the tick included. Also fails with bad_input
  /// when one of those shots uses a mask that no longer exists.
  Result<void> replace_from(std::uint32_t tick, std::vector<Event> events, const MaskKey& masks);

  /// Moves to a tick, forwards, or backwards down to earliest_tick().
  void advance_to(std::uint32_t tick);
  void step() { advance_to(tick() + 1); }

  std::uint32_t tick() const { return state_.tick; }
  const State& state() const { return state_; }
  std::uint64_t state_hash() const { return state_.hash(); }
  const WorldSettings& settings() const { return settings_; }
  /// What stops smoke and shots at the present tick, edits included. Valid until the world changes tick.
  const voxel::BitGrid& grid() const { return level_.grid(); }
  /// The same for all roles.
  voxel::Solids solids() const { return level_.solids(); }

  /// Adopts a state, from another world's state() or received. Log events up to the state's tick are dropped,
  /// later ones are retained. Fails with bad_input when the state has another level, ticks_per_second or
  /// masks, or contains something that has already ended.
  Result<void> restore(const State& state);
  /// The first tick that can be rolled back to: 0, the tick of a restored state, or what was given to
  /// forget_before.
  std::uint32_t earliest_tick() const { return earliest_tick_; }
  /// The first tick whose events may still be appended or replaced.
  std::uint32_t first_open_tick() const { return first_open_tick_; }
  /// Refuses events before `tick` from now on; if it is not after the present tick, it becomes
  /// earliest_tick(), else the present one does. Drops what no later event requires. A tick that was given
  /// before, or an earlier one, changes nothing. Cheap: a server may call it every tick.
  void forget_before(std::uint32_t tick);

  /// The events that are kept: those since a state at or before earliest_tick(). Sorted by tick; events of
  /// one tick in the order appended.
  std::span<const Event> log() const { return log_; }

 private:
  Result<void> check(std::span<const Event> events, std::uint32_t first, const MaskKey& masks) const;
  void replace_log(std::uint32_t first, std::size_t retained, std::vector<Event> events);
  void set_masks(const MaskKey& masks);
  void go_back_before(std::uint32_t tick);
  void go_forward_to(std::uint32_t tick);
  void adopt(State target, bool is_first);
  std::uint64_t events_until(std::uint32_t tick) const;
  void play_tick(std::uint32_t tick);
  /// For each kind of event.
  template <typename Kind>
  void apply(const Kind& event);
  void detonate();
  void flow(std::uint32_t tick, const EditBlocks& of_smoke);
  std::uint64_t hole_distance(const Shot& shot) const;

  EditedLevel level_;  // with the edits of state_
  WorldSettings settings_;
  VoxelRuler ruler_;
  std::vector<Event> log_;
  std::size_t next_event_ = 0;  // index into the log: the first event not yet in state_
  State first_, state_;
  std::uint32_t earliest_tick_ = 0;    // first_.tick or a later one
  std::uint32_t first_open_tick_ = 0;  // no event before it is accepted
  std::vector<State> checkpoints_;     // sorted by tick, each including the events of its tick
  MadeClouds made_;                    // after first_
  std::optional<State> previous_;      // before the last tick played: for events of the present
  std::uint32_t next_end_ = 0;         // next_end(state_)
  std::uint32_t changed_at_ = 0;       // since this tick only state_.tick has changed
};

}  // namespace brume::sim
