#include <algorithm>
#include <random>

#include "brume_test_shaders.hpp"
#include "passes/sky_light.hpp"
#include "shared/frame.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/passes/probes.h"
#include "tests/reference/sky_light.hpp"
#include "voxel/traverse.hpp"

namespace brume::passes {
namespace {

using voxel::BitGrid;
using voxel::GridLayout;

void fill(BitGrid& grid, glm::ivec3 low, glm::ivec3 high, bool solid) {
  for_each_in({low, high}, [&](glm::ivec3 v) { grid.set(v, solid); });
}

/// A hollow box with walls of one voxel, and a window in its wall of high x.
BitGrid room(const GridLayout& frame, glm::ivec3 low, glm::ivec3 high, bool window) {
  BitGrid grid(frame);
  fill(grid, low, high, true);
  fill(grid, low + 1, high - 1, false);
  if (window) fill(grid, {high.x - 1, low.y + 3, low.z + 3}, {high.x, high.y - 3, high.z - 3}, false);
  return grid;
}

class LevelLightTest : public gpu::GpuTest {
 protected:
  /// Uploads a level and lights it.
  bool show(const LevelView& level) {
    solid_.reserve(level);
    sky_.reserve(solid_);
    shared::FrameConstants frame{};
    frame.solid = solid_.layout();
    frame_ = upload(std::vector{frame});
    bool changed = false;
    runner().run([&](gpu::Recorder& recorder) {
      changed = solid_.record(recorder, level);
      if (changed) sky_.record(recorder, frame_, solid_);
    });
    return changed;
  }

  struct Answers {
    std::vector<float> free;
    std::vector<glm::vec4> sky;
  };
  Answers ask(const std::vector<glm::vec3>& pairs) {
    const gpu::ComputePipeline pipeline(context(), shaders::level_probe_comp);
    const gpu::Sampler linear(context(), {});
    const std::size_t count = pairs.size() / 2;
    const auto in = upload(pairs);
    const auto free = upload(std::vector<float>(count)), sky = upload(std::vector<glm::vec4>(count));
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(pipeline, {{shared::kBindFrame, gpu::uniform(frame_)},
                               {shared::kBindSolidTexels, gpu::sampled(solid_.texels(), linear)},
                               {shared::kBindSkyLight, gpu::sampled(sky_.light(), linear)},
                               {shared::kBindProbeIn, gpu::read(in)},
                               {shared::kBindProbeOut, gpu::write(free)},
                               {shared::kBindProbeOut2, gpu::write(sky)}});
      recorder.dispatch_threads(pipeline, static_cast<std::uint32_t>(count));
    });
    return {read_back<float>(free, count), read_back<glm::vec4>(sky, count)};
  }

  /// Whether each texel is solid, by the texture and by the words, which must agree.
  std::vector<bool> solid_texels() {
    const auto texels = read_back<std::uint8_t>(solid_.texels());
    const auto words = read_back<std::uint32_t>(solid_.words(), solid_.word_count());
    const glm::ivec3 size = solid_.layout().size;
    std::vector<bool> solid;
    for_each_in({glm::ivec3(0), size}, [&](glm::ivec3 t) {
      const int word = t.x / 32 + shared::solid_row_words(size.x) * (t.y + size.y * t.z);
      const bool bit = words[static_cast<std::size_t>(word)] >> (t.x % 32) & 1;
      EXPECT_EQ(texels[solid.size()], bit ? 0 : 255);
      solid.push_back(bit);
    });
    return solid;
  }
  std::vector<bool> solid_voxels(const BitGrid& grid) {
    std::vector<bool> solid;
    for_each_in({glm::ivec3(0), grid.size()}, [&](glm::ivec3 v) { solid.push_back(grid.solid(v)); });
    return solid;
  }

  SolidVolume solid_{context()};
  SkyLightPass sky_{context()};
  gpu::Buffer frame_;
};

TEST_F(LevelLightTest, TheVolumeIsTheGridAndFollowsItsEdits) {
  std::mt19937 random(3);
  for (const glm::ivec3 size :
       {glm::ivec3(1), glm::ivec3(7, 7, 7), glm::ivec3(33, 17, 5), glm::ivec3(64, 3, 40)}) {
    BitGrid grid({size, 0.5f, {-1, -2, -3}});
    for_each_in({glm::ivec3(0), size}, [&](glm::ivec3 v) { grid.set(v, random() % 3 == 0); });
    EXPECT_TRUE(show({&grid, nullptr}));
    EXPECT_EQ(solid_texels(), solid_voxels(grid));
    EXPECT_FALSE(show({&grid, nullptr}));

    // A door in the middle opens; it shuts while another one opens.
    BitGrid later = grid;
    const auto one = std::make_shared<const sim::EditBlocks>(
        sim::effective_edits(grid, sim::edit_box(grid.layout(), size / 3, size / 2 + 1, false)));
    sim::apply_edits(later, *one);
    show({&later, one});
    EXPECT_EQ(solid_texels(), solid_voxels(later));
    BitGrid last = grid;
    const auto other = std::make_shared<const sim::EditBlocks>(sim::effective_edits(
        grid, sim::edit_box(grid.layout(), glm::ivec3(0), glm::ivec3(1), !grid.solid({0, 0, 0}))));
    sim::apply_edits(last, *other);
    EXPECT_TRUE(show({&last, other}));
    EXPECT_EQ(solid_texels(), solid_voxels(last));
  }
}

TEST_F(LevelLightTest, AnotherLevelOrNoneTakesThePlaceOfOne) {
  BitGrid one({{33, 17, 5}, 0.5f, {}}), other = one;
  fill(one, {3, 0, 0}, {9, 17, 5}, true);
  fill(other, {20, 4, 1}, {33, 9, 4}, true);
  show({&one, nullptr});
  solid_.invalidate();
  EXPECT_TRUE(show({&other, nullptr}));
  EXPECT_EQ(solid_texels(), solid_voxels(other));
  EXPECT_TRUE(show({}));
  EXPECT_EQ(std::ranges::count(solid_texels(), true), 0);
  EXPECT_FALSE(show({}));
  EXPECT_TRUE(show({&other, nullptr}));
  EXPECT_EQ(solid_texels(), solid_voxels(other));
}

TEST_F(LevelLightTest, ATexelOfManyVoxelsIsSolidWhereAWallRunsThrough) {
  // 2 voxels a texel; walls of one voxel at odd places stay without gaps.
  BitGrid grid({{300, 10, 20}, 0.5f, {}});
  fill(grid, {0, 0, 7}, {300, 10, 8}, true);
  fill(grid, {151, 0, 0}, {152, 10, 20}, true);
  ASSERT_TRUE(show({&grid, nullptr}));
  ASSERT_EQ(solid_.layout().size, glm::ivec3(150, 5, 10));
  EXPECT_EQ(solid_.layout().texel_size, 1.0f);
  const auto solid = solid_texels();
  std::size_t i = 0;
  for_each_in({glm::ivec3(0), solid_.layout().size},
              [&](glm::ivec3 t) { EXPECT_EQ(solid[i++], t.z == 3 || t.x == 75) << t.x << " " << t.z; });
}

TEST_F(LevelLightTest, AWayIsFreeWhereTheTraversalMeetsNothing) {
  std::mt19937 random(5);
  BitGrid grid({{40, 21, 33}, 0.25f, {-5, 0, 2}});
  for (int i = 0; i < 250; ++i) grid.set({random() % 40, random() % 21, random() % 33}, true);
  show({&grid, nullptr});
  std::uniform_real_distribution<float> place(-0.2f, 1.2f);
  const auto point = [&] {
    return grid.layout().origin_world + glm::vec3(place(random), place(random), place(random)) * 10.0f;
  };
  std::vector<glm::vec3> pairs;
  for (int i = 0; i < 4000; ++i) pairs.push_back(point());
  const auto answers = ask(pairs);

  std::size_t free = 0, unsure = 0;
  for (std::size_t i = 0; i < answers.free.size(); ++i) {
    const glm::vec3 from = voxel_from_world(grid.layout(), pairs[2 * i]),
                    to = voxel_from_world(grid.layout(), pairs[2 * i + 1]);
    const float way = glm::length(to - from);
    // Blocked surely, or perhaps: rounding may take a voxel's end across the limit.
    bool surely = false, perhaps = false;
    voxel::visit_voxels(grid.layout(), from, (to - from) / way, way,
                        [&](glm::ivec3 v, float enter, float leave) {
                          if (!grid.solid(v)) return true;
                          const float inside =
                              std::min(leave, way - shared::kSolidEnds) - std::max(enter, shared::kSolidEnds);
                          surely = surely || inside > 1e-3f;
                          perhaps = perhaps || inside > -1e-3f;
                          return true;
                        });
    unsure += surely != perhaps;
    if (surely == perhaps) {
      EXPECT_EQ(answers.free[i], surely ? 0 : 1) << i;
    }
    free += answers.free[i] > 0;
  }
  EXPECT_GT(free, 200u);
  EXPECT_LT(free, 1800u);
  EXPECT_LT(unsure, 40u);
}

TEST_F(LevelLightTest, WithoutSolidVoxelsTheSkyIsSeenWhole) {
  const BitGrid grid({{33, 17, 5}, 0.5f, {}});
  for (const LevelView& level : {LevelView{}, LevelView{&grid, nullptr}}) {
    show(level);
    for (const glm::vec4& sky : ask({{1, 1, 1}, {}, {0, 0, 0}, {}, {40, -3, 7}, {}}).sky) {
      EXPECT_EQ(sky.x, 1);
      // As half floats: 0.75 and 0.375.
      EXPECT_NEAR(sky.y, 1.0f, 1e-3f);
      EXPECT_NEAR(sky.z, 0.5f, 1e-3f);
      EXPECT_NEAR(sky.w, 0.75f, 1e-3f);
    }
  }
}

TEST_F(LevelLightTest, DirectionsIntegratePolynomialsOverTheSphere) {
  // Moments of even powers: the integral of x^a y^b z^c over the sphere / 4 pi is
  // (a-1)!! (b-1)!! (c-1)!! / (a+b+c+1)!!; of any odd power 0.
  const auto odd_factorial = [](int n) {
    double product = 1;
    for (; n > 1; n -= 2) product *= n;
    return product;
  };
  for (int a = 0; a <= 9; ++a)
    for (int b = 0; a + b <= 9; ++b)
      for (int c = 0; a + b + c <= 9; ++c) {
        double sum = 0;
        for (std::uint32_t i = 0; i < shared::kSkyDirections; ++i) {
          const glm::dvec3 d(shared::sky_direction(i));
          sum += double{shared::sky_weight(i)} * std::pow(d.x, a) * std::pow(d.y, b) * std::pow(d.z, c);
        }
        const bool even = a % 2 == 0 && b % 2 == 0 && c % 2 == 0;
        const double expected = even ? odd_factorial(a - 1) * odd_factorial(b - 1) * odd_factorial(c - 1) /
                                           odd_factorial(a + b + c + 1)
                                     : 0;
        EXPECT_NEAR(sum, expected, 2e-6) << a << b << c;
      }
}

TEST_F(LevelLightTest, RaysAreThoseOfTheReference) {
  const BitGrid grid = room({{40, 13, 21}, 0.5f, {}}, {3, 1, 2}, {37, 11, 19}, true);
  show({&grid, nullptr});
  const auto rays = read_back<std::uint32_t>(sky_.rays(), solid_.word_count() * shared::kSkyDirections);
  std::size_t visible = 0, differ = 0;
  for (std::uint32_t i = 0; i < shared::kSkyDirections; ++i)
    for_each_in({glm::ivec3(0), grid.size()}, [&](glm::ivec3 v) {
      const auto word = static_cast<std::size_t>(v.x / 32 + 2 * (v.y + grid.size().y * v.z));
      const bool sees = rays[i * solid_.word_count() + word] >> (v.x % 32) & 1;
      const bool expected = reference::sees_sky_step_by_step(grid, v, glm::dvec3(shared::sky_direction(i)));
      visible += sees;
      differ += sees != expected;
    });
  EXPECT_GT(visible, 100000u);
  EXPECT_EQ(differ, 0u);
}

TEST_F(LevelLightTest, NothingOfTheSkyComesThroughThinWalls) {
  const GridLayout frame{{40, 24, 40}, 0.5f, {}};
  const BitGrid sealed = room(frame, {10, 4, 10}, {30, 20, 30}, false);
  show({&sealed, nullptr});
  std::mt19937 random(8);
  std::uniform_real_distribution<float> x(5.51f, 14.49f), y(2.51f, 9.49f);
  std::vector<glm::vec3> inside, outside;
  for (int i = 0; i < 500; ++i) {
    inside.insert(inside.end(), {{x(random), y(random), x(random)}, {}});
    outside.insert(outside.end(), {{1 + 3.9f * (x(random) - 5) / 10, y(random), x(random)}, {}});
  }
  for (const glm::vec4& sky : ask(inside).sky) EXPECT_EQ(sky.x, 0);
  // Outside by a wall: at least the half of the sky that the wall leaves, less the sky's own slope.
  for (const glm::vec4& sky : ask(outside).sky) EXPECT_GT(sky.x, 0.45f);
}

TEST_F(LevelLightTest, AWindowLetsInItsShareOfTheSky) {
  const GridLayout frame{{40, 24, 40}, 0.5f, {}};
  const BitGrid open = room(frame, {10, 4, 10}, {30, 20, 30}, true);
  show({&open, nullptr});
  // At voxel centres, where nothing is interpolated. A place counts whole rays, 1/32 of all directions each,
  // and so is right to about one of them at best; the mean over many places is held to one.
  double sum = 0, expected_sum = 0;
  int count = 0;
  for (int z = 12; z < 28; z += 3)
    for (int px = 12; px < 29; px += 4) {
      const glm::vec3 p_voxel = glm::vec3(px, 11, z) + 0.5f;
      const double got = static_cast<double>(ask({world_from_voxel(frame, p_voxel), {}}).sky[0].x);
      // The window lies around the horizon, where the sky is as bright as its mean.
      sum += got;
      expected_sum += reference::sky_fraction(open, glm::dvec3(p_voxel), 64);
      ++count;
    }
  EXPECT_NEAR(sum / count, expected_sum / count, 1.0 / 32);
  EXPECT_GT(expected_sum / count, 2.0 / 32);
}

}  // namespace
}  // namespace brume::passes
