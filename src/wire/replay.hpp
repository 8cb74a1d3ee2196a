// A replay: all that a simulation followed from, and what it came to at each tick. A file stands for itself:
// the level is in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/events.hpp"
#include "sim/world.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::wire {

struct Replay {
  voxel::BitGrid level;
  sim::WorldSettings settings;
  std::vector<sim::Event> events;
  std::vector<std::uint32_t> checksums;  ///< checksum_of the states of tick 0, 1, 2, ...
};

/// A replay without ticks that follows this world from its first tick on.
Replay replay_of(const voxel::BitGrid& level, const sim::WorldSettings& settings,
                 std::span<const sim::Event> events);

/// Solid voxels that a replay may hold; a block of 4^3 counts as 16 at least.
constexpr std::uint64_t kMaxLevelVoxels = std::uint64_t{1} << 27;

/// The bytes of a replay file; the same for the same replay. Fails with resource_limit for a level of more
/// than kMaxLevelVoxels.
Result<std::vector<std::byte>> encode_replay(const Replay& replay);

/// Reads what encode_replay made. Fails with bad_input when it is truncated, damaged, foreign or of another
/// version; the message does not name the file. Allocates no more than the level's limit and the bytes allow.
Result<Replay> decode_replay(std::span<const std::byte> bytes);

/// The same with files; messages name them. Written whole or not at all.
Result<void> save_replay(const std::filesystem::path& path, const Replay& replay);
Result<Replay> load_replay(const std::filesystem::path& path);

/// Where a simulation left the replay.
struct Divergence {
  std::uint32_t tick = 0;
  std::uint32_t recorded = 0, got = 0;  ///< Checksums.
};

/// Simulates all ticks anew and compares each; stops at the first that differs. `visit` is called with each
/// state before it is compared. Fails as World does for an event that it refuses.
Result<std::optional<Divergence>> play(const Replay& replay,
                                      const std::function<void(const sim::State&)>& visit = {});

}  // namespace brume::wire
