// The smoke along many straight lines: a packet of rays that walk their cells in step.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "smoke/sight_packet_lanes.hpp"
#include "smoke/sight_walk.hpp"

namespace brume::smoke {

/// The same sums as smoke_on_ray, bit for bit, of many rays: a lane takes the next ray as soon as its last
/// one has ended.
class SmokePacket {
 public:
  /// Writes the sum of ray `number` to sums[number]. `holed`: rays have the holes of their lanes.
  SmokePacket(const SmokeVolume& volume, bool holed, float enough, std::span<float> sums,
              StepPacket step_packet = fastest_step());

  /// Walks until a lane is free, and returns it.
  std::size_t free_lane();
  /// For those of the lane's next ray.
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
