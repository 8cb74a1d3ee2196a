// The simulation: an event log in, the smokes and holes of any tick out. The state is a pure function of the
// grid, the log and the tick, in integers: every machine computes the same bits, and time may run backwards.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "shared/hole.h"
#include "sim/cloud.hpp"
#include "sim/walk.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::sim {

struct WorldSettings {
  std::uint32_t ticks_per_second = 64;  ///< [1, 1000]
};

/// Largest tick of an event: four months at 64 a second; sums of ticks stay within 32 bits.
constexpr std::uint32_t kMaxTick = 1u << 29;

/// A smoke grenade leaves the hand. It flies in a straight line at 20 m/s to where the ray from `from`
/// through `at` lands (landing_voxel) and goes off on arrival.
struct ThrowSmoke {
  std::uint32_t tick = 0;
  Position from{0}, at{0};  ///< 1/1024 m
  SmokeSettings smoke = {};
};

/// Times of a hole (shared/hole.h) [ms].
struct HoleTiming {
  std::uint32_t reach_far = 250;
  std::uint32_t expand = 50;
  std::uint32_t stay_open = 1000;
  std::uint32_t fade = 350;
};

/// A bullet leaves the muzzle and bores a round hole into the smoke that is there at that tick.
struct Shot {
  std::uint32_t tick = 0;
  Position origin{0}, toward{0};  ///< 1/1024 m, must differ
  std::uint32_t radius = 205;     ///< 1/1024 m, [1, kMaxCoordinate]
  HoleTiming timing = {};         ///< each at most 2^30 ms
};

constexpr std::uint32_t kGrenadeMetresPerSecond = 20;

/// A grenade in the air.
struct Grenade {
  glm::vec3 position_world{0};
  float flight_seconds = 0;  ///< Since the throw: what its spin is drawn from.
};

/// A smoke that is there at the world's tick.
struct LiveCloud {
  std::uint32_t id;  ///< Number of its throw in the log: the same at every tick.
  const Cloud* cloud;
  Front front;
};

class World {
 public:
  /// `grid` must outlive the world and keep its voxels. Throws Error(bad_input) for a frame that VoxelRuler
  /// refuses or ticks_per_second out of range.
  explicit World(const voxel::BitGrid& grid, const WorldSettings& settings = {});

  /// Appends an event to the log. Fails with bad_input when a number is out of the range that the event
  /// names; the log is then as before. Events may be appended in any order of ticks.
  Result<void> append(const ThrowSmoke& event);
  Result<void> append(const Shot& event);

  /// Moves to a tick, forwards or backwards.
  void advance_to(std::uint32_t tick);
  std::uint32_t tick() const { return tick_; }
  const WorldSettings& settings() const { return settings_; }
  const voxel::BitGrid& grid() const { return grid_; }
  /// Seconds from tick 0 to a tick: the clock of shared::Hole.
  float seconds(std::uint32_t tick) const {
    return static_cast<float>(static_cast<double>(tick) / settings_.ticks_per_second);
  }

  /// The smokes that went off at or before the tick, in the order of the log.
  std::span<const LiveCloud> clouds() const { return live_; }
  /// Sum of the densities of all clouds in a voxel, at most 255.
  std::uint8_t density(glm::ivec3 voxel) const;

  /// Where the grenade of throw `id` (the number of the throw in the log) is at a tick: nothing before the
  /// throw, from the detonation on, and when it finds nowhere to land.
  std::optional<Grenade> grenade(std::uint32_t id, std::uint32_t tick) const;
  /// All grenades in the air at the world's tick.
  std::vector<Grenade> grenades() const;
  /// The tick at which the grenade of a throw goes off; nothing when it finds nowhere to land.
  std::optional<std::uint32_t> detonation_tick(std::uint32_t id) const;

  /// The holes that are open anywhere at the world's tick. A hole runs from the muzzle to where the shot
  /// leaves the last brick of smoke that had gone off when it was fired (two voxels around all that it ever
  /// fills), but no farther than through the first solid voxel after the first free one. A shot that meets no
  /// smoke leaves no hole.
  std::vector<shared::Hole> holes() const;

  /// Hash of all state at the world's tick: live clouds with their fills and fronts, grenades, holes.
  std::uint64_t state_hash() const;

 private:
  struct Throw {
    ThrowSmoke event;
    std::optional<glm::ivec3> landing;
    std::uint32_t detonation_tick = 0;
    std::unique_ptr<Cloud> cloud;  // made when first needed
  };
  struct Bullet {
    Shot event;
    std::optional<std::uint64_t> distance;  // 1/1024 m; 0: no smoke on its way. Nothing: not known yet
  };

  void detonate_until(std::uint32_t tick);
  std::uint64_t hole_distance(const Shot& shot) const;
  shared::Hole make_hole(const Bullet& bullet) const;
  bool is_open(const Bullet& bullet) const;

  const voxel::BitGrid& grid_;
  WorldSettings settings_;
  VoxelRuler ruler_;
  std::vector<Throw> throws_;
  std::vector<Bullet> bullets_;
  std::vector<LiveCloud> live_;
  std::uint32_t tick_ = 0;
};

}  // namespace brume::sim
