#include "planning/volume_tables.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <glm/gtc/packing.hpp>

#include "planning/blackbody.hpp"
#include "planning/transfer_table.hpp"

namespace brume::planning {
namespace {

class VolumeTablesTest : public testing::Test {
 protected:
  VolumeTablesTest() {
    for (VolumeInput& volume : volumes_) {
      volume.heat.volume = &grid_;
      volume.transfer.opacity = {{0, 0}, {1, 1}};
      volume.look.albedo = glm::vec3(0.5f);
    }
  }
  std::vector<VolumeTables> update() {
    const auto tables = cache_.update(volumes_);
    return {tables.begin(), tables.end()};
  }

  volume::SparseVolume grid_{[] {
    volume::SparseVolumeInfo info;
    info.channels = {{2}};
    return info;
  }()};
  std::vector<VolumeInput> volumes_{2};
  VolumeTableCache cache_;
};

TEST_F(VolumeTablesTest, GlowRunsFromNothingToTheLargestValue) {
  const HeatInput heat{&grid_, glm::mat4(1), 1500, 2, 0.5f};
  const GlowTable table = glow_table(heat);
  ASSERT_EQ(table.size(), shared::kVolumeColors);
  EXPECT_EQ(table.front(), 0u);
  const glm::vec3 last(glm::unpackHalf4x16(table.back())), expected = 0.5f * blackbody_color(3000);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(last[c], expected[c], expected[c] / 1024);
}

TEST_F(VolumeTablesTest, AreTheSameWhileNothingTheyFollowFromChanges) {
  const auto first = update();
  volumes_[0].look.extinction = 7;
  volumes_[0].heat.world_from_voxel[3][0] = 1;
  const auto second = update();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(first[i].glow, second[i].glow);
    EXPECT_EQ(first[i].transfer, second[i].transfer);
  }
  EXPECT_EQ(*first[0].transfer, transfer_table(volumes_[0].transfer, volumes_[0].look.albedo));
}

TEST_F(VolumeTablesTest, FollowEachOfTheirInputs) {
  const std::function<void(VolumeInput&)> glow[] = {
      [](VolumeInput& v) { v.heat.kelvin = 1500; },
      [](VolumeInput& v) { v.heat.high = 3; },
      [](VolumeInput& v) { v.heat.emission = 2; },
  };
  for (const auto& change : glow) {
    const auto before = update();
    change(volumes_[1]);
    const auto after = update();
    EXPECT_NE(*before[1].glow, *after[1].glow);
    EXPECT_EQ(before[0].glow, after[0].glow);
    EXPECT_EQ(before[1].transfer, after[1].transfer);
  }
  const std::function<void(VolumeInput&)> transfer[] = {
      [](VolumeInput& v) { v.transfer.opacity[1].opacity = 0.5f; },
      [](VolumeInput& v) { v.look.albedo.g = 0.25f; },
  };
  for (const auto& change : transfer) {
    const auto before = update();
    change(volumes_[1]);
    const auto after = update();
    EXPECT_NE(*before[1].transfer, *after[1].transfer);
    EXPECT_EQ(before[1].glow, after[1].glow);
  }
}

TEST_F(VolumeTablesTest, AreOnlyWhereAVolumeNeedsThem) {
  update();
  volumes_[0].heat.volume = nullptr;
  volumes_[0].transfer = {};
  const auto without = update();
  EXPECT_FALSE(without[0].glow || without[0].transfer);
  EXPECT_TRUE(without[1].glow && without[1].transfer);
}

}  // namespace
}  // namespace brume::planning
