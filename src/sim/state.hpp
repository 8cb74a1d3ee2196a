// The complete state of a world at one tick, in integers: output of the simulation, payload of the network
// protocol, input of rendering and of line-of-sight queries. A State is a value: copying it takes a snapshot,
// cheaply, because clouds and blasts are immutable and shared.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/blast.hpp"
#include "sim/cloud.hpp"
#include "sim/events.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::sim {

/// A grenade in the air.
struct Flight {
  std::uint32_t id = 0;  ///< Id of its throw; its cloud gets the same id.
  Position from{0};
  glm::ivec3 landing{0};  ///< The voxel where it detonates.
  std::uint32_t throw_tick = 0, detonation_tick = 0;
  SmokeSettings smoke;
  bool operator==(const Flight&) const = default;
};

struct LiveCloud {
  std::uint32_t id = 0;  ///< Id of its throw.
  std::shared_ptr<const Cloud> cloud;
};

/// What an event leaves for some time, made once when it takes place. A Field has event(), reached(),
/// end_tick() and hash(), and for packets centre() and from_parts(), as BlastField.
template <typename Field>
struct Live {
  std::uint32_t id = 0;  ///< Id of its event.
  std::shared_ptr<const Field> field;
};
using LiveBlast = Live<BlastField>;

/// A hole that has not closed yet.
struct BulletHole {
  std::uint32_t id = 0;
  Shot shot;
  std::uint64_t distance = 0;  ///< Depth from the muzzle, 1/1024 m, > 0.
  bool operator==(const BulletHole&) const = default;
};

/// A body's position and the one before its last move: the segment its wake follows.
struct Body {
  std::uint32_t body = 0;
  Position position{0}, previous{0};
  std::uint32_t tick = 0, previous_tick = 0;
  bool operator==(const Body&) const = default;
};

struct State {
  voxel::GridLayout layout;
  std::uint32_t ticks_per_second = 64;
  MaskKey masks = {};            ///< The masks that its holes refer to.
  std::uint64_t level_hash = 0;  ///< The level of its world: WorldSettings::level_hash.
  std::uint32_t tick = 0;
  std::uint32_t events = 0;  ///< Number of events applied so far: the id of the next one.
  /// Differences from the level as loaded; null: none.
  std::shared_ptr<const EditBlocks> edits;
  std::vector<Flight> flights;    ///< Sorted by id.
  std::vector<LiveCloud> clouds;  ///< Sorted by id.
  std::vector<LiveBlast> blasts;  ///< Sorted by id.
  std::vector<BulletHole> holes;  ///< Sorted by id.
  std::vector<Body> bodies;       ///< Sorted by Body::body.

  /// Seconds from tick 0 to a tick: the clock of shared::Hole.
  float seconds(std::uint32_t at) const {
    return static_cast<float>(static_cast<double>(at) / ticks_per_second);
  }
  /// Density in [0, 255] of a voxel, without holes: the sum over all clouds, at most 255, scaled by the
  /// remaining fraction of each blast in turn, each time rounded to the nearest.
  std::uint8_t density(glm::ivec3 voxel) const;
  /// Hash of the whole state: equal states have equal hashes on every machine.
  std::uint64_t hash() const;
};

/// Nothing where both states are of worlds with one level, tick rate and masks; else one sentence about the
/// first difference. `owner` is who has the second state, as in "this world".
std::optional<std::string> foreign_reason(const State& state, const State& own, const std::string& owner);

/// Calls visit(what, member) for each list of a state: what it lists, and a pointer to it. The one place that
/// enumerates them, in the order in which they are hashed and coded.
template <typename Visitor>
constexpr void for_each_state_list(Visitor&& visit) {
  visit("grenades", &State::flights);
  visit("clouds", &State::clouds);
  visit("explosions", &State::blasts);
  visit("holes", &State::holes);
  visit("bodies", &State::bodies);
}

/// density * remaining / 255, rounded to the nearest.
constexpr std::uint8_t scaled_density(std::uint8_t density, std::uint8_t remaining) {
  return static_cast<std::uint8_t>((unsigned{density} * remaining + 127) / 255);
}

/// A grenade in the air, for rendering.
struct Grenade {
  glm::vec3 position_world{0};
  float flight_seconds = 0;  ///< Since the throw; determines its spin.
};
std::vector<Grenade> grenades_of(const State& state);

}  // namespace brume::sim
