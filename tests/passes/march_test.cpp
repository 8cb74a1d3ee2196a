#include "passes/march.hpp"

#include <cmath>
#include <optional>

#include "passes/resolve.hpp"
#include "shared/opaque.h"
#include "tests/passes/march_fixture.hpp"

namespace brume::passes {
namespace {

constexpr glm::uvec2 kImageSize{33, 17};

class MarchTest : public MarchFixture {
 protected:
  static shared::FrameConstants frame_at(const SmokeRoom& room, glm::vec3 eye) {
    return MarchFixture::frame_at(room, eye, {0.8f, 0.4f}, kImageSize);
  }
  static glm::vec3 ray(const shared::FrameConstants& frame, std::uint32_t pixel) {
    const glm::vec2 ndc =
        (glm::vec2(pixel % kImageSize.x, pixel / kImageSize.x) + 0.5f) / glm::vec2(kImageSize) * 2.0f - 1.0f;
    return frame.camera.forward + ndc.x * frame.camera.right - ndc.y * frame.camera.up;
  }

  /// Marches with a surface at `distance` along the view axis; radiance and transmittance of each pixel.
  std::vector<glm::vec4> march(const SmokeRoom& room, shared::FrameConstants frame, float distance,
                               const std::vector<shared::Hole>& holes = {}) {
    const std::vector<float> depth(kImageSize.x * kImageSize.y, frame.camera.near_z / distance);
    const auto depth_image = upload_image(context(), runner(), kImageSize, VK_FORMAT_R32_SFLOAT, depth);
    HoleClusters hole_clusters(context(), runner(), {});
    const auto plan =
        planning::plan_holes(holes, frame.time, 0, frame.smoke, room.volume.slot_count(), kImageSize);
    hole_clusters.reserve(plan);
    frame.holes = plan.layout();
    frame.media = planning::smoke_media(frame.smoke, frame.look);
    const auto frame_buffer = upload(std::vector{frame});
    const auto counters = upload(std::vector<std::uint32_t>{0});
    const auto target = test_image(context(), kImageSize, VK_FORMAT_R16G16B16A16_SFLOAT);
    runner().run([&](gpu::Recorder& recorder) {
      light_evenly(recorder, room);
      hole_clusters.record(recorder, plan, frame_buffer, room.upload.resources());
      march_.record(recorder, inputs(frame_buffer, room, depth_image, hole_clusters), target, counters);
    });
    samples_ = read_back<std::uint32_t>(counters, 1)[0];
    return from_half(read_back<Half4>(target));
  }

  const MarchPass march_{context(), {.count_samples = true}};
  std::uint32_t samples_ = 0;
};

/// Steps of a path through smoke of density 1: twice as long behind a quarter of the light, four times behind
/// a sixteenth.
std::uint32_t steps_of(float path, const shared::SmokeLook& look) {
  const auto factor_of = [](float transmittance) {
    return transmittance < 1.0f / 16 ? 4 : transmittance < 0.25f ? 2 : 1;
  };
  std::uint32_t steps = 0;
  float begin = 0, transmittance = 1;
  while (path - begin > 1e-3f) {
    const int factor = factor_of(transmittance);
    const float length = static_cast<float>(factor) * look.step_length;
    const float ds = (path - begin) / std::ceil((path - begin) / length);
    for (; path - begin > 1e-3f && factor_of(transmittance) == factor; ++steps) {
      begin += ds;
      transmittance *= std::exp(-look.extinction * ds);
    }
  }
  return steps;
}

class MarchConstantTest : public MarchTest {
 protected:
  const SmokeRoom& room_ = full_room();
};

TEST_F(MarchConstantTest, DensityIsOneEverywhere) {
  for (const glm::vec3 p :
       {glm::vec3(0.6f, 0.6f, 0.6f), glm::vec3(12, 8, 16), glm::vec3(23.4f, 16.4f, 32.4f)}) {
    EXPECT_EQ(smoke::sample_density(room_.volume, p), 1.0f);
  }
}

TEST_F(MarchConstantTest, IsBeerLambertAtFiveStepLengths) {
  auto frame = frame_at(room_, {0, 0, -0.5f});
  for (const float step : {0.05f, 0.1f, 0.2f, 0.5f, 1.3f}) {
    frame.look.step_length = step;
    constexpr float kDistance = 2.5f;
    const auto pixels = march(room_, frame, kDistance);
    for (std::uint32_t i = 0; i < pixels.size(); ++i) {
      const double path = static_cast<double>(kDistance * glm::length(ray(frame, i)));
      const double expected = std::exp(-0.7 * path);
      EXPECT_NEAR(pixels[i].w, expected, 0.01 * expected) << "step " << step << " pixel " << i;
      // Constant in-scatter: what is not let through is scattered light.
      EXPECT_NEAR(pixels[i].x, 0.5 * (1 - expected), 0.01 * 0.5);
      EXPECT_NEAR(pixels[i].z, 1 - expected, 0.01);
    }
  }
}

TEST_F(MarchConstantTest, CountsTheStepsOfEachRay) {
  auto frame = frame_at(room_, {0, 0, -0.5f});
  constexpr float kDistance = 4;
  const auto plain = march(room_, frame, kDistance);
  const std::uint32_t all = samples_;

  const MarchPass counting(context(), {.count_steps = true});
  const ResolvePass resolve(context());
  const auto depth =
      upload_image(context(), runner(), kImageSize, VK_FORMAT_R32_SFLOAT,
                   std::vector<float>(kImageSize.x * kImageSize.y, frame.camera.near_z / kDistance));
  const auto counters = upload(std::vector<std::uint32_t>(1 + kImageSize.x * kImageSize.y));
  const auto target = test_image(context(), kImageSize, VK_FORMAT_R16G16B16A16_SFLOAT);
  const HoleClusters no_holes(context(), runner(), {});
  for (const std::uint32_t scale : {1u, 2u, 4u}) {
    frame.march_scale = scale;
    frame.media = planning::smoke_media(frame.smoke, frame.look);
    const auto frame_buffer = upload(std::vector{frame});
    std::optional<MarchTiles> blocks;
    if (scale > 1) blocks.emplace(context(), kImageSize, scale);
    runner().run([&](gpu::Recorder& recorder) {
      light_evenly(recorder, room_);
      recorder.fill(counters, 0);
      const MarchPass::Inputs in = inputs(frame_buffer, room_, depth, no_holes);
      if (scale == 1) return counting.record(recorder, in, target, counters);
      resolve.record_ends(recorder, {frame_buffer, kImageSize}, depth, *blocks);
      counting.record_tiles(recorder, in, *blocks, counters);
    });
    const auto counted = read_back<std::uint32_t>(counters, 1 + kImageSize.x * kImageSize.y);
    // Where all is smoke, each step takes two samples: of the smoke, and of its light.
    std::uint32_t steps = 0;
    for (std::uint32_t i = 0; i < kImageSize.x * kImageSize.y; ++i) {
      const std::uint32_t x = i % kImageSize.x, y = i / kImageSize.x;
      if (x % scale == 0 && y % scale == 0) steps += counted[1 + i];
      EXPECT_EQ(counted[1 + i], counted[1 + x / scale * scale + kImageSize.x * (y / scale * scale)]);
      if (scale > 1) continue;
      EXPECT_EQ(counted[1 + i], steps_of(kDistance * glm::length(ray(frame, i)), frame.look)) << i;
    }
    EXPECT_EQ(counted[0], 2 * steps) << "scale " << scale;
    if (scale == 1) {
      EXPECT_EQ(counted[0], all);
      EXPECT_EQ(from_half(read_back<Half4>(target)), plain);
    }
  }
}

TEST_F(MarchConstantTest, StopsWhereItIsOpaque) {
  auto frame = frame_at(room_, {0, 0, -0.5f});
  frame.look.extinction = 10;
  const auto pixels = march(room_, frame, 12);
  const std::uint32_t all = samples_;
  frame.look.opaque_transmittance = 0.01f;
  const auto stopped = march(room_, frame, 12);
  EXPECT_LT(samples_, all / 5);
  for (std::uint32_t i = 0; i < pixels.size(); ++i) {
    EXPECT_EQ(stopped[i].w, 0);
    EXPECT_NEAR(stopped[i].x, pixels[i].x, 0.5 * 0.01);  // at most the share that was left
  }
}

// An optical depth of 8 leaves 3.4e-4: of a radiance of 1000 a third of what a display shows as white.
TEST_F(MarchConstantTest, GoesOnWhereWhatIsBehindIsBright) {
  auto frame = frame_at(room_, {0, 0, -0.5f});
  frame.look.extinction = 2;
  frame.look.opaque_transmittance = shared::opaque_below(0.004f, 1000);
  constexpr float kDistance = 4;
  const auto bright = march(room_, frame, kDistance);
  for (std::uint32_t i = 0; i < bright.size(); ++i) {
    const double expected = std::exp(-double{2 * kDistance * glm::length(ray(frame, i))});
    // A ray ends where 1/1024 of the display is left.
    const double tolerance = 0.02 * expected + (expected < 1e-6 * 1.02 ? expected : 0);
    EXPECT_NEAR(double{bright[i].w}, expected, tolerance) << i;
  }
}

TEST_F(MarchConstantTest, NothingBehindTheSurface) {
  const auto frame = frame_at(room_, {0, 0, 30});
  for (const glm::vec4& pixel : march(room_, frame, 20)) EXPECT_EQ(pixel, glm::vec4(0, 0, 0, 1));
}

TEST_F(MarchConstantTest, AHoleLetsThroughWhatItRemoves) {
  auto frame = frame_at(room_, {0, 0, -0.5f});
  frame.look.extinction = 2;
  const shared::Hole hole = open_hole(glm::vec3(0), {0, 0, -1}, 1, 20);
  frame.time = 1;
  constexpr std::uint32_t kCentre = 16 + 8 * kImageSize.x;
  // Down the axis everything is removed; at the picture's corner the ray leaves the hole early.
  const auto open = march(room_, frame, 4, {hole});
  EXPECT_GT(open[kCentre].w, 0.98f);
  const auto shut = march(room_, frame, 4);
  EXPECT_LT(shut[kCentre].w, 0.01f);
  EXPECT_LT(open[0].w, 0.1f);
  EXPECT_GE(open[0].w, shut[0].w);
}

TEST_F(MarchTest, StepLengthDoesNotChangeThePicture) {
  // A smoke with soft rims behind a gap in a wall.
  std::vector<voxel::Triangle> walls;
  add_quad(walls, {-5, -3, -6.05f}, {-0.6f, -3, -6.05f}, {-0.6f, 3, -6.05f}, {-5, 3, -6.05f});
  SmokeRoom room(context(), runner(), walls, {{40, 24, 40}, 0.25f, {-5, -3, -10.0f}}, {0, 0, -7}, 6000, 120);
  auto frame = frame_at(room, {0, 0, 0});
  frame.look.extinction = 2;
  frame.look.step_length = 0.1f;
  const auto fine = march(room, frame, 30);
  const std::uint32_t fine_samples = samples_;
  frame.look.step_length = 0.2f;
  const auto coarse = march(room, frame, 30);
  EXPECT_LT(samples_, 0.6 * fine_samples);
  double difference = 0, seen = 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    difference += static_cast<double>(std::abs(fine[i].w - coarse[i].w));
    seen += static_cast<double>(1 - fine[i].w);
  }
  EXPECT_LT(difference / static_cast<double>(fine.size()), 1.0 / 255);
  EXPECT_GT(seen, 50);
}

}  // namespace
}  // namespace brume::passes
