// A replay: all input of a simulation and the checksum of every tick. A replay file is self-contained: it
// includes the level.
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
#include "voxel/solids.hpp"

namespace brume::wire {

struct Replay {
  voxel::BitGrid level;
  sim::WorldSettings settings;
  std::vector<sim::Event> events;
  std::vector<std::uint32_t> checksums;  ///< checksum_of the states of tick 0, 1, 2, ...
  voxel::RoleGrids roles = {};           ///< What the level's voxels stop.
};

/// A replay of this world from its first tick, still without checksums.
Replay make_replay(const voxel::Solids& level, const sim::WorldSettings& settings,
                   std::span<const sim::Event> events);

/// Maximum number of solid voxels in a replay; a 4^3 block counts as at least 16.
constexpr std::uint64_t kMaxLevelVoxels = std::uint64_t{1} << 27;

/// The bytes of a replay file; equal replays give equal bytes. Fails with resource_limit for a level of more
/// than kMaxLevelVoxels.
Result<std::vector<std::byte>> encode_replay(const Replay& replay);

/// Reads the output of encode_replay. Fails with bad_input when it is truncated, damaged, foreign or of
/// another version; the message does not name the file. Allocates no more than the level limit and the bytes
/// allow.
Result<Replay> decode_replay(std::span<const std::byte> bytes);

/// The same with files; messages name them. A file is written completely or not at all.
Result<void> save_replay(const std::filesystem::path& path, const Replay& replay);
Result<Replay> load_replay(const std::filesystem::path& path);

/// The first tick at which a simulation differs from its replay.
struct Divergence {
  std::uint32_t tick = 0;
  std::uint32_t recorded = 0, got = 0;  ///< Checksums.
};

/// Simulates all ticks and compares their checksums; stops at the first difference. Calls `visit` with each
/// state before comparing it. Fails as World does for an event that it rejects.
Result<std::optional<Divergence>> play(const Replay& replay,
                                       const std::function<void(const sim::State&)>& visit = {});

}  // namespace brume::wire
