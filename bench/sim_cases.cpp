#include <algorithm>
#include <chrono>
#include <numeric>

#include "bench/bench.hpp"
#include "core/tasks.hpp"
#include "sim/world.hpp"

namespace brume::bench {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Limits the library to one thread in a scope, as a server does for a match.
class OneThread {
 public:
  OneThread() : before_(thread_count()) { set_thread_count(1); }
  ~OneThread() { set_thread_count(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  unsigned before_;
};

/// A smoke thrown in mid-air: it goes off one tick later.
sim::ThrowSmoke smoke_at(std::uint32_t tick, sim::Position at, std::uint32_t hold_ticks) {
  return {tick, at, at + sim::Position(1, 0, 0), {1800, 64, hold_ticks, 192}};
}

/// Each tick and its hash, from the detonation of the first of 16 smokes until the last begins to dissolve.
/// All detonate within half a second.
Result<std::vector<Measurement>> tick16(Bench& bench) {
  const OneThread one;
  const voxel::BitGrid level({{256, 64, 256}, 0.5f, {0, 0, 0}});
  std::vector<double> ticks;
  double worst_quiet = 0;
  for (unsigned run = 0; run < bench.repetitions(5); ++run) {
    sim::World world(level);
    for (int i = 0; i < 16; ++i)
      world
          .append(smoke_at(1 + 2 * static_cast<std::uint32_t>(i),
                           {16000 + i % 4 * 32000, 16000, 16000 + i / 4 * 32000}, 500))
          .value_or_throw();
    std::uint64_t hashes = 0;
    for (std::uint32_t tick = 1; tick < 560; ++tick) {
      const auto start = Clock::now();
      world.step();
      hashes ^= world.state_hash();
      ticks.push_back(milliseconds_since(start));
      if (tick > 64) worst_quiet = std::max(worst_quiet, ticks.back());
    }
    if (world.state().clouds.size() != 16 || hashes == 0)
      return Failure{ErrorCode::internal, "sim/tick16: expected 16 smokes"};
  }
  const double mean = std::accumulate(ticks.begin(), ticks.end(), 0.0) / static_cast<double>(ticks.size());
  auto m = summarize("sim/tick16", "ms", "wall", std::move(ticks));
  m.details = {{"mean_ms", mean}, {"worst_after_bloom_ms", worst_quiet}};
  return std::vector{m};
}

/// A tick and its hash with `count` smokes of 1,800 voxels in a world of 2,048 x 256 x 2,048 voxels.
Result<std::vector<Measurement>> smokes(Bench& bench, int count) {
  const OneThread one;
  const voxel::BitGrid level({{2048, 256, 2048}, 0.5f, {0, 0, 0}});
  sim::World world(level);
  for (int i = 0; i < count; ++i) {
    const sim::Position at(8000 + i % 100 * 10000, 20000 + i % 7 * 10000, 8000 + i / 100 * 10000);
    world.append(smoke_at(1 + static_cast<std::uint32_t>(i % 64), at, 20000)).value_or_throw();
  }
  const auto start = Clock::now();
  world.advance_to(70);
  const double detonated = milliseconds_since(start);
  if (world.state().clouds.size() != static_cast<std::size_t>(count))
    return Failure{ErrorCode::internal, "smokes: expected all of them to have detonated"};
  std::uint64_t bytes = sizeof(sim::State) + world.state().clouds.capacity() * sizeof(sim::LiveCloud);
  std::uint64_t voxels = 0;
  for (const sim::LiveCloud& live : world.state().clouds) {
    bytes += live.cloud->bytes();
    voxels += live.cloud->voxels().size();
  }
  std::uint64_t hashes = 0;
  auto m = bench.time_calls("smokes/" + std::to_string(count), 200, [&] {
    world.step();
    hashes ^= world.state_hash();
  });
  m.details = {{"state_bytes", static_cast<double>(bytes)},
               {"voxels", static_cast<double>(voxels)},
               {"level_bytes", static_cast<double>(level.bytes())},
               {"detonation_ms_each", detonated / count},
               {"hashed", hashes != 0 ? 1.0 : 0.0}};
  return std::vector{m};
}

/// A tick without a hash in a world where everything is over, from runs of 100,000.
Result<std::vector<Measurement>> idle(Bench& bench) {
  constexpr unsigned kTicks = 100000;
  const voxel::BitGrid level({{2048, 256, 2048}, 0.5f, {0, 0, 0}});
  sim::World world(level);
  world.append(smoke_at(1, {20000, 20000, 20000}, 0)).value_or_throw();
  world.advance_to(1000);
  if (!world.state().clouds.empty()) return Failure{ErrorCode::internal, "smokes/idle: expected no smoke"};
  auto m = bench.time_calls("smokes/idle", 20, [&] {
    for (unsigned i = 0; i < kTicks; ++i) world.step();
  });
  for (double* value : {&m.median, &m.min, &m.max}) *value *= 1e6 / kTicks;
  m.unit = "ns";
  return std::vector{m};
}

}  // namespace

std::vector<Case> sim_cases() {
  std::vector<Case> cases{
      {"sim/tick16", "a tick and its hash, 16 smokes of 1,800 voxels, one thread", tick16}};
  for (const int count : {10, 100, 1000, 10000})
    cases.push_back({"smokes/" + std::to_string(count),
                     "a tick and its hash with that many smokes in 2,048 x 256 x 2,048 voxels, one thread",
                     [count](Bench& bench) { return smokes(bench, count); }});
  cases.push_back({"smokes/idle", "a tick of a world without smoke", idle});
  return cases;
}

}  // namespace brume::bench
