#include <algorithm>

#include "bench/bench.hpp"
#include "core/tasks.hpp"
#include "scenario/world_triangles.hpp"
#include "scene/files/load.hpp"
#include "sim/fill.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/voxelize.hpp"

namespace brume::bench {
namespace {

constexpr voxel::GridLayout kMotelFrame{{120, 20, 120}, 0.5f, {-30, 0, -30}};

Result<std::vector<voxel::Triangle>> motel_triangles() {
  const auto path = motel_scene();
  if (!path) return path.failure();
  auto scene = scene::load_scene(*path);
  if (!scene) return scene.failure();
  return scenario::world_triangles(*scene);
}

Result<std::vector<Measurement>> voxelize_triangles(const Bench& bench, const std::string& name,
                                                    std::span<const voxel::Triangle> triangles,
                                                    const voxel::GridLayout& frame, unsigned repetitions) {
  std::uint64_t solid = 0;
  auto m = bench.time_calls(
      name, repetitions, [&] { solid = voxel::voxelize(triangles, frame).value_or_throw().count_solid(); });
  m.details = {{"triangles", static_cast<double>(triangles.size())}, {"solid", static_cast<double>(solid)}};
  return std::vector{m};
}

Result<std::vector<Measurement>> voxelize_motel(Bench& bench) {
  const auto triangles = motel_triangles();
  if (!triangles) return triangles.failure();
  return voxelize_triangles(bench, "voxelize/motel", *triangles, kMotelFrame, 50);
}

Result<std::vector<Measurement>> voxelize_demo(Bench& bench) {
  const auto scene = scene::load_scene(scene_file("demo.glb"));
  if (!scene) return scene.failure();
  // The grid of the timeline with 512 voxels along its longer sides.
  const voxel::GridLayout frame{{512, 171, 512}, 28.5f / 512, {-14.1f, -0.35f, -12.1f}};
  return voxelize_triangles(bench, "voxelize/demo@512", scenario::world_triangles(*scene), frame, 15);
}

/// Flood fill on one thread, in open space and, if it is available, in the motel.
Result<std::vector<Measurement>> fill(Bench& bench, std::uint32_t budget, unsigned repetitions) {
  const auto measure = [&](const std::string& name, const voxel::BitGrid& grid, glm::ivec3 source) {
    std::size_t filled = 0;
    auto m =
        bench.time_calls(name, repetitions, [&] { filled = sim::flood_fill(grid, source, budget).size(); });
    m.details = {{"voxels", static_cast<double>(filled)}};
    return m;
  };
  const std::string name = "fill/" + std::to_string(budget);
  std::vector<Measurement> all{
      measure(name, voxel::BitGrid({{128, 128, 128}, 0.5f, {0, 0, 0}}), glm::ivec3(64))};
  if (const auto triangles = motel_triangles()) {
    const auto grid = voxel::voxelize(*triangles, kMotelFrame);
    if (!grid) return grid.failure();
    all.push_back(measure(name + "/motel", *grid, {80, 3, 80}));
  }
  return all;
}

}  // namespace

std::vector<Case> cpu_cases() {
  return {
      {"voxelize/motel", "the motel into 120 x 20 x 120 voxels, all threads", voxelize_motel},
      {"voxelize/demo@512", "the demo scene into 512 x 171 x 512 voxels, all threads", voxelize_demo},
      {"fill/1800", "flood fill of 1,800 voxels, one thread", [](Bench& b) { return fill(b, 1800, 200); }},
      {"fill/100000", "flood fill of 100,000 voxels, one thread",
       [](Bench& b) { return fill(b, 100000, 20); }},
  };
}

}  // namespace brume::bench
