#include "scenario/voxel_cache.hpp"

#include <gtest/gtest.h>

#include "core/file.hpp"
#include "tests/log_lines.hpp"
#include "tests/work_folder.hpp"

namespace brume::scenario {
namespace {

using glm::vec3;
using voxel::BitGrid;
using voxel::GridLayout;

// A floor and one loose triangle.
scene::Scene small_scene() {
  scene::Scene scene;
  scene::Mesh mesh;
  for (const vec3 p : {vec3(-1, 0.1f, -1), vec3(2, 0.1f, -1), vec3(2, 0.1f, 2), vec3(-1, 0.1f, 2),
                       vec3(0, 1.5f, 0), vec3(1, 2, 0.5f), vec3(0.2f, 1.1f, 1)})
    mesh.vertices.emplace_back().position = p;
  mesh.indices = {0, 2, 1, 0, 3, 2, 4, 5, 6};
  scene.meshes.push_back(mesh);
  scene.objects.emplace_back().mesh = 0;
  return scene;
}

const GridLayout kFrame{{11, 7, 9}, 0.4f, vec3(-1.3f, -0.4f, -1.1f)};

void expect_same(const BitGrid& a, const BitGrid& b) {
  ASSERT_EQ(a.layout(), b.layout());
  for (int z = 0; z < a.size().z; ++z)
    for (int y = 0; y < a.size().y; ++y)
      for (int x = 0; x < a.size().x; ++x) ASSERT_EQ(a.solid({x, y, z}), b.solid({x, y, z}));
}

class VoxelCache : public testing::Test {
 protected:
  const cli::WorkFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "scene.vxl";
};

TEST_F(VoxelCache, SecondRunLoadsTheCache) {
  const LogLines log(LogLevel::warning);
  const auto first = load_or_voxelize(small_scene(), kFrame, path_);
  const auto second = load_or_voxelize(small_scene(), kFrame, path_);
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(first->cached);
  EXPECT_TRUE(second->cached);
  EXPECT_EQ(second->milliseconds, 0);
  EXPECT_EQ(second->triangles, 3u);
  expect_same(first->grid, second->grid);
  EXPECT_EQ(first->planes, second->planes);
  EXPECT_TRUE(log.lines.empty());
}

TEST_F(VoxelCache, RebuildsWhenAVertexObjectOrGridMoves) {
  const LogLines log(LogLevel::warning);
  const auto cached = [&](const scene::Scene& scene, const GridLayout& layout) {
    const auto voxels = load_or_voxelize(scene, layout, path_);
    return voxels && voxels->cached;
  };
  scene::Scene scene = small_scene();
  GridLayout layout = kFrame;
  EXPECT_FALSE(cached(scene, layout));
  EXPECT_TRUE(cached(scene, layout));
  scene.meshes[0].vertices[4].position.x += 0.001f;
  EXPECT_FALSE(cached(scene, layout));
  EXPECT_TRUE(cached(scene, layout));
  scene.objects[0].world_from_mesh[3].y += 0.001f;
  EXPECT_FALSE(cached(scene, layout));
  layout.size.x += 1;
  EXPECT_FALSE(cached(scene, layout));
  layout.voxel_size = 0.41f;
  EXPECT_FALSE(cached(scene, layout));
  layout.origin_world.z += 0.1f;
  EXPECT_FALSE(cached(scene, layout));
  EXPECT_TRUE(cached(scene, layout));
  EXPECT_TRUE(log.lines.empty());
}

TEST_F(VoxelCache, RebuildsDamagedAndForeignFilesWithOneWarning) {
  ASSERT_TRUE(load_or_voxelize(small_scene(), kFrame, path_));
  const auto whole = read_file(path_);
  ASSERT_TRUE(whole);
  std::vector<std::vector<std::byte>> bad(4, *whole);
  bad[0].resize(bad[0].size() / 2);
  bad[1][100] ^= std::byte{4};
  bad[2].clear();
  bad[3].assign(500, std::byte{'x'});
  for (const auto& bytes : bad) {
    ASSERT_TRUE(write_file_atomic(path_, bytes));
    const LogLines log(LogLevel::warning);
    const auto voxels = load_or_voxelize(small_scene(), kFrame, path_);
    ASSERT_TRUE(voxels);
    EXPECT_FALSE(voxels->cached);
    EXPECT_EQ(log.lines.size(), 1u);
    EXPECT_TRUE(log.has("scene.vxl"));
    EXPECT_EQ(*read_file(path_), *whole);
  }
}

TEST_F(VoxelCache, FailsWhereTheCacheCannotBeWritten) {
  const auto voxels = load_or_voxelize(small_scene(), kFrame, folder_.path() / "none" / "scene.vxl");
  ASSERT_FALSE(voxels);
  EXPECT_NE(voxels.failure().message.find("none"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace brume::scenario
