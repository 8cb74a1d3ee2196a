// What SmokeLightCache consists of, one by one: pages, lights, and the schedule of a frame.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "planning/light_reach.hpp"
#include "planning/smoke_light_schedule.hpp"

namespace brume::planning {
namespace {

shared::Light light_at(float x, float intensity = 1) {
  shared::Light light{};
  light.position_world = {x, 1, 0};
  light.intensity = glm::vec3(intensity);
  light.range = shared::light_range(intensity);
  return light;
}

TEST(SmokeLightPages, EachBrickHasANumberAndPagesOfItsOwn) {
  SmokeLightPages pages(100);
  std::set<std::uint32_t> numbers, first_pages;
  for (const std::uint32_t slot : {7u, 0u, 33u}) {
    LitBrick& brick = pages.acquire(slot, glm::ivec3(static_cast<int>(slot)));
    pages.allocate(brick.sky, 4);
    pages.allocate(SmokeLightPages::rays_to(brick, 2, 0), 1);
    numbers.insert(brick.number);
    first_pages.insert({brick.sky.page, brick.lights[0].page});
  }
  EXPECT_EQ(numbers, (std::set<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(first_pages, (std::set<std::uint32_t>{0, 4, 5, 9, 10, 14}));
  EXPECT_EQ(pages.page_count(), 15u);
  EXPECT_TRUE(pages.fits(85));
  EXPECT_FALSE(pages.fits(86));
  // What is there is found, and takes nothing more.
  EXPECT_EQ(pages.find(1), nullptr);
  EXPECT_EQ(pages.find(1000), nullptr);
  pages.allocate(pages.find(7)->sky, 4);
  pages.acquire(33, glm::ivec3(33));
  EXPECT_EQ(pages.page_count(), 15u);
  EXPECT_EQ(pages.brick_count(), 3u);
  pages.clear();
  EXPECT_EQ(pages.find(7), nullptr);
  EXPECT_TRUE(pages.fits(100));
}

TEST(SmokeLightPages, AnotherBrickInASlotKeepsThePagesAndNothingInThem) {
  SmokeLightPages pages(100);
  LitBrick& brick = pages.acquire(3, {1, 2, 3});
  pages.allocate(brick.sky, 4);
  CachedRays& rays = SmokeLightPages::rays_to(brick, 5, 0);
  pages.allocate(rays, 1);
  brick.is_listed = true;
  brick.list_version = brick.sky.list_version = rays.list_version = 9;
  EXPECT_EQ(pages.acquire(3, {1, 2, 3}).list_version, 9u);
  const LitBrick& other = pages.acquire(3, {4, 2, 3});
  EXPECT_EQ(other.brick, glm::ivec3(4, 2, 3));
  EXPECT_EQ(other.sky.page, 0u);
  EXPECT_EQ(other.lights[0].page, 4u);
  EXPECT_FALSE(other.is_listed);
  EXPECT_EQ(other.list_version + other.sky.list_version + other.lights[0].list_version, 0u);
}

TEST(SmokeLightPages, ForgetsOneLightOrAllRays) {
  SmokeLightPages pages(100);
  LitBrick& brick = pages.acquire(0, glm::ivec3(0));
  for (const std::uint32_t light : {0u, 1u}) {
    CachedRays& rays = SmokeLightPages::rays_to(brick, light, light);
    rays.list_version = 4;
    rays.dirty_phases = 0;
  }
  pages.forget_light(1);
  EXPECT_EQ(brick.lights[0].list_version, 4u);
  EXPECT_EQ(brick.lights[1].list_version, 0u);
  pages.invalidate_rays();
  EXPECT_EQ(brick.lights[0].dirty_phases, kAllLightPhases);
  EXPECT_EQ(brick.lights[0].list_version, 4u) << "which texels have rays stays known";
}

TEST(KnownLights, KeepTheirNumbersInAnyOrderAndBrightness) {
  KnownLights known;
  std::vector<shared::Light> lights;
  for (int i = 0; i < 5; ++i) lights.push_back(light_at(static_cast<float>(i)));
  known.match(lights);
  std::map<float, std::uint32_t> numbers;
  std::map<float, std::uint64_t> versions;
  for (std::uint32_t i = 0; i < 5; ++i) {
    numbers[known[i].light.position_world.x] = i;
    versions[known[i].light.position_world.x] = known[i].version;
  }
  std::minstd_rand random(1);
  for (int frame = 0; frame < 20; ++frame) {
    std::shuffle(lights.begin(), lights.end(), random);
    const float brighter = lights[0].position_world.x;
    lights[0].intensity += 1.0f;
    // Some frames lack some lights.
    const std::span<const shared::Light> some(lights.data(), 1 + random() % 5);
    known.match(some);
    EXPECT_TRUE(known.renumbered().empty());
    for (std::uint32_t i = 0; i < some.size(); ++i) {
      const float x = some[i].position_world.x;
      EXPECT_EQ(known[numbers[x]].in_frame, i);
      EXPECT_EQ(known[numbers[x]].version != versions[x], x == brighter || i == 0) << x;
      versions[x] = known[numbers[x]].version;
    }
  }
}

TEST(KnownLights, ANumberGoesToAnotherLightOnlyWhereManyCame) {
  KnownLights known;
  const std::vector<shared::Light> first{light_at(-1)};
  known.match(first);
  int renumbered = 0;
  // One light at a time: 32 more than a frame has are remembered.
  for (int frame = 0; frame < 40; ++frame) {
    known.match(std::vector{light_at(static_cast<float>(frame))});
    renumbered += static_cast<int>(known.renumbered().size());
    EXPECT_EQ(renumbered, std::max(frame - 31, 0));
    // The one that no frame had for the longest time.
    for (const std::uint32_t number : known.renumbered()) EXPECT_EQ(number, renumbered - 1u);
  }
}

/// The phases in which each frame updates a brick whose rays are all stale, by its texel ranges.
class SmokeLightScheduleTest : public ::testing::Test {
 protected:
  SmokeLightScheduleTest() { lights_.match(std::vector{light_at(0)}); }
  const SmokeLightPlan& frame(float fraction) {
    const std::uint32_t reaching[] = {0};
    schedule_.begin(fraction);
    pages_.invalidate_rays();
    schedule_.add(pages_.acquire(2, glm::ivec3(1)), reaching, lights_, stale_, pages_);
    schedule_.end_part(pages_);
    return schedule_.plan();
  }
  SmokeLightPages pages_{100};
  KnownLights lights_;
  StaleLight stale_;
  SmokeLightSchedule schedule_;
};

TEST_F(SmokeLightScheduleTest, AtOnceEverythingIsDoneOnceAndThenAgainWhereItIsStale) {
  for (int i = 0; i < 3; ++i) {
    const SmokeLightPlan& plan = frame(1);
    EXPECT_EQ(plan.texel_lists.size(), i == 0 ? 1u : 0u);
    EXPECT_EQ(plan.shadow_rays.size(), shared::kSkyPages + 1u);
    for (const shared::ShadowRays& rays : plan.shadow_rays) EXPECT_EQ(rays.texels, shared::kAllTexels);
    ASSERT_EQ(plan.gathers.size(), 1u);
    EXPECT_EQ(plan.gathers[0].light_count, 1u);
    ASSERT_EQ(plan.parts.size(), 1u);
    EXPECT_EQ(plan.parts[0].sliced_rays, 0u);
    EXPECT_EQ(plan.page_count, shared::kSkyPages + 1u);
  }
}

TEST_F(SmokeLightScheduleTest, SlicesCoverAllPhasesOnceInARound) {
  for (const std::uint32_t slices : {2u, 4u, 16u}) {
    const float fraction = 1 / static_cast<float>(slices);
    pages_.clear();
    // A brick that came into view is updated four times as fast, for one round of that.
    EXPECT_EQ(frame(fraction).parts[0].sliced_rays, 0u) << "the first frame has all texels";
    for (std::uint32_t i = 0; i < slices; ++i) frame(fraction);
    std::uint32_t covered = 0;
    for (std::uint32_t i = 0; i < slices; ++i) {
      const SmokeLightPlan& plan = frame(fraction);
      ASSERT_EQ(plan.gathers.size(), 1u);
      EXPECT_EQ(plan.parts[0].phases, shared::kLightPhases / slices);
      for (std::uint32_t phase = 0; phase < shared::kLightPhases; ++phase) {
        if (plan.gathers[0].texels !=
            shared::phase_range(phase & ~(plan.parts[0].phases - 1),
                                (phase & ~(plan.parts[0].phases - 1)) + plan.parts[0].phases))
          continue;
        EXPECT_FALSE(covered >> phase & 1);
        covered |= 1u << phase;
      }
    }
    EXPECT_EQ(covered, kAllLightPhases);
  }
}

}  // namespace
}  // namespace brume::planning
