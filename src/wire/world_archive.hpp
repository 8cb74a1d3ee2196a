// What keyframes and replays say of the world itself.
#pragma once

#include <cstdint>

#include "core/error.hpp"
#include "sim/mask_key.hpp"
#include "voxel/bit_grid.hpp"
#include "wire/bytes.hpp"

namespace brume::wire {

struct WorldArchive {
  voxel::GridLayout layout;
  std::uint32_t ticks_per_second = 64;
  sim::MaskKey masks;
};

/// Three varints of the size, the bits of four floats (voxel size, origin), a varint of the ticks a second, a
/// varint of how many masks there are and, where there are any, 8 bytes of their hash.
void write_world(ByteWriter& out, const WorldArchive& world);

/// Fails with bad_input for what no World can have.
Result<WorldArchive> read_world(ByteReader& in);

}  // namespace brume::wire
