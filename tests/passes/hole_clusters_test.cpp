#include "passes/hole_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "tests/passes/march_fixture.hpp"
#include "tests/planning/random_holes.hpp"

namespace brume::passes {
namespace {

class HoleClustersTest : public MarchFixture {
 protected:
  static constexpr glm::uvec2 kSize{70, 41};
  static std::vector<voxel::Triangle> walls() {
    std::vector<voxel::Triangle> walls;
    add_quad(walls, {-3, -3, -2.05f}, {0, -3, -1.05f}, {0, 3, -1.05f}, {-3, 3, -2.05f});
    return walls;
  }

  /// Radiance and transmittance as their bytes.
  std::vector<Half4> march(const std::vector<shared::Hole>& holes, bool plain) {
    shared::FrameConstants frame = frame_at(room_, {0.3f, 0.2f, 7}, {0.9f, 0.55f}, kSize);
    frame.look.extinction = 0.3f;
    frame.look.hole_rim = 0.06f;
    frame.time = 1;
    HoleClusters hole_clusters(context(), runner(), {});
    const auto plan = planning::plan_holes(holes, frame.time, frame.look.hole_rim, frame.smoke,
                                           room_.volume.slot_count(), kSize);
    hole_clusters.reserve(plan);
    frame.holes = plan.layout();
    frame.media = planning::smoke_media(frame.smoke, frame.look);
    const auto frame_buffer = upload(std::vector{frame});
    const auto counters = upload(std::vector<std::uint32_t>{0});
    const std::vector<float> depth(kSize.x * kSize.y, frame.camera.near_z / 15);
    const auto depth_image = upload_image(context(), runner(), kSize, VK_FORMAT_R32_SFLOAT, depth);
    const auto target = test_image(context(), kSize, VK_FORMAT_R16G16B16A16_SFLOAT);
    runner().run([&](gpu::Recorder& recorder) {
      light_evenly(recorder, room_);
      hole_clusters.record(recorder, plan, frame_buffer, room_.upload.resources());
      (plain ? plain_ : march_)
          .record(recorder, inputs(frame_buffer, room_, depth_image, hole_clusters), target, counters);
    });
    return read_back<Half4>(target);
  }
  static double largest_difference(const std::vector<Half4>& a, const std::vector<Half4>& b) {
    float largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const glm::vec4 apart = glm::abs(from_half(a[i]) - from_half(b[i]));
      largest = std::max({largest, apart.x, apart.y, apart.z, apart.w});
    }
    return static_cast<double>(largest);
  }

  const SmokeRoom room_{context(),  runner(), walls(), {{26, 17, 33}, 0.5f, {-6.5f, -4, -8}},
                        {0, 0, -1}, 1u << 22, 4000};
  const MarchPass march_{context(), {}}, plain_{context(), {.brute_force_holes = true}};
};

TEST_F(HoleClustersTest, GivesTheImageOfTestingEveryHole) {
  // A sample multiplies what the holes leave that contain it, in the order in which the loop does, and the
  // others leave exactly 1: the same floats. No more holes: a software rasterizer ends all loops of a ray
  // after 65,535 rounds, and testing every hole at each of 250 samples takes as many.
  for (const std::size_t count : {1u, 7u, 63u, 200u}) {
    const auto holes = planning::random_holes(count, static_cast<std::uint32_t>(count), 8);
    const auto listed = march(holes, false), plain = march(holes, true);
    EXPECT_EQ(largest_difference(listed, plain), 0) << count << " holes";
    if (count < 63) continue;
    EXPECT_GT(largest_difference(listed, march({}, false)), 0.01) << "the holes are visible";
  }
}

TEST_F(HoleClustersTest, SeesHolesFromInsideAndAlongTheirAxes) {
  std::vector<shared::Hole> holes = planning::random_holes(6, 3, 8);
  for (std::size_t i = 0; i < holes.size(); ++i) {
    shared::Hole& hole = holes[i];
    hole.origin_world = {0.3f, 0.2f, 7.5f - 2 * static_cast<float>(i)};  // the eye is at z = 7
    hole.forward = {0, 0, i % 2 == 0 ? -1.0f : 1.0f};
    hole.right = {1, 0, 0};
    hole.up = glm::cross(hole.right, hole.forward);
    hole.distance_to_far = 11;
    hole.radius = 0.3f + 0.1f * static_cast<float>(i);
    hole.time_start = 0;
    hole.time_to_stay_open = 10;
  }
  EXPECT_EQ(largest_difference(march(holes, false), march(holes, true)), 0);
}

TEST_F(HoleClustersTest, GivesTheSameImageEachTime) {
  const auto holes = planning::random_holes(2000, 9, 8);
  const auto first = march(holes, false), second = march(holes, false);
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(Half4)), 0);
}

}  // namespace
}  // namespace brume::passes
