// The events of a world's log. All numbers are integers.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <variant>

#include "shared/hole.h"
#include "sim/fill.hpp"
#include "sim/level_edit.hpp"
#include "sim/mask_key.hpp"
#include "sim/walk.hpp"

namespace brume::sim {

/// Largest tick of an event: 97 days at 64 ticks per second; sums of ticks fit 32 bits.
constexpr std::uint32_t kMaxTick = 1u << 29;

/// Life of a smoke: it blooms to its full amount, holds, and dissolves in patches. The defaults at 64
/// ticks per second: 1 s, 18 s, 3 s.
struct SmokeSettings {
  std::uint32_t voxels = 1800;         ///< Amount of smoke: number of voxels it fills, [1, kMaxFillVoxels].
  std::uint32_t bloom_ticks = 64;      ///< From the detonation to the full amount, [1, kMaxTick].
  std::uint32_t hold_ticks = 1152;     ///< From the full amount to the start of the dissolve, [0, kMaxTick].
  std::uint32_t dissolve_ticks = 192;  ///< From the start of the dissolve to its end, [1, kMaxTick].
  bool operator==(const SmokeSettings&) const = default;
};

/// A smoke grenade is thrown. It flies in a straight line at 20 m/s to where the ray from `from` through `at`
/// lands (landing_voxel), and detonates on arrival.
struct ThrowSmoke {
  std::uint32_t tick = 0;
  Position from{0}, at{0};  ///< 1/1024 m
  SmokeSettings smoke = {};
  bool operator==(const ThrowSmoke&) const = default;
};

/// Times of a hole (shared/hole.h) [ms], each at most kMaxMilliseconds.
struct HoleTimingMs {
  std::uint32_t reach_far = 250;
  std::uint32_t expand = 50;
  std::uint32_t stay_open = 1000;
  std::uint32_t fade = 350;
  bool operator==(const HoleTimingMs&) const = default;
};
constexpr std::uint32_t kMaxMilliseconds = 1u << 30;

/// Cross-section of a hole. The numbers are the same in shared/hole.h.
enum class HoleShape : std::uint8_t {
  cylinder = shared::kHoleCylinder,
  box = shared::kHoleBox,
  mask = shared::kHoleMask,
};

/// A bullet leaves the muzzle and bores a hole into the smoke present at that tick.
struct Shot {
  std::uint32_t tick = 0;
  Position origin{0}, toward{0};  ///< 1/1024 m; must differ
  std::uint32_t radius = 205;     ///< Half the edge of a box or mask; 1/1024 m, [1, kMaxCoordinate]
  HoleTimingMs timing = {};
  HoleShape shape = HoleShape::cylinder;
  /// Index of one of the world's masks, [0, WorldSettings::masks.count); 0 unless the shape is a mask.
  std::uint32_t mask = 0;
  /// Rotation of the cross-section, clockwise as the shooter sees it; 1/65536 turn, [0, 65535]. 0: the top of
  /// a box or mask is up.
  std::uint32_t roll = 0;
  bool operator==(const Shot&) const = default;
};
constexpr std::uint32_t kFullTurn = 65536;

/// An explosion drives the smoke out of every voxel visible from it: a cavity whose front runs outward from
/// `at`, and which refills from its rim to its middle. Walls shield the smoke behind them.
struct Blast {
  std::uint32_t tick = 0;
  Position at{0};                     ///< 1/1024 m
  std::uint32_t radius = 5 * 1024;    ///< 1/1024 m, from 1 to kMaxBlastVoxels voxels
  std::uint32_t speed = 32 * 1024;    ///< speed of the front, 1/1024 m/s, [1024, 2^24]
  std::uint32_t remaining = 5;        ///< remaining fraction of density, of 255, [0, 255]
  std::uint32_t refill_rim_ms = 500;  ///< until the rim is full again, [1, kMaxMilliseconds]
  std::uint32_t refill_middle_ms =
      5000;  ///< until the middle is full again, [refill_rim_ms, kMaxMilliseconds]
  bool operator==(const Blast&) const = default;
};
constexpr int kMaxBlastVoxels = 64;

/// A player, bot or object moves to a position. Its first move places it.
struct MoveBody {
  std::uint32_t tick = 0;
  std::uint32_t body = 0;  ///< The caller's number for the body.
  Position to{0};          ///< 1/1024 m
  bool operator==(const MoveBody&) const = default;
};

/// The level changes: a door opens, a wall breaks.
struct LevelEdit {
  std::uint32_t tick = 0;
  EditBlocks blocks;
  bool operator==(const LevelEdit&) const = default;
};

using Event = std::variant<ThrowSmoke, Shot, Blast, MoveBody, LevelEdit>;

inline std::uint32_t tick_of(const Event& event) {
  return std::visit([](const auto& e) { return e.tick; }, event);
}

}  // namespace brume::sim
