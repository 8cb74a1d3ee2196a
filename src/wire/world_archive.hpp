// The description of a world in keyframes and replays.
#pragma once

#include <cstdint>

#include "core/error.hpp"
#include "sim/state.hpp"
#include "wire/bytes.hpp"

namespace brume::wire {

struct WorldArchive {
  voxel::GridLayout layout;
  std::uint32_t ticks_per_second = 64;
  sim::MaskKey masks;
  std::uint64_t level_hash = 0;
};

/// The description of a state's world, and the state of such a world at tick 0.
WorldArchive archive_of(const sim::State& state);
sim::State first_state(const WorldArchive& world);

/// Three varints of the size, the bits of four floats (voxel size, origin), a varint of the ticks per second,
/// a varint of the number of masks and, if that is not 0, 8 bytes of their hash; 8 bytes of the level's hash.
void write_world(ByteWriter& out, const WorldArchive& world);

/// Fails with bad_input for values that World does not accept.
Result<WorldArchive> read_world(ByteReader& in);

}  // namespace brume::wire
