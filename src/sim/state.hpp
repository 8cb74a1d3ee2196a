// All that is there at one tick, in integers: what the simulation makes, what travels, what is drawn and
// looked through. A State is a value: copying it is a snapshot, and cheap, because clouds and blasts never
// change and are shared.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "sim/blast.hpp"
#include "sim/cloud.hpp"
#include "sim/events.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::sim {

/// A grenade in the air.
struct Flight {
  std::uint32_t id = 0;  ///< Of its throw; its cloud will have the same.
  Position from{0};
  glm::ivec3 landing{0};  ///< The voxel in which it goes off.
  std::uint32_t throw_tick = 0, detonation_tick = 0;
  SmokeSettings smoke;
  bool operator==(const Flight&) const = default;
};

struct LiveCloud {
  std::uint32_t id = 0;  ///< Of its throw.
  std::shared_ptr<const Cloud> cloud;
};

struct LiveBlast {
  std::uint32_t id = 0;
  std::shared_ptr<const BlastField> field;
};

/// A hole that is open somewhere.
struct BulletHole {
  std::uint32_t id = 0;
  Shot shot;
  std::uint64_t distance = 0;  ///< How deep it goes, 1/1024 m, > 0.
  bool operator==(const BulletHole&) const = default;
};

/// Where a body is, and where it was before its last move: the way that its wake follows.
struct Body {
  std::uint32_t body = 0;
  Position position{0}, previous{0};
  std::uint32_t tick = 0, previous_tick = 0;
  bool operator==(const Body&) const = default;
};

struct State {
  voxel::GridLayout layout;
  std::uint32_t ticks_per_second = 64;
  MaskKey masks = {};  ///< Those that its holes name.
  std::uint32_t tick = 0;
  std::uint32_t events = 0;  ///< Events taken in so far: the id of the next one.
  /// What differs from the level as it was loaded; null: nothing.
  std::shared_ptr<const EditBlocks> edits;
  std::vector<Flight> flights;  ///< By id, like all lists here;
  std::vector<LiveCloud> clouds;
  std::vector<LiveBlast> blasts;
  std::vector<BulletHole> holes;
  std::vector<Body> bodies;  ///< but these, by body.

  /// Seconds from tick 0 to a tick: the clock of shared::Hole.
  float seconds(std::uint32_t at) const {
    return static_cast<float>(static_cast<double>(at) / ticks_per_second);
  }
  /// Density in [0, 255] of a voxel, without holes: the sum of all clouds, at most 255, times what each blast
  /// leaves, rounded to the nearest after each.
  std::uint8_t density(glm::ivec3 voxel) const;
  /// Hash of everything here: equal states have equal hashes, on every machine.
  std::uint64_t hash() const;
};

/// What is left of a density when a share of `left` / 255 stays.
constexpr std::uint8_t scaled_density(std::uint8_t density, std::uint8_t left) {
  return static_cast<std::uint8_t>((unsigned{density} * left + 127) / 255);
}

/// A grenade in the air, to draw.
struct Grenade {
  glm::vec3 position_world{0};
  float flight_seconds = 0;  ///< Since the throw: what its spin is drawn from.
};
std::vector<Grenade> grenades_of(const State& state);

}  // namespace brume::sim
