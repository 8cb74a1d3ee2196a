// Parallel projections of a host: the limit of perspective views from ever farther away.
#include <array>

#include "grids/files/grid_files.hpp"
#include "grids/generate.hpp"
#include "tests/host/hosted_pair.hpp"
#include "tests/host/yard.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {
namespace {

class ParallelTest : public YardTest {
 protected:
  static constexpr glm::dvec2 kHalf{4.8, 2.7};  ///< Half of the picture [m].
  static constexpr double kEye = 6;  ///< From the eye of the parallel view to what is in focus [m].
  static constexpr std::uint32_t kFrames = 3;
  static constexpr glm::dvec3 kFocus{5.6, 1.6, 3.4};
  static constexpr double kFar = 40;

  void SetUp() override {
    has_motion_ = true;
    make_shot();
  }
  static glm::dvec3 forward() { return glm::normalize(glm::dvec3(1, -0.35, 0.3)); }
  static glm::dvec3 right() { return glm::normalize(glm::cross(forward(), glm::dvec3(0, 1, 0))); }
  static glm::dvec3 up() { return glm::cross(right(), forward()); }

  /// How a picture is projected. `distance`: of a perspective view from what is in focus; 0: parallel.
  struct Projection {
    double distance = 0;
    bool reversed = true;
  };
  /// How far the surface of a pixel is from the eye of the parallel view.
  static double surface(std::uint32_t i) {
    const std::uint32_t x = i % kSize.x, y = i / kSize.x;
    return kEye + (x < kSize.x / 2 ? 0.3 : 2.0) + 0.02 * (x + 2.0 * y);
  }
  /// The host's depth: a wall that leans back, with a step in the middle of the picture.
  void upload_surfaces(const Projection& as) {
    const bool parallel = as.distance == 0;
    std::vector<float> depths;
    for (std::uint32_t y = 0; y < kSize.y; ++y)
      for (std::uint32_t x = 0; x < kSize.x; ++x) {
        const double z = surface(x + kSize.x * y), linear = (z - 0.1) / (kFar - 0.1);
        const double d = !parallel ? 0.1 / (z - kEye + as.distance) : as.reversed ? 1 - linear : linear;
        depths.push_back(static_cast<float>(y < 4 ? (as.reversed ? 0 : 1) : d));
      }
    upload_depths(depths);
  }
  static brume_frustum frustum_of(const Projection& as) {
    const glm::vec2 half(as.distance > 0 ? kHalf / as.distance : kHalf);
    return {-half.x, half.x, -half.y, half.y};
  }
  void set_view(const Projection& as, std::uint32_t i, brume_frame_params& params) const {
    const glm::dvec3 focus = kFocus + 0.13 * i * right(),
                     eye = focus - (as.distance > 0 ? as.distance : kEye) * forward();
    params.camera.position = point_of(glm::vec3(eye));
    params.camera.forward = point_of(glm::vec3(forward()));
    params.frustum = frustum_of(as);
    params.depth.near_plane = 0.1f;
    params.depth.far_plane = as.distance > 0 ? INFINITY : static_cast<float>(kFar);
    params.depth.reversed = as.reversed;
    params.parallel = as.distance > 0 ? 0 : 1;
    params.jitter_index = i;
    params.continues_previous = i > 0;
    params.shadow_light_count = 1;
    params.volumes = volumes_.data();
    params.volume_count = volumes_.size();
    params.decals = decals_.data();
    params.decal_count = decals_.size();
    if (!has_noise_) params.look.erosion = params.look.hole_rim = params.look.swirl = 0;
  }

  bool has_noise_ = true;
  std::vector<brume_shown_volume> volumes_;
  std::vector<brume_shown_decal> decals_;

  struct Drawn {
    Pixels smoke, motion, shadows;
    Pixels occlusion;  // with decals
  };
  /// The last of several frames.
  Drawn draw_view(const Projection& as, std::uint32_t frames = kFrames) {
    upload_surfaces(as);
    std::array copies{readback_buffer(gpu_), readback_buffer(gpu_), readback_buffer(gpu_),
                      readback_buffer(gpu_)};
    for (std::uint32_t i = 0; i < frames; ++i) {
      host_.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
        brume_frame_params params = brume_frame_defaults();
        params.commands = commands;
        params.frame_number = frame;
        params.completed_frame = completed;
        params.depth.view = depth_.view();
        params.depth.layout = VK_IMAGE_LAYOUT_GENERAL;
        params.seconds = 2.5;
        set_view(as, i, params);
        ASSERT_OK(brume_renderer_record(renderer_, field_, &params));
        if (i + 1 < frames) return;
        VkImage image = VK_NULL_HANDLE;
        ASSERT_OK(brume_renderer_smoke(renderer_, &image, nullptr));
        host_.copy(commands, image, {kSize.x, kSize.y}, copies[0].handle());
        ASSERT_OK(brume_renderer_motion(renderer_, &image, nullptr));
        host_.copy(commands, image, {kSize.x, kSize.y}, copies[1].handle());
        ASSERT_OK(brume_renderer_shadows(renderer_, &image, nullptr));
        host_.copy(commands, image, {kSize.x, kSize.y}, copies[2].handle());
        if (params.decal_count == 0) return;
        ASSERT_OK(brume_renderer_occlusion(renderer_, &image, nullptr));
        host_.copy(commands, image, {kSize.x, kSize.y}, copies[3].handle());
      });
    }
    host_.wait();
    return {pixels_of(copies[0]), pixels_of(copies[1]), pixels_of(copies[2]), pixels_of(copies[3])};
  }
  /// The mean difference of the channels from `first` to `last`.
  static double apart(const Pixels& a, const Pixels& b, int first = 0, int last = 3) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = first; c <= last; ++c) sum += std::abs(a[i][c] - b[i][c]);
    return sum / static_cast<double>(a.size());
  }
};

// What lies e in front of or behind the focus is seen e / distance aside: the error halves with each
// doubling.
TEST_F(ParallelTest, IsTheLimitOfPerspectiveViewsFromFarAway) {
  struct Errors {
    double smoke, motion, shadows;
  };
  const Drawn parallel = draw_view({});
  const auto errors_at = [&](double distance) -> Errors {
    const Drawn far = draw_view({distance});
    return {apart(parallel.smoke, far.smoke), apart(parallel.motion, far.motion, 0, 1),
            apart(parallel.shadows, far.shadows)};
  };
  const auto expect_fall = [](const Errors& from, const Errors& to, double factor) {
    EXPECT_LT(to.smoke, factor * from.smoke);
    EXPECT_LT(to.motion, factor * from.motion);
    EXPECT_LT(to.shadows, factor * from.shadows);
  };
  const Errors at_25 = errors_at(25), at_50 = errors_at(50), at_100 = errors_at(100);
  EXPECT_GT(at_25.smoke, 2 / 255.0);
  expect_fall(at_25, at_50, 0.6);
  expect_fall(at_50, at_100, 0.6);
  expect_fall(at_100, errors_at(1600), 0.2);
}

// The decal scatters its samples, of which the frames before are found again.
TEST_F(ParallelTest, VolumesAndDecalsAreTheLimit) {
  const cli::WorkFolder folder;
  grids::GridFile file;
  file.grids.push_back(grids::generate_cloud(
      {.kind = grids::CloudKind::sphere, .edge = 24, .voxel_size = 0.1, .radius = 1.0}));
  file.grids.back().name = "density";
  grids::save_grid_file(folder.path() / "cloud.brv", file).value_or_throw();
  const std::string path = (folder.path() / "cloud.brv").string();
  brume_volume_params of_volume = brume_volume_defaults();
  of_volume.file = path.c_str();
  of_volume.wait_for_frame = 1;
  brume_volume* volume = nullptr;
  ASSERT_OK(brume_volume_create(context_.get(), &of_volume, &volume));
  volumes_.push_back(brume_shown_volume_defaults(volume));
  volumes_.back().position = point_of(glm::vec3(kFocus - 2.5 * forward() + 2.0 * right() - 1.0 * up()));
  volumes_.back().extinction = 2;
  constexpr std::array kHidden{0.1f, 0.9f, 0.4f, 0.7f, 0.8f, 0.2f, 0.6f, 0.3f};
  brume_decal_params of_decal = brume_decal_defaults();
  of_decal.up = kHidden.data();
  of_decal.size[0] = of_decal.size[1] = of_decal.size[2] = 2;
  brume_decal* decal = nullptr;
  ASSERT_OK(brume_decal_create(context_.get(), &of_decal, &decal));
  decals_.push_back(brume_shown_decal_defaults(decal));
  decals_.back().position = point_of(glm::vec3(kFocus + 1.2 * forward() - 1.5 * right()));

  const Drawn parallel = draw_view({});
  double hidden = 0;
  for (const glm::dvec4& pixel : parallel.occlusion) hidden += pixel.r / (kSize.x * kSize.y);
  EXPECT_GT(hidden, 0.02);
  const Drawn near = draw_view({100}), far = draw_view({1600});
  EXPECT_LT(apart(parallel.smoke, far.smoke), 0.2 * apart(parallel.smoke, near.smoke));
  EXPECT_LT(apart(parallel.occlusion, far.occlusion, 0, 0),
            0.2 * apart(parallel.occlusion, near.occlusion, 0, 0));
  host_.wait();
  EXPECT_OK(brume_volume_destroy(volume));
  EXPECT_OK(brume_decal_destroy(decal));
}

// The picture may differ from the full march by three steps of a display.
TEST_F(ParallelTest, AReducedMarchIsTheLimit) {
  ASSERT_OK(brume_renderer_set_march_scale(renderer_, 2));
  EXPECT_LT(apart(draw_view({}).smoke, draw_view({1600}).smoke), 3 / 255.0);
}

// Straight through the field, in double precision: lines from the eye's plane to the surface of each pixel.
TEST_F(ParallelTest, RaysCrossTheSmokeOfTheField) {
  has_noise_ = false;
  const Drawn drawn = draw_view({}, 1);
  std::vector<brume_segment> lines;
  for (std::uint32_t i = 0; i < kSize.x * kSize.y; ++i) {
    const glm::dvec2 ndc = (glm::dvec2(i % kSize.x, i / kSize.x) + 0.5) / glm::dvec2(kSize) * 2.0 - 1.0;
    const glm::dvec3 from = kFocus - kEye * forward() + ndc.x * kHalf.x * right() - ndc.y * kHalf.y * up();
    const double far = i / kSize.x < 4 ? kFar : surface(i);
    lines.push_back({point_of(glm::vec3(from)), point_of(glm::vec3(from + far * forward()))});
  }
  std::vector<float> depths(lines.size());
  ASSERT_OK(brume_field_optical_depths(field_, lines.data(), lines.size(), depths.data()));
  double off = 0, least = 1;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double expected = std::exp(-double{depths[i]}), here = std::abs(drawn.smoke[i].a - expected);
    off += here / static_cast<double>(lines.size());
    least = std::min(least, expected);
  }
  EXPECT_LT(off, 1 / 255.0);
  EXPECT_LT(least, 0.1);
}

TEST_F(ParallelTest, DepthGrowsEitherWay) {
  const Drawn reversed = draw_view({0, true}), forward = draw_view({0, false});
  EXPECT_LT(apart(reversed.smoke, forward.smoke), 1 / 4096.0);
}

// All points move alike, however far away they are.
TEST_F(ParallelTest, MotionIsThatOfTheCamera) {
  const Drawn drawn = draw_view({});
  const double expected = 0.13 / (2 * kHalf.x) * kSize.x;
  int moved = 0;
  for (const glm::dvec4& pixel : drawn.motion) {
    if (pixel.w == 65504) continue;
    EXPECT_NEAR(pixel.x, expected, expected / 1024 + 1e-3);
    EXPECT_NEAR(pixel.y, 0, 1e-3);
    ++moved;
  }
  EXPECT_GT(moved, 300);
}

TEST_F(ParallelTest, RefusesWhatHasNoParallelView) {
  upload_surfaces({});
  host_.frame([&](VkCommandBuffer commands, std::uint64_t number, std::uint64_t) {
    const auto refused = [&](const char* words, auto change) {
      brume_frame_params params = brume_frame_defaults();
      params.commands = commands;
      params.frame_number = number;
      params.depth.view = depth_.view();
      params.depth.layout = VK_IMAGE_LAYOUT_GENERAL;
      set_view({}, 0, params);
      params.shadow_light_count = 0;
      change(params);
      expect_refused(brume_renderer_record(renderer_, field_, &params), BRUME_ERROR_ARGUMENT, words);
    };
    refused("frustum", [](auto& p) { p.frustum = {}; });
    refused("frustum.left", [](auto& p) { p.frustum.right = 20000; });
    refused("frustum.down", [](auto& p) { p.frustum.up = -9; });
    refused("depth.far_plane", [](auto& p) { p.depth.far_plane = INFINITY; });
    refused("depth.far_plane", [](auto& p) { p.depth.far_plane = 0.05f; });
    refused("previous", [](auto& p) {
      p.has_previous = 1;
      p.previous_camera = p.camera;
    });
    refused("perspective", [](auto& p) {
      static const brume_shown_tank tank = brume_shown_tank_defaults(nullptr);
      p.tanks = &tank;
      p.tank_count = 1;
    });
  });
}

}  // namespace
}  // namespace brume::host
