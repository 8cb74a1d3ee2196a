// The real scene, where it is there.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "scene/load.hpp"
#include "stage/world_triangles.hpp"
#include "tests/reference/triangle_box.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/voxelize.hpp"

namespace brume::stage {
namespace {

using voxel::BitGrid;
using voxel::GridFrame;
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
  const auto scene = scene::load_scene(motel());
  ASSERT_TRUE(scene) << scene.failure().message;
  const std::vector<Triangle> triangles = world_triangles(*scene);
  const GridFrame frame{{120, 20, 120}, 0.5f, glm::vec3(-30, 0, -30)};
  const auto grid = voxel::voxelize(triangles, frame);
  ASSERT_TRUE(grid);

  // Each triangle against the voxels of its box and a rim around.
  BitGrid expected(frame);
  for (const Triangle& t : triangles) {
    std::array<glm::dvec3, 3> in_voxels{(glm::dvec3(t.a) - glm::dvec3(frame.origin_world)) / 0.5,
                                        (glm::dvec3(t.b) - glm::dvec3(frame.origin_world)) / 0.5,
                                        (glm::dvec3(t.c) - glm::dvec3(frame.origin_world)) / 0.5};
    const glm::dvec3 last(frame.size - 1);
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
  for (int z = 0; z < frame.size.z; ++z)
    for (int y = 0; y < frame.size.y; ++y)
      for (int x = 0; x < frame.size.x; ++x) {
        missed += expected.solid({x, y, z}) && !grid->solid({x, y, z});
        extra += !expected.solid({x, y, z}) && grid->solid({x, y, z});
      }
  EXPECT_EQ(missed, 0u);
  EXPECT_EQ(extra, 0u);

  const SurfacePlanes planes = SurfacePlanes::build(triangles, *grid);
  EXPECT_GT(planes.cell_count(), grid->count_solid() / 2);
}

}  // namespace
}  // namespace brume::stage
