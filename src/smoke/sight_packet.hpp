// The smoke along many straight lines: a packet of rays that walk their cells in step.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "smoke/sight_smoke.hpp"
#include "smoke/smoke_brick.hpp"

namespace brume::smoke {

inline constexpr std::size_t kPacketLanes = 16;

/// A ray in each lane, within one brick.
struct PacketLanes {
  template <typename Number>
  struct alignas(64) PerLane : std::array<Number, kPacketLanes> {};
  template <typename Number>
  using PerAxis = std::array<PerLane<Number>, 3>;

  // What is constant along a ray.
  PerAxis<float> direction{}, exits_per_cell{};
  PerLane<float> xy{}, xz{}, yz{};  ///< Products of the direction's axes.
  PerLane<float> length{};
  PerAxis<std::int32_t> stride{}, place_stride{};

  // What is constant within its brick.
  PerAxis<float> at{};  ///< The ray's start, from the low corner.
  PerLane<const Texel*> texels{};
  PerLane<const std::uint32_t*> entries{};

  // The cell that it enters at t.
  PerLane<float> t{};
  PerAxis<float> exits{};  ///< By axis: where the ray leaves the cell.
  PerAxis<std::int32_t> cell{};
  PerLane<std::uint32_t> place{};  ///< Number of its first texel, and from bit 16 on of its entry.

  PerLane<float> next_hole{};  ///< As SmokeSum has it.
  std::array<PerLane<float>, 4> total{};

  // The cell that the last step passed, in special lanes.
  PerAxis<float> passed_at{};  ///< The ray's start, from its low corner.
  PerLane<float> passed_from{}, passed_to{};
  PerLane<std::uint32_t> passed_place{};
};

/// Lanes, a bit each.
struct PacketStep {
  std::uint32_t stopped;  ///< The ray has left its brick, or ended.
  std::uint32_t special;  ///< The cell passed has surfaces or holes: it is left to be added.
};

/// Moves every ray to its next cell, and adds the smoke in the cell that it passed.
using StepPacket = PacketStep (*)(PacketLanes& lanes);

/// Steps 4 lanes at once, or 8 where the processor has AVX2: the same bits.
PacketStep step_packet_4(PacketLanes& lanes);
#if defined(__x86_64__)
PacketStep step_packet_8(PacketLanes& lanes);
#endif
/// The one for this processor.
StepPacket fastest_step();

/// The same sums as smoke_on_ray, bit for bit, of many rays: a lane takes the next ray as soon as its last
/// one has ended.
class SmokePacket {
 public:
  /// Writes the sum of ray `number` to sums[number]. `holed`: rays have the holes of their lanes.
  SmokePacket(const SmokeVolume& volume, bool holed, float enough, std::span<float> sums,
              StepPacket step_packet = fastest_step());

  /// Walks until a lane is free, and returns it.
  std::size_t free_lane();
  /// Where the caller puts the holes on the next ray of a lane.
  HolesOnRay& holes(std::size_t lane) { return rays_[lane].holes; }
  /// Takes a ray into a free lane.
  void start(std::size_t lane, const SmokeRay& ray, std::size_t number);
  /// Walks until all rays have ended.
  void finish();

 private:
  struct LaneRay {
    BrickWalk bricks;
    SmokeSum sum;
    HolesOnRay holes;
    std::size_t number = 0;
  };
  void step();
  void enter_brick(std::size_t lane);
  void leave_brick(std::size_t lane);
  void add_special(std::size_t lane);
  void end(std::size_t lane);
  Float4 total_of(std::size_t lane) const {
    const auto& total = lanes_.total;
    return Float4{total[0][lane], total[1][lane], total[2][lane], total[3][lane]};
  }

  const SmokeVolume& volume_;
  bool holed_;
  float enough_;
  std::span<float> sums_;
  StepPacket step_packet_;
  std::uint32_t busy_ = 0;  // lanes, a bit each
  std::array<LaneRay, kPacketLanes> rays_;
  PacketLanes lanes_;
};

}  // namespace brume::smoke
