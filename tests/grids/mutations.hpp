// Damaged volume files.
#pragma once

#include <cstdint>

namespace brume::grids {

/// Loads mutated .vdb and .nvdb files, one child process each, two at a time, and fails the test unless every
/// one gives valid grids within the limits or is refused with a reason.
void load_mutations(std::uint32_t seed, int count);

}  // namespace brume::grids
