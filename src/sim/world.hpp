// The simulation: a level and an event log in, the state of any tick out. The same log gives the same bits,
// whatever the machine, the number of threads, or the ticks at which it was asked.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/events.hpp"
#include "sim/state.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::sim {

struct WorldSettings {
  std::uint32_t ticks_per_second = 64;  ///< [1, 1000]
  MaskKey masks = {};                   ///< Those that its shots may name: MaskAtlas::key().
};

constexpr std::uint32_t kGrenadeMetresPerSecond = 20;

/// The next tick at which something goes off, comes to rest or ends; 2^32 - 1 when nothing will.
std::uint32_t next_end(const State& state);
/// Takes out of a state what is over at its tick, as a world does; grenades that arrive are left to it.
void remove_ended(State& state);

/// A tick happens in this order: its events, as they were appended; grenades that arrive go off; what has
/// ended goes. Between the ticks at which something begins or ends nothing is computed.
class World {
 public:
  /// `level` must outlive the world and keep its voxels. Throws Error(bad_input) for a layout that VoxelRuler
  /// refuses or ticks_per_second out of range.
  explicit World(const voxel::BitGrid& level, const WorldSettings& settings = {});

  /// Takes an event into the log. One at or before the present tick changes the past: the world goes back and
  /// plays it again up to the present. Fails with bad_input as check_event does, for a shot of a mask that
  /// the settings do not have, or for an event of a tick that is forgotten; the world is then as before.
  Result<void> append(Event event);
  /// The same for many at once: the past is played again only once. All or none are taken.
  Result<void> append(std::vector<Event> events);
  /// Takes events into the place of those of the log at or after a tick, as if they had been appended in
  /// their stead; each must be of that tick or later. Fails as `append` does; the world is then as before.
  Result<void> replace_from(std::uint32_t tick, std::vector<Event> events) {
    return replace_from(tick, std::move(events), settings_.masks);
  }
  /// The same, and the world's shots have other masks from now on, those before the tick too. Fails with
  /// bad_input also when one of those names a mask that there is no more.
  Result<void> replace_from(std::uint32_t tick, std::vector<Event> events, const MaskKey& masks);

  /// Moves to a tick, forwards or, down to earliest_tick(), backwards.
  void advance_to(std::uint32_t tick);
  void step() { advance_to(tick() + 1); }

  std::uint32_t tick() const { return state_.tick; }
  const State& state() const { return state_; }
  std::uint64_t state_hash() const { return state_.hash(); }
  const WorldSettings& settings() const { return settings_; }
  /// The level at the present tick, edits included. Valid until the world moves.
  const voxel::BitGrid& grid() const { return edited_ ? *edited_ : level_; }

  /// Becomes the world of a state: what another world's state() was, or what travelled. Events of the log up
  /// to the state's tick are dropped, later ones stay. Fails with bad_input when the state is of another
  /// layout or ticks_per_second, or was made with other masks.
  Result<void> restore(const State& state);
  /// The first tick that can be gone back to: 0, or that of the state restored or kept.
  std::uint32_t earliest_tick() const { return first_.tick; }
  /// Lets the past go that nobody will ask for: what was before `tick`, or what is kept of before it; where
  /// the past then begins, earliest_tick() says. Costs next to nothing: a server may do it every tick.
  void forget_before(std::uint32_t tick);

  /// The events since earliest_tick(), by tick; those of one tick as they were appended.
  std::span<const Event> log() const { return log_; }

 private:
  Result<void> check(std::span<const Event> events, std::uint32_t first, const MaskKey& masks) const;
  void take_from(std::uint32_t first, std::size_t kept, std::vector<Event> events);
  void set_masks(const MaskKey& masks);
  void go_back_before(std::uint32_t tick);
  void change_edits(const std::shared_ptr<const EditBlocks>& edits);
  void play_tick(std::uint32_t tick);
  void apply(const ThrowSmoke& event);
  void apply(const Shot& event);
  void apply(const Blast& event);
  void apply(const MoveBody& event);
  void apply(const LevelEdit& event);
  void detonate();
  std::uint64_t hole_distance(const Shot& shot) const;

  const voxel::BitGrid& level_;
  WorldSettings settings_;
  VoxelRuler ruler_;
  std::optional<voxel::BitGrid> edited_;
  std::vector<Event> log_;
  std::size_t next_event_ = 0;  // of the log: the first that is not in state_
  State first_, state_;
  std::uint32_t first_free_tick_ = 0;  // the first tick whose events first_ has not taken in
  std::vector<State> checkpoints_;     // by tick, each with the events of its tick
  std::optional<State> previous_;      // before the last tick that was played: for events of the present
  std::uint32_t next_end_ = 0;         // the next tick at which something in state_ goes off or ends
  std::uint32_t changed_at_ = 0;       // no tick after this one has changed state_, but for its number
};

}  // namespace brume::sim
