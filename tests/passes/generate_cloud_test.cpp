#include "passes/generate_cloud.hpp"

#include <random>

#include "grids/generate.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/reference/cloud.hpp"

namespace brume::passes {
namespace {

using grids::CloudKind, grids::CloudSettings;

class GenerateCloudTest : public gpu::GpuTest {
 protected:
  /// All bricks of the cube.
  static std::vector<glm::ivec3> bricks_of(int edge) {
    std::vector<glm::ivec3> bricks;
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3((edge + 7) / 8)},
                [&](glm::ivec3 brick) { bricks.push_back(8 * brick); });
    return bricks;
  }

  CloudGenerator generator_{context()};
};

// CPU and device each stay within cloud_depth_error of the formula. The sign of a depth, and with it a binary
// density, is certain beyond that.
TEST_F(GenerateCloudTest, EqualsTheProcessor) {
  for (const CloudKind kind : {CloudKind::pyroclastic, CloudKind::sphere, CloudKind::slab, CloudKind::torus})
    for (const int edge : {1, 7, 33})
      for (const double edge_width : {0.0, 0.4}) {
        CloudSettings settings;
        settings.kind = kind;
        settings.edge = static_cast<std::uint32_t>(edge);
        settings.voxel_size = 0.2;
        settings.radius = 0.06 * edge;
        settings.edge_width = edge_width;
        settings.seed = 11;
        const shared::CloudParams params = grids::cloud_params(settings);
        const std::vector<glm::ivec3> bricks = bricks_of(edge);
        std::vector<float> expected(bricks.size() * grids::kBrickVoxels), values(expected.size());
        grids::evaluate_cloud(params, bricks, expected);
        generator_.evaluate(runner(), params, bricks, values);

        int uncertain = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
          const auto voxel = static_cast<int>(i % grids::kBrickVoxels);
          const glm::ivec3 at =
              bricks[i / grids::kBrickVoxels] + glm::ivec3(voxel & 7, voxel >> 3 & 7, voxel >> 6);
          const glm::dvec3 p = (glm::dvec3(at) - 0.5 * (edge - 1)) * double{params.voxel_size};
          const double error = 2 * reference::cloud_depth_error(params.shape, p);
          if (edge_width > 0) {
            ASSERT_NEAR(values[i], expected[i], error / edge_width) << "kind " << int(kind) << " voxel " << i;
          } else if (values[i] != expected[i]) {
            ASSERT_LT(std::abs(reference::cloud_depth(params.shape, p)), error) << "kind " << int(kind);
            ++uncertain;
          }
        }
        EXPECT_LE(uncertain, 8);
      }
}

TEST_F(GenerateCloudTest, MakesAGridOfMoreBricksThanARecordTakes) {
  CloudSettings settings;
  settings.edge = 24;
  settings.voxel_size = 0.2;
  settings.radius = 1.2;
  settings.seed = 2;
  const grids::Grid grid = grids::generate_cloud(
      settings, [&](const shared::CloudParams& params, std::span<const glm::ivec3> bricks,
                    std::span<float> values) { generator_.evaluate(runner(), params, bricks, values); });
  EXPECT_EQ(grid.bricks.size(), grids::generate_cloud(settings).bricks.size());

  std::vector<glm::ivec3> many(GenerateCloudPass::kMaxBricks + 3, glm::ivec3(8));
  std::vector<float> values(many.size() * grids::kBrickVoxels, -1.0f);
  generator_.evaluate(runner(), grids::cloud_params(settings), many, values);
  for (const std::size_t brick : {many.size() - 4, many.size() - 3, many.size() - 1})
    EXPECT_EQ(std::memcmp(values.data(), values.data() + brick * grids::kBrickVoxels,
                          grids::kBrickVoxels * sizeof(float)),
              0)
        << brick;
}

}  // namespace
}  // namespace brume::passes
