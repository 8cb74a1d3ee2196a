#include "smoke/sight_packet.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>
#include <vector>

#include "smoke/sight_smoke.hpp"
#include "tests/smoke/sight_scene.hpp"

namespace brume::smoke {
namespace {

constexpr float kNeverEnough = std::numeric_limits<float>::infinity();

std::uint32_t bits(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

/// Every form of the step that this processor runs.
std::vector<StepPacket> steps() {
  std::vector<StepPacket> all{step_packet_4};
  if (fastest_step() != step_packet_4) all.push_back(fastest_step());
  return all;
}

/// Rays in every direction, and along axes and diagonals, through cells, on their faces and edges.
std::vector<SmokeRay> rays_through(const SightScene& scene, std::size_t count) {
  std::mt19937 random(11);
  const shared::VolumeLayout& layout = scene.volume().layout();
  std::vector<SmokeRay> rays;
  while (rays.size() < count) {
    Segment s = SightScene::segment(random);
    const auto kind = static_cast<int>(random() % 8);
    if (kind < 3) {  // along an axis
      const glm::vec3 b = s.b_world;
      s.b_world = s.a_world;
      s.b_world[kind] = b[kind];
    }
    if (kind % 2 == 1) {  // between whole and half voxels
      const auto snap = [&](glm::vec3 p) {
        return SightScene::kFrame.origin_world +
               0.5f * SightScene::kVoxel *
                   glm::round((p - SightScene::kFrame.origin_world) * (2 / SightScene::kVoxel));
      };
      s = {snap(s.a_world), snap(s.b_world)};
    }
    const glm::dvec3 origin(layout.origin_world);
    const double size = layout.voxel_size;
    const auto ray = clip_to_smoke(layout, (glm::dvec3(s.a_world) - origin) / size,
                                   (glm::dvec3(s.b_world) - origin) / size);
    if (ray) rays.push_back(*ray);
  }
  return rays;
}

class PacketTest : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  PacketTest() : scene_(GetParam(), 32), holes_(scene_.holes(), scene_.time(), &scene_.masks()) {}

  /// Any line through the scene's holes will do for a ray, if it is always the same.
  void find_holes(std::size_t number, const SmokeRay& ray, HolesOnRay& holes) const {
    std::mt19937 random(static_cast<std::uint32_t>(number));
    const Segment s = SightScene::segment(random);
    holes_.find(s.a_world, (s.b_world - s.a_world) / ray.length, ray.length, holes);
  }
  float one(std::size_t number, const SmokeRay& ray, bool holed, float enough) const {
    HolesOnRay holes;
    if (holed) find_holes(number, ray, holes);
    return smoke_on_ray(scene_.volume(), ray, holed ? &holes : nullptr, enough);
  }
  std::vector<float> many(const std::vector<SmokeRay>& rays, bool holed, float enough,
                          StepPacket step) const {
    std::vector<float> sums(rays.size(), -1);
    SmokePacket packet(scene_.volume(), holed, enough, sums, step);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::size_t lane = packet.free_lane();
      if (holed) find_holes(i, rays[i], packet.holes(lane));
      packet.start(lane, rays[i], i);
    }
    packet.finish();
    return sums;
  }

  SightScene scene_;
  HoleSet holes_;
};

TEST_P(PacketTest, GivesTheSameBitsAsOneRay) {
  for (const StepPacket step : steps()) {
    for (const std::size_t count : {0u, 1u, 7u, 16u, 17u, 2000u}) {
      const std::vector<SmokeRay> rays = rays_through(scene_, count);
      for (const bool holed : {false, true}) {
        const std::vector<float> sums = many(rays, holed, kNeverEnough, step);
        float whole = 0;
        for (std::size_t i = 0; i < count; ++i) {
          EXPECT_EQ(bits(sums[i]), bits(one(i, rays[i], holed, kNeverEnough))) << count << ' ' << i;
          whole += sums[i];
        }
        if (count > 1000) {
          EXPECT_GT(whole, 1000);
        }
      }
    }
  }
}

TEST_P(PacketTest, EndsARayThatHasEnough) {
  const std::vector<SmokeRay> rays = rays_through(scene_, 500);
  for (const StepPacket step : steps()) {
    for (const float enough : {0.0f, 0.7f, 3.0f}) {
      const std::vector<float> sums = many(rays, true, enough, step);
      for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_EQ(bits(sums[i]), bits(one(i, rays[i], true, enough))) << enough << ' ' << i;
    }
  }
}

// With walls and without.
INSTANTIATE_TEST_SUITE_P(Levels, PacketTest, ::testing::Values(1u, 2u, 4u));

}  // namespace
}  // namespace brume::smoke
