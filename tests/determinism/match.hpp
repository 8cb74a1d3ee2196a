// A busy match, the same on every machine: a level of rooms, corridors, stairs and a slope, and thirty
// seconds of smoke, shots, explosions, doors and moving bodies in it. Uses integers and its own
// generator, because the distributions of the standard library differ between implementations.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/events.hpp"
#include "smoke/mask_atlas.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::determinism {

/// Pseudorandom numbers: SplitMix64 (Steele, Lea, Flood 2014, "Fast Splittable Pseudorandom Number
/// Generators").
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next();
  /// In [low, high], slightly biased.
  int between(int low, int high);
  /// A position in the box [low, high], 1/1024 m.
  sim::Position position(glm::ivec3 low, glm::ivec3 high);

 private:
  std::uint64_t state_;
};

struct MatchLevel {
  voxel::BitGrid grid;
  voxel::SurfacePlanes planes;
};

/// 48 x 8 x 48 m in voxels of half a metre, nine rooms.
MatchLevel make_level();
/// Bounds of the event positions, 1/1024 m.
extern const glm::ivec3 kLowCorner, kHighCorner;

constexpr std::uint32_t kMatchTicks = 30 * 64;

/// The masks of its shots.
smoke::MaskAtlas make_masks();

/// 8 smokes, 200 shots of all shapes, 5 blasts, 2 doors that open and shut while smoke is there, 4 bodies; by
/// tick.
std::vector<sim::Event> make_events(const voxel::GridLayout& layout);

}  // namespace brume::determinism
