#include <algorithm>

#include "bench/bench.hpp"
#include "scenario/world_triangles.hpp"
#include "scene/files/load.hpp"
#include "sim/world.hpp"
#include "smoke/smoke_volume.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/voxelize.hpp"

namespace brume::bench {
namespace {

constexpr int kSmokes = 16;

struct Motel {
  voxel::BitGrid grid;
  voxel::SurfacePlanes planes;
};

Result<Motel> motel() {
  const auto path = motel_scene();
  if (!path) return path.failure();
  const auto scene = scene::load_scene(*path);
  if (!scene) return scene.failure();
  const std::vector<voxel::Triangle> triangles = scenario::world_triangles(*scene);
  auto grid = voxel::voxelize(triangles, {{120, 20, 120}, 0.5f, {-30, 0, -30}});
  if (!grid) return grid.failure();
  auto planes = voxel::SurfacePlanes::build(triangles, *grid);
  return Motel{std::move(*grid), std::move(planes)};
}

/// CPU time of a call on this thread [ms].
template <typename Body>
double processor_ms(Body body) {
  const double start = thread_cpu_ms();
  body();
  return thread_cpu_ms() - start;
}

/// A smoke that detonates at the first tick, in this voxel or on the ground below it.
sim::ThrowSmoke smoke_at(const Motel& level, glm::ivec3 voxel, std::uint32_t voxels) {
  const auto metres = glm::dvec3(voxel::world_from_voxel(level.grid.layout(), glm::vec3(voxel) + 0.5f));
  sim::ThrowSmoke event;
  event.from = sim::position_from_metres(metres);
  event.at = event.from;
  event.smoke.voxels = voxels;
  return event;
}

/// An update of all that a renderer reads; what nobody reads costs less.
void update_whole(smoke::SmokeVolume& volume, const sim::World& world) {
  volume.update(world);
  volume.volume();
}

/// Cost of one more smoke at its detonation: the cloud exists, bricks and boundary cells are built.
Result<std::vector<Measurement>> detonation(Bench& bench) {
  const auto level = motel();
  if (!level) return level.failure();
  std::vector<Measurement> all;
  for (const std::uint32_t voxels : {1800u, 24000u}) {
    sim::World world(level->grid);
    if (auto done = world.append(smoke_at(*level, {80, 3, 80}, voxels)); !done) return done.failure();
    world.advance_to(1);
    std::vector<double> times;
    double slots = 0, cells = 0;
    for (unsigned i = 0; i < bench.repetitions(voxels < 10000 ? 50 : 10); ++i) {
      smoke::SmokeVolume volume(level->grid, level->planes);
      times.push_back(processor_ms([&] { update_whole(volume, world); }));
      slots = volume.slot_count();
      cells = static_cast<double>(volume.boundary_cells().size());
    }
    auto m = summarize("volume/detonation/" + std::to_string(voxels), "ms", "cpu", std::move(times));
    m.details = {{"bricks", slots}, {"boundary cells", cells}};
    all.push_back(std::move(m));
  }
  return all;
}

/// Sixteen smokes spread over the motel that detonate at about the same time; the mean update over `count`
/// ticks after the last detonation.
Result<std::vector<Measurement>> ticks(Bench& bench, const std::string& name, std::uint32_t count) {
  const auto level = motel();
  if (!level) return level.failure();
  sim::World world(level->grid);
  for (int i = 0; i < kSmokes; ++i) {
    const glm::ivec3 at(15 + 30 * (i & 3), 3, 15 + 30 * (i >> 2));
    if (auto done = world.append(smoke_at(*level, at, 1800)); !done) return done.failure();
  }
  while (!world.state().flights.empty() || world.tick() == 0) world.step();
  const std::uint32_t begin = world.tick();
  std::vector<double> means;
  double most = 0;
  for (unsigned i = 0; i < bench.repetitions(5); ++i) {
    smoke::SmokeVolume volume(level->grid, level->planes);
    world.advance_to(begin);
    update_whole(volume, world);
    double sum = 0;
    for (std::uint32_t tick = 0; tick < count; ++tick) {
      world.step();
      const double time = processor_ms([&] { update_whole(volume, world); });
      sum += time;
      most = std::max(most, time);
    }
    means.push_back(sum / count);
  }
  auto m = summarize(name, "ms", "cpu", std::move(means));
  m.details = {{"smokes", static_cast<double>(world.state().clouds.size())}, {"slowest tick [ms]", most}};
  return std::vector{m};
}

}  // namespace

std::vector<Case> volume_cases() {
  const sim::SmokeSettings life;
  // Excludes the last ticks, in which the smokes vanish one by one.
  const std::uint32_t end = life.bloom_ticks + life.hold_ticks + life.dissolve_ticks;
  return {
      {"volume/detonation", "smoke volume: bricks and boundary cells of a smoke in the motel", detonation},
      {"volume/tick16", "smoke volume: a tick of 16 smokes in the motel, mean over their lifetime",
       [end](Bench& b) { return ticks(b, "volume/tick16", end - 5); }},
      {"volume/tick16growing", "smoke volume: the same while all 16 bloom",
       [life](Bench& b) { return ticks(b, "volume/tick16growing", life.bloom_ticks); }},
  };
}

}  // namespace brume::bench
