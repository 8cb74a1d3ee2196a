// A host whose origin moves between two frames: smoke that accumulates, and its motion, go on.
#include <array>

#include "tests/host/hosted_pair.hpp"
#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

class PreviousViewTest : public YardTest {
 protected:
  static constexpr std::uint32_t kFrames = 8, kShifted = 4;
  static constexpr brume_voxel kYard{40, 16, 28};
  enum class Previous { given, missing };

  void SetUp() override {
    has_motion_ = true;
    make(kYard, 0.25f);
  }
  /// Everything from here on has coordinates that are `shift` larger.
  void move_origin(glm::vec3 shift) {
    host_.wait();
    brume_light light = kLight;
    light.position = point_of(glm::vec3(light.position.x, light.position.y, light.position.z) + shift);
    ASSERT_OK(brume_renderer_set_lights(renderer_, &light, 1));
    make_world(kYard, 0.25f, point_of(shift));
    smoke(1, glm::vec3(6.1f, 1.1f, 3.6f) + shift, 3000, 2000);
    advance(160);
  }
  static glm::vec3 eye(std::uint32_t frame) {
    return {1.5f + 0.07f * static_cast<float>(frame), 1.6f, 3.1f - 0.1f * static_cast<float>(frame)};
  }

  struct Drawn {
    Pixels smoke;                  // of the last frame
    std::array<Pixels, 2> motion;  // of the frame of the shift, and the one after
  };
  /// Frames of a camera that moves, through smoke that stands still.
  Drawn draw_all(glm::vec3 shift, Previous previous = Previous::given) {
    move_origin({0, 0, 0});
    const gpu::Buffer smoke = readback_buffer(gpu_);
    std::array motion{readback_buffer(gpu_), readback_buffer(gpu_)};
    glm::vec3 origin(0);
    for (std::uint32_t i = 0; i < kFrames; ++i) {
      if (i == kShifted) move_origin(origin = shift);
      draw(origin + eye(i), {1, -0.1f, 0.1f}, 2.5, [&](brume_frame_params& params) {
        params.look.erosion = params.look.hole_rim = params.look.swirl = params.look.rise = 0;
        params.jitter_index = i;
        params.continues_previous = i > 0;
        params.has_previous = i == kShifted && previous == Previous::given;
        params.previous_camera = params.camera;
        params.previous_camera.position = point_of(origin + eye(i - 1));
        ASSERT_OK(brume_renderer_record(renderer_, field_, &params));
        VkImage image = VK_NULL_HANDLE;
        if (i == kShifted || i == kShifted + 1) {
          ASSERT_OK(brume_renderer_motion(renderer_, &image, nullptr));
          host_.copy(params.commands, image, {kSize.x, kSize.y}, motion[i - kShifted].handle());
        }
        if (i + 1 < kFrames) return;
        ASSERT_OK(brume_renderer_smoke(renderer_, &image, nullptr));
        host_.copy(params.commands, image, {kSize.x, kSize.y}, smoke.handle());
      });
    }
    host_.wait();
    return {pixels_of(smoke), {pixels_of(motion[0]), pixels_of(motion[1])}};
  }
  static void expect_near(const Pixels& a, const Pixels& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(a[i][c], b[i][c], std::abs(a[i][c]) / 1024 + 1e-3) << i;
  }
  static double most_apart(const Pixels& a, const Pixels& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = 0; c < 4; ++c) most = std::max(most, std::abs(a[i][c] - b[i][c]));
    return most;
  }
};

// By whole voxels and by any vector. Positions round by 2^-20 of a metre more or less, which changes halves
// by a unit, 2^-11 of them, in this frame and in the mean of those before.
TEST_F(PreviousViewTest, HistoryFollowsAnOriginThatMoves) {
  const Drawn stands = draw_all({0, 0, 0});
  for (const glm::vec3 shift : {glm::vec3(32, -8, 12.5f), glm::vec3(-7.13f, 2.41f, 19.77f)}) {
    SCOPED_TRACE(shift.x);
    const Drawn moved = draw_all(shift);
    expect_near(stands.smoke, moved.smoke);
    for (std::size_t i = 0; i < 2; ++i) expect_near(stands.motion[i], moved.motion[i]);
  }
  // Without its previous camera the picture is looked for elsewhere.
  const Drawn lost = draw_all({32, -8, 12.5f}, Previous::missing);
  EXPECT_GT(most_apart(stands.smoke, lost.smoke), 0.02);
  EXPECT_GT(most_apart(stands.motion[0], lost.motion[0]), 10);
}

}  // namespace
}  // namespace brume::host
