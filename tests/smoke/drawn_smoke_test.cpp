// Smoke as it is drawn, along lines of sight.
#include "smoke/drawn_smoke.hpp"

#include <gtest/gtest.h>

#include "core/tasks.hpp"
#include "smoke/noise_look.hpp"
#include "tests/smoke/sight_scene.hpp"

namespace brume::smoke {
namespace {

class DrawnSmokeTest : public testing::TestWithParam<std::uint32_t> {
 protected:
  DrawnSmokeTest() : scene_(GetParam(), 9) {
    std::mt19937 random(5);
    for (int i = 0; i < 300; ++i) segments_.push_back(SightScene::segment(random));
  }
  DrawnSmoke drawn(const NoiseLook& look) const {
    SmokeInput input{
        .volume = &scene_.volume(), .state = &scene_.state(), .holes = scene_.holes(), .time = scene_.time()};
    set_noise(input.look, look);
    return {input, smoke_noise, &scene_.masks()};
  }
  std::vector<float> depths(const Sight& sight) const {
    std::vector<float> out(segments_.size());
    sight.optical_depths(segments_, out).value_or_throw();
    return out;
  }

  SightScene scene_;
  std::vector<Segment> segments_;
};

// Midpoints see where a line enters smoke, a wall or a hole up to half a step too early or too late.
TEST_P(DrawnSmokeTest, WithoutNoiseItIsTheSmokeOfQueries) {
  const NoiseLook look{.erosion = 0, .hole_rim = 0};
  const DrawnSmoke smoke = drawn(look);
  const auto expected = depths(scene_.sight({.extinction = 1}));
  const auto found = depths(scene_.sight({.extinction = 1, .drawn = &smoke}));
  const float texel = look.noise_size * 4 / (5.3f * 128), step = 2 * texel;
  double sum = 0, difference = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    // Of the nine holes, three clouds and some walls that a line may pass, each with two ends.
    EXPECT_NEAR(found[i], expected[i], 20 * step) << i;
    sum += double{expected[i]};
    difference += double{found[i]} - double{expected[i]};
  }
  EXPECT_GT(sum, 100);
  EXPECT_NEAR(difference / sum, 0, 0.002) << "as often too early as too late";
}

TEST_P(DrawnSmokeTest, StepsAreShortEnoughForDetail) {
  const DrawnSmoke smoke = drawn({});
  const auto found = depths(scene_.sight({.extinction = 1, .drawn = &smoke}));
  double most = 0, squares = 0, sum = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const glm::dvec3 a(segments_[i].a_world), b(segments_[i].b_world);
    const int count = static_cast<int>(std::ceil(glm::distance(a, b) / 0.001));
    double fine = 0;
    for (int k = 0; k < count; ++k) fine += double{smoke.density(glm::vec3(a + (k + 0.5) / count * (b - a)))};
    fine *= glm::distance(a, b) / count;
    const double off = double{found[i]} - fine;
    most = std::max(most, std::abs(off));
    squares += off * off;
    sum += fine;
  }
  std::printf("of %.3f m on average off by %.4f m at most, %.4f m in root mean square\n",
              sum / static_cast<double>(found.size()), most,
              std::sqrt(squares / static_cast<double>(found.size())));
  // Six surfaces of full smoke (clouds, walls, holes), each half a step of 1.77 cm too early or too late.
  EXPECT_LT(most, 6 * 0.5 * 0.0177);
}

TEST_P(DrawnSmokeTest, IsTheSameAloneAmongManyAndOnAnyNumberOfThreads) {
  const DrawnSmoke smoke = drawn({});
  const Sight sight = scene_.sight({.drawn = &smoke});
  set_thread_count(1);
  const auto one = depths(sight);
  set_thread_count(0);
  // Its displacements are found from several threads at once.
  const DrawnSmoke again = drawn({});
  EXPECT_EQ(depths(scene_.sight({.drawn = &again})), one);
  std::vector<std::uint8_t> visible(segments_.size());
  sight.visible(segments_, 1.5f, visible).value_or_throw();
  int seen = 0;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    EXPECT_EQ(sight.optical_depth(s.a_world, s.b_world).value_or_throw(), one[i]);
    const bool clear = !sight.first_wall(s.a_world, s.b_world).value_or_throw() && one[i] <= 1.5f;
    EXPECT_EQ(visible[i] != 0, clear);
    EXPECT_EQ(sight.visible(s.a_world, s.b_world, 1.5f).value_or_throw(), clear);
    seen += clear;
  }
  EXPECT_GT(seen, 10);
  EXPECT_LT(seen, 290);
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutWalls, DrawnSmokeTest, testing::Values(2u, 3u));

// Noise takes from thin smoke and gives to full smoke as much as it takes.
TEST(DrawnSmoke, FullSmokeKeepsItsDepth) {
  const voxel::BitGrid grid{{glm::ivec3(32), 0.5f, glm::vec3(0)}};
  const voxel::SurfacePlanes planes;
  sim::World world{grid};
  sim::ThrowSmoke thrown;
  thrown.from = thrown.at = sim::position_from_metres({8, 8, 8});
  thrown.smoke.voxels = 12000;
  world.append(thrown).value_or_throw();
  world.advance_to(300);
  SmokeVolume volume{grid, planes};
  volume.update(world);
  SmokeInput input{
      .volume = &volume, .state = &world.state(), .holes = {}, .time = world.state().seconds(300)};
  set_noise(input.look, {});
  const DrawnSmoke drawn(input, smoke_noise, nullptr);
  const Sight smooth(volume, grid, {}, input.time, {.extinction = 1});
  const Sight eroded(volume, grid, {}, input.time, {.extinction = 1, .drawn = &drawn});
  std::mt19937 random(6);
  std::uniform_real_distribution<float> inside(5, 11);
  double depths = 0, drawn_depths = 0, most = 0;
  int count = 0;
  for (int tries = 0; tries < 10000 && count < 200; ++tries) {
    const glm::vec3 a(inside(random), inside(random), inside(random));
    const glm::vec3 b(inside(random), inside(random), inside(random));
    if (glm::distance(a, b) < 3) continue;
    const double depth = double{smooth.optical_depth(a, b).value_or_throw()};
    if (depth < 0.99 * double{glm::distance(a, b)}) continue;
    const double with = double{eroded.optical_depth(a, b).value_or_throw()};
    depths += depth, drawn_depths += with, ++count;
    most = std::max(most, std::abs(with / depth - 1));
  }
  std::printf("%d lines of full smoke: %.3f of the depth, off by up to %.3f\n", count, drawn_depths / depths,
              most);
  ASSERT_EQ(count, 200);
  EXPECT_NEAR(drawn_depths / depths, 1, 0.05);
  EXPECT_LT(most, 0.25);
}

}  // namespace
}  // namespace brume::smoke
