// Where the mesh is that a decal's occlusion was baked of, as the volume alone shows it.
#include <gtest/gtest.h>

#include <cmath>

#include "grids/files/slice_atlas.hpp"
#include "scenario/slice_volumes.hpp"
#include "tests/image/image_test_tools.hpp"

namespace brume::scenario {
namespace {

class DecalOccluderTest : public testing::Test {
 protected:
  static constexpr double kRadius = 0.6;
  const glm::dvec3 middle_{0.4, -0.3, 0.2};

  /// What a sphere hides from planes that face up (1) or down (-1): all inside of it; outside the disk under
  /// which it appears, times the cosine, where the horizon does not cut it, which weighs nothing here.
  double hidden(glm::dvec3 p, double side) const {
    const glm::dvec3 to = middle_ - p;
    const double distance = glm::length(to);
    if (distance <= kRadius) return 1;
    return std::max(0.0, side * to.y / distance) * kRadius * kRadius / (distance * distance);
  }
  SliceVolume load(const std::string& grid) const {
    grids::SliceAtlas atlas;
    atlas.layout.size = glm::uvec3(48, 40, 44);
    atlas.layout.columns = 8;
    atlas.depth = grids::AtlasDepth::unorm16;
    for (const double side : {1.0, -1.0}) {
      grids::DenseGrid dense;
      dense.name = side > 0 ? "up" : "down";
      dense.size = atlas.layout.size;
      dense.box = {glm::dvec3(-2), glm::dvec3(2)};
      for (std::uint32_t z = 0; z < dense.size.z; ++z)
        for (std::uint32_t y = 0; y < dense.size.y; ++y)
          for (std::uint32_t x = 0; x < dense.size.x; ++x)
            dense.values.push_back(static_cast<float>(
                hidden(dense.box.low + dense.voxel_size() * (glm::dvec3(x, y, z) + 0.5), side)));
      atlas.channels.push_back(dense);
      atlas.ranges.emplace_back();
    }
    grids::save_slice_atlas(folder_.path() / "ball.json", atlas).value_or_throw();
    scene::Timeline timeline;
    timeline.decals.resize(1);
    timeline.decals[0].file = folder_.path() / "ball.json";
    timeline.decals[0].grid = grid;
    return load_slice_volumes(timeline).value_or_throw().of_decals.at(0);
  }
  const cli::WorkFolder folder_;
};

// The deviation of places in a ball is sqrt(3 / 5) of its radius. Voxels on its surface are inside or
// outside: of 0.1 m, their centres are up to 0.05 m off along each axis, which moves the mean by far less.
TEST_F(DecalOccluderTest, IsFoundFromUpAndDown) {
  const SliceVolume found = load("");
  EXPECT_LT(glm::distance(glm::dvec3(found.middle), middle_), 0.05);
  EXPECT_NEAR(double{found.radius}, std::sqrt(2 * 0.6) * kRadius, 0.05);
}

TEST_F(DecalOccluderTest, IsUnknownOfOneGrid) {
  EXPECT_EQ(load("up").radius, 0);
}

}  // namespace
}  // namespace brume::scenario
