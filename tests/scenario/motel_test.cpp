// Tests with the motel scene, if it is available.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "scenario/level_events.hpp"
#include "scenario/walker.hpp"
#include "scenario/world_triangles.hpp"
#include "scene/files/load.hpp"
#include "tests/reference/triangle_box.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/voxelize.hpp"

namespace brume::scenario {
namespace {

using voxel::BitGrid;
using voxel::GridLayout;
using voxel::SurfacePlanes;
using voxel::Triangle;

std::filesystem::path motel() {
  const char* chosen = std::getenv("BRUME_MOTEL");
  const std::filesystem::path folder = chosen ? chosen : BRUME_SOURCE_DIR "/../shared/data/motel";
  return folder / "Scene.txt";
}

TEST(Motel, VoxelsEqualBruteForceAndPlanesLieInThem) {
  if (!std::filesystem::exists(motel()))
    GTEST_SKIP() << motel() << " is not there; set BRUME_MOTEL to its folder";
  const auto scene = scene::load_scene(motel()).value_or_throw();
  const std::vector<Triangle> triangles = world_triangles(scene);
  const GridLayout layout{{120, 20, 120}, 0.5f, glm::vec3(-30, 0, -30)};
  const auto grid = voxel::voxelize(triangles, layout);
  ASSERT_TRUE(grid);

  // Each triangle against the voxels of its bounding box and a margin.
  BitGrid expected(layout);
  for (const Triangle& t : triangles) {
    std::array<glm::dvec3, 3> in_voxels{(glm::dvec3(t.a) - glm::dvec3(layout.origin_world)) / 0.5,
                                        (glm::dvec3(t.b) - glm::dvec3(layout.origin_world)) / 0.5,
                                        (glm::dvec3(t.c) - glm::dvec3(layout.origin_world)) / 0.5};
    const glm::dvec3 last(layout.size - 1);
    const auto low = glm::ivec3(glm::clamp(
        glm::floor(glm::min(glm::min(in_voxels[0], in_voxels[1]), in_voxels[2])) - 1.0, glm::dvec3(0), last));
    const auto high = glm::ivec3(glm::clamp(
        glm::floor(glm::max(glm::max(in_voxels[0], in_voxels[1]), in_voxels[2])) + 1.0, glm::dvec3(0), last));
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
          if (!expected.solid({x, y, z}) && reference::touches(in_voxels, glm::dvec3(x, y, z)))
            expected.set({x, y, z}, true);
  }
  EXPECT_GT(expected.count_solid(), 37121u);
  std::uint64_t missed = 0, extra = 0;
  for (int z = 0; z < layout.size.z; ++z)
    for (int y = 0; y < layout.size.y; ++y)
      for (int x = 0; x < layout.size.x; ++x) {
        missed += expected.solid({x, y, z}) && !grid->solid({x, y, z});
        extra += !expected.solid({x, y, z}) && grid->solid({x, y, z});
      }
  EXPECT_EQ(missed, 0u);
  EXPECT_EQ(extra, 0u);

  const SurfacePlanes planes = SurfacePlanes::build(triangles, *grid);
  EXPECT_GT(planes.cell_count(), grid->count_solid() / 2);
}

TEST(Motel, OpeningADoorEqualsARebuildWithoutIt) {
  if (!std::filesystem::exists(motel()))
    GTEST_SKIP() << motel() << " is not there; set BRUME_MOTEL to its folder";
  auto scene = scene::load_scene(motel());
  ASSERT_TRUE(scene) << scene.failure().message;
  const GridLayout layout{{240, 40, 240}, 0.25f, glm::vec3(-30, 0, -30)};
  auto voxels = load_or_voxelize(*scene, layout, {}).value_or_throw();
  const Scenario scenario{{}, std::move(*scene), {}, std::move(voxels)};
  ObjectLevel objects = make_level(scenario);
  const auto& list = scenario.scene.objects;
  const auto door =
      std::find_if(list.begin(), list.end(), [](const auto& o) { return o.name == "DoorRoom_E"; });
  ASSERT_NE(door, list.end());
  const std::uint32_t part = objects.part_of[static_cast<std::size_t>(door - list.begin())];

  scene::Scene without = scenario.scene;
  std::erase_if(without.objects, [](const auto& o) { return o.name == "DoorRoom_E"; });
  const Voxels open = load_or_voxelize(without, layout, {}).value_or_throw();
  ASSERT_NE(open.grid.count_solid(), scenario.voxels.grid.count_solid());

  voxel::PatchedPlanes planes(scenario.voxels.planes);
  const auto expect_same = [&](const Voxels& expected) {
    std::uint64_t voxels_differ = 0, planes_differ = 0;
    for_each_in({glm::ivec3(0), layout.size}, [&](glm::ivec3 v) {
      voxels_differ += objects.level.grid().solid(v) != expected.grid.solid(v);
    });
    for_each_in({glm::ivec3(-1), layout.size}, [&](glm::ivec3 cell) {
      const auto p = planes.at(cell), q = expected.planes.at(cell);
      planes_differ += !std::equal(p.begin(), p.end(), q.begin(), q.end());
    });
    EXPECT_EQ(voxels_differ, 0u);
    EXPECT_EQ(planes_differ, 0u);
  };
  for (const bool shown : {false, true}) {
    const voxel::LevelChange change = objects.level.show({&part, 1}, shown);
    planes.add(std::make_shared<const voxel::PlanePatch>(voxel::PlanePatch{change.cells, change.planes}));
    expect_same(shown ? scenario.voxels : open);
  }
}

TEST(Motel, AWalkerClimbsAndDescendsItsStairs) {
  if (!std::filesystem::exists(motel()))
    GTEST_SKIP() << motel() << " is not there; set BRUME_MOTEL to its folder";
  const auto triangles = world_triangles(scene::load_scene(motel()).value_or_throw());
  for (const GridLayout& layout : {GridLayout{{120, 20, 120}, 0.5f, glm::vec3(-30, 0, -30)},
                                   GridLayout{{240, 40, 240}, 0.25f, glm::vec3(-30, 0, -30)}}) {
    const BitGrid grid = voxel::voxelize(triangles, layout).value_or_throw();
    Walker walker;
    walker.put(grid, {-29.3f, 2.6f, 7.5f});
    for (int i = 0; i < 30; ++i) walker.move(grid, {}, 1.0 / 60);
    const float low = walker.feet_world().y;
    for (int i = 0; i < 110; ++i) walker.move(grid, {{1, 0, 0}, false, false}, 1.0 / 60);
    EXPECT_GT(walker.feet_world().x, -23.5f);
    EXPECT_GT(walker.feet_world().y, low + 3.9f) << "nine steps of half a metre";
    for (int i = 0; i < 110; ++i) {
      walker.move(grid, {{-1, 0, 0}, false, false}, 1.0 / 60);
      EXPECT_TRUE(walker.on_ground()) << i;
    }
    EXPECT_NEAR(walker.feet_world().y, low, 1e-4);
  }
}

}  // namespace
}  // namespace brume::scenario
