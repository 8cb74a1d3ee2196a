// Motion vectors of the smoke, and its distances, for upscalers of hosts.
#include "shared/smoke_motion.h"
#include "tests/host/hosted_pair.hpp"
#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

/// A camera of YardTest::draw, in doubles.
struct MotionCamera {
  glm::dvec3 eye, forward;
  glm::dvec2 jitter{0};  // [px]

  /// Half of the picture 1 m in front of the eye.
  static glm::dvec2 half() { return glm::dvec2(double{kSize.x} / kSize.y, 1) * std::tan(0.5); }
  glm::dmat3 axes() const {
    const glm::dvec3 f = glm::normalize(forward), right = glm::normalize(glm::cross(f, glm::dvec3(0, 1, 0)));
    return {right, glm::cross(right, f), f};
  }
  /// The point that a pixel shows at a distance along the view axis.
  glm::dvec3 point(std::uint32_t i, double distance) const {
    const glm::dvec2 px = glm::dvec2(i % kSize.x, i / kSize.x) + 0.5 + jitter;
    const glm::dvec2 at = (px / glm::dvec2(kSize) * 2.0 - 1.0) * half() * glm::dvec2(1, -1);
    return eye + distance * (axes() * glm::dvec3(at, 1));
  }
  /// Where a point is in the picture, without jitter [px].
  glm::dvec2 pixel(glm::dvec3 p) const {
    const glm::dvec3 seen = glm::transpose(axes()) * (p - eye);
    return (glm::dvec2(seen) / seen.z / half() * glm::dvec2(1, -1) * 0.5 + 0.5) * glm::dvec2(kSize);
  }
};

class MotionTest : public YardTest {
 protected:
  void begin(std::uint32_t march_scale) {
    has_motion_ = true;
    make_smoky(march_scale);
  }
  /// The motion image of a frame, by a previous camera of the host's own.
  Pixels motion(const MotionCamera& camera, bool continues, const MotionCamera* previous = nullptr) {
    const gpu::Buffer copy = readback_buffer(gpu_);
    draw(glm::vec3(camera.eye), glm::vec3(camera.forward), 2.5, [&](brume_frame_params& params) {
      params.camera.jitter_x = static_cast<float>(camera.jitter.x);
      params.camera.jitter_y = static_cast<float>(camera.jitter.y);
      params.continues_previous = continues;
      if (previous) {
        params.has_previous = 1;
        params.previous_camera = params.camera;
        params.previous_camera.position = point_of(glm::vec3(previous->eye));
        params.previous_camera.forward = point_of(glm::vec3(previous->forward));
      }
      ASSERT_OK(brume_renderer_record(renderer_, field_, &params));
      VkImage image = VK_NULL_HANDLE;
      ASSERT_OK(brume_renderer_motion(renderer_, &image, nullptr));
      host_.copy(params.commands, image, {kSize.x, kSize.y}, copy.handle());
    });
    host_.wait();
    return pixels_of(copy);
  }
  /// The motion of a pixel follows from its distance, which halves round by 2^-11 of itself.
  static void expect_leads(const Pixels& drawn, const MotionCamera& from, const MotionCamera& to) {
    int compared = 0, moved = 0;
    for (std::uint32_t i = 0; i < drawn.size(); ++i) {
      const double entry = drawn[i].z, mean = drawn[i].w;
      EXPECT_LE(entry, mean * (1 + 1 / 1024.0)) << i;
      if (mean == shared::kNoSmoke) {
        EXPECT_EQ(glm::dvec2(drawn[i]), glm::dvec2(0));
        continue;
      }
      EXPECT_GT(entry, 0);
      EXPECT_LT(mean, 12) << "the far end of the yard";
      const glm::dvec2 here = glm::dvec2(i % kSize.x, i / kSize.x) + 0.5 + from.jitter;
      const auto expected = [&](double z) { return to.pixel(from.point(i, z)) - here; };
      const glm::dvec2 low = expected(mean * (1 - 1 / 1024.0)), high = expected(mean * (1 + 1 / 1024.0));
      for (int axis = 0; axis < 2; ++axis) {
        const double given = drawn[i][axis], slack = std::abs(given) / 1024 + 1e-3;
        EXPECT_GE(given, std::min(low[axis], high[axis]) - slack) << i;
        EXPECT_LE(given, std::max(low[axis], high[axis]) + slack) << i;
      }
      ++compared;
      moved += glm::length(glm::dvec2(drawn[i])) > 0.5;
    }
    EXPECT_GT(compared, 300);
    EXPECT_GT(moved, 300);
  }
  const MotionCamera first_{{1.5, 1.6, 3}, {1, -0.1, 0.1}, {0.3, -0.2}},
      second_{{1.3, 1.7, 3.1}, {1, -0.08, 0.05}, {-0.4, 0.1}};
};

TEST_F(MotionTest, LeadsToThePlaceInTheFrameBefore) {
  for (const std::uint32_t scale : {1u, 2u}) {
    SCOPED_TRACE(scale);
    if (renderer_) {
      ASSERT_OK(brume_renderer_set_march_scale(renderer_, scale));
    } else {
      begin(scale);
    }
    (void)motion(first_, false);
    expect_leads(motion(second_, true), second_, first_);
  }
}

// A camera of which no frame was recorded, after one of which there was, and whether the frame continues or
// not.
TEST_F(MotionTest, LeadsToThePreviousCameraThatTheHostGives) {
  begin(1);
  const MotionCamera unseen{{1.8, 1.5, 2.8}, {1, -0.15, 0.2}};
  for (const bool continues : {false, true}) {
    (void)motion(first_, false);
    expect_leads(motion(second_, continues, &unseen), second_, unseen);
  }
}

// Whatever the jitter.
TEST_F(MotionTest, IsNoneWhereNothingMovesOrContinues) {
  begin(1);
  MotionCamera jittered = first_;
  jittered.jitter = second_.jitter;
  (void)motion(first_, false);
  for (const bool continues : {true, false})
    for (const glm::dvec4& pixel : motion(continues ? jittered : second_, continues))
      EXPECT_LT(glm::length(glm::dvec2(pixel)), 1e-3);
}

TEST_F(MotionTest, NeedsItsParameter) {
  make({20, 8, 14}, 0.5f);
  draw({1.5f, 1.6f, 3}, {1, 0, 0}, 0);
  VkImage image = VK_NULL_HANDLE;
  expect_refused(brume_renderer_motion(renderer_, &image, nullptr), BRUME_ERROR_ORDER, "motion");
}

}  // namespace
}  // namespace brume::host
