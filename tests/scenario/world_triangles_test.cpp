#include "scenario/world_triangles.hpp"

#include <gtest/gtest.h>

namespace brume::scenario {
namespace {

TEST(WorldTriangles, ContainsVoxelizedObjectsOnly) {
  scene::Scene scene;
  scene::Mesh mesh;
  mesh.vertices.resize(3);
  mesh.vertices[1].position = {1, 0, 0};
  mesh.vertices[2].position = {0, 1, 0};
  mesh.indices = {0, 1, 2};
  scene.meshes.push_back(mesh);
  scene::Object object;
  object.mesh = 0;
  object.world_from_mesh[3] = glm::vec4(5, 6, 7, 1);
  scene.objects.push_back(object);
  object.role = Role::ghost;
  scene.objects.push_back(object);
  const std::vector<voxel::Triangle> expected{{{5, 6, 7}, {6, 6, 7}, {5, 7, 7}}};
  EXPECT_EQ(world_triangles(scene), expected);
}

}  // namespace
}  // namespace brume::scenario
