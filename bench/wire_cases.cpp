#include "bench/bench.hpp"
#include "sim/world.hpp"
#include "wire/packet.hpp"

namespace brume::bench {
namespace {

/// A smoke of 1,800 voxels in the air: its keyframe when it has grown, and as details the sizes of packets.
Result<std::vector<Measurement>> keyframe(Bench& bench) {
  constexpr std::uint32_t kGrowthTicks = 64;
  const voxel::BitGrid level({{96, 96, 96}, 0.5f, {0, 0, 0}});
  sim::World world(level);
  sim::ThrowSmoke thrown;
  thrown.from = thrown.at = sim::position_from_metres({24, 24, 24});
  world.append(thrown).value_or_throw();
  sim::State last = world.state();
  std::size_t delta_bytes = 0, deltas = 0;
  while (deltas < kGrowthTicks) {
    if (world.tick() > 2 * kGrowthTicks)
      return Failure{ErrorCode::internal, "wire/keyframe: expected a smoke"};
    world.step();
    const std::size_t size = wire::write_delta(last, world.state()).size();
    last = world.state();
    if (last.clouds.empty()) continue;
    delta_bytes += size;
    ++deltas;
  }
  std::size_t bytes = 0;
  Measurement m = bench.time_calls("wire/keyframe", 200, [&] { bytes = wire::write_keyframe(last).size(); });
  m.details = {{"bytes", static_cast<double>(bytes)},
               {"mean_delta_bytes", static_cast<double>(delta_bytes) / static_cast<double>(deltas)},
               {"voxels", static_cast<double>(last.clouds[0].cloud->voxels().size())}};
  return std::vector{m};
}

}  // namespace

std::vector<Case> wire_cases() {
  return {{"wire/keyframe", "a packet with all of a grown smoke of 1,800 voxels, one thread", keyframe}};
}

}  // namespace brume::bench
