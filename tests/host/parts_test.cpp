// Parts of a host's pictures: eyes of a headset, tiles, split screens, frames of changing size.
#include <numbers>

#include "core/file.hpp"
#include "tests/host/engine_axes.h"
#include "tests/host/hosted_pair.hpp"
#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

constexpr glm::uvec2 kWhole{128, 128};
/// What the whole picture shows.
constexpr brume_frustum kWide{-1.1f, 0.9f, -0.7f, 0.8f};

/// The frustum of a part of the whole picture.
brume_frustum frustum_of(const brume_rectangle& part) {
  const float x = (kWide.right - kWide.left) / kWhole.x, y = (kWide.up - kWide.down) / kWhole.y;
  const auto at = [](std::uint32_t px) { return static_cast<float>(px); };
  return {kWide.left + x * at(part.x), kWide.left + x * at(part.x + part.width),
          kWide.up - y * at(part.y + part.height), kWide.up - y * at(part.y)};
}

class PartsTest : public YardTest {
 protected:
  explicit PartsTest(bool is_temporal = false) : YardTest(gpu::kUsualHost, kWhole) {
    is_temporal_ = is_temporal;
  }
  void SetUp() override {
    make_shot();
    picture_ =
        gpu::Image(gpu_, {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                          .size = {kWhole, 1},
                          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    upload_depth(0.05f);
    begin_picture();
  }
  /// Surfaces at 3 m, and `slope` farther with each pixel and row.
  void upload_depth(float slope) {
    std::vector<float> reverse;
    for (std::uint32_t y = 0; y < kWhole.y; ++y)
      for (std::uint32_t x = 0; x < kWhole.x; ++x)
        reverse.push_back(0.1f / (3 + slope * static_cast<float>(x + 10 * (y % 3))));
    upload_depths(reverse);
  }
  void begin_picture() {
    frame([&](gpu::Recorder& recorder) {
      gpu::Recorder::Attachments attachments;
      attachments.colours = {&picture_};
      recorder.begin_rendering(attachments, kWhole);
      recorder.end_rendering();
    });
  }
  /// A frame of the host's own.
  void frame(const std::function<void(gpu::Recorder&)>& record) {
    host_.frame([&](VkCommandBuffer commands, std::uint64_t number, std::uint64_t completed) {
      recording_.begin(commands, number, completed);
      record(recording_.recorder());
      recording_.end();
      host_.wait_for_compute(commands);
    });
  }
  /// Draws a part of the picture.
  void draw_part(const brume_rectangle& part, const brume_frustum& frustum, std::uint32_t jitter = 1) {
    draw_parts({{renderer_, 0, part, frustum}}, jitter);
  }
  brume_camera camera_ = [] {
    brume_camera camera = brume_frame_defaults().camera;
    camera.position = {1.5f, 1.6f, 3};
    camera.forward = {1, -0.1f, 0.1f};
    return camera;
  }();
  struct Part {
    brume_renderer* by;
    std::uint32_t view;
    brume_rectangle part;
    brume_frustum frustum;
  };
  brume_frame_params params_of(VkCommandBuffer commands, std::uint64_t number,
                               std::uint64_t completed) const {
    brume_frame_params params = brume_frame_defaults();
    params.commands = commands;
    params.frame_number = number;
    params.completed_frame = completed;
    params.camera = camera_;
    params.depth.view = depth_.view();
    params.depth.layout = depth_.last_use.get(gpu_).layout;
    params.depth.reversed = 1;
    params.depth.far_plane = INFINITY;
    params.picture = {picture_.view(), VK_FORMAT_R16G16B16A16_SFLOAT, 1};
    params.seconds = 160 / 64.0;
    return params;
  }
  /// Draws a frame of several parts.
  void draw_parts(const std::vector<Part>& parts, std::uint32_t jitter) {
    host_.frame([&](VkCommandBuffer commands, std::uint64_t number, std::uint64_t completed) {
      brume_frame_params params = params_of(commands, number, completed);
      params.jitter_index = jitter;
      params.continues_previous = continues_ ? 1 : 0;
      std::vector<brume_frame_params> views;
      for (const Part& part : parts) {
        params.part = part.part;
        params.frustum = part.frustum;
        params.view = part.view;
        views.push_back(params);
        if (in_one_call_) continue;
        ASSERT_OK(brume_renderer_record(part.by, field_, &params));
      }
      if (!in_one_call_) return;
      ASSERT_OK(record_views(views));
    });
  }
  brume_result record_views(const std::vector<brume_frame_params>& views) {
    std::vector<const brume_frame_params*> pointers;
    for (const brume_frame_params& view : views) pointers.push_back(&view);
    return brume_renderer_record_views(renderer_, field_, pointers.data(), pointers.size());
  }
  /// What was drawn; empties the picture.
  Pixels picture() {
    const gpu::Buffer copy = gpu::readback_buffer(gpu_, VkDeviceSize{8} * kWhole.x * kWhole.y);
    frame([&](gpu::Recorder& recorder) { recorder.read_back(picture_, copy); });
    host_.wait();
    begin_picture();
    return pixels_of(copy);
  }
  Pixels whole() {
    draw_part({}, kWide);
    return picture();
  }
  /// The largest difference within a rectangle.
  static double apart(const Pixels& a, const Pixels& b, const brume_rectangle& in) {
    double most = 0;
    for (std::uint32_t y = in.y; y < in.y + in.height; ++y)
      for (std::uint32_t x = in.x; x < in.x + in.width; ++x)
        for (int c = 0; c < 4; ++c)
          most = std::max(most, std::abs(a[x + kWhole.x * y][c] - b[x + kWhole.x * y][c]));
    return most;
  }

  gpu::Image picture_;
  bool continues_ = true;
  bool in_one_call_ = false;  ///< All parts, which are the renderer's.
};

// Tiles are as large as the tile of blue noise, so that rays have the same jitter as in the whole picture.
TEST_F(PartsTest, FourTilesAreTheWholePicture) {
  for (const std::uint32_t scale : {1u, 2u}) {
    ASSERT_OK(brume_renderer_set_march_scale(renderer_, scale));
    const Pixels expected = whole();
    for (const std::uint32_t y : {0u, 64u})
      for (const std::uint32_t x : {0u, 64u}) draw_part({x, y, 64, 64}, frustum_of({x, y, 64, 64}));
    const Pixels tiles = picture();
    // At half resolution rays have other jitter; both pictures may be three steps of a display off.
    EXPECT_LE(apart(expected, tiles, {0, 0, 128, 128}), (scale == 1 ? 1 : 6) / 255.0) << "at scale " << scale;
    double most = 0;
    for (const glm::dvec4& pixel : expected) most = std::max(most, pixel.r);
    EXPECT_GT(most, 0.02) << "smoke is in view";
  }
}

// The camera of PartsTest as engines have it, by their own formulas for yaw and pitch.
TEST_F(PartsTest, CamerasOfEnginesAreThatOfBrume) {
  const std::string page = *read_text_file(BRUME_SOURCE_DIR "/docs/guides/views.md"),
                    code = *read_text_file(BRUME_SOURCE_DIR "/tests/host/engine_axes.h");
  EXPECT_NE(page.find(code.substr(code.find("// Unreal"))), page.npos) << "the page has this code";
  const Pixels expected = whole();
  const double yaw = 95.7105931 * std::numbers::pi / 180, pitch = 5.6825 * std::numbers::pi / 180;
  const double cos_yaw = std::cos(yaw), sin_yaw = std::sin(yaw), cos_pitch = std::cos(pitch),
               sin_pitch = std::sin(pitch);
  const auto expect_same = [&](const char* engine, brume_point position, brume_point forward,
                               brume_point up) {
    camera_.position = position;
    camera_.forward = forward;
    camera_.up = up;
    EXPECT_LE(apart(expected, whole(), {0, 0, kWhole.x, kWhole.y}), 1 / 255.0) << engine;
  };
  // FRotator(-pitch, yaw, 0): the x and z axes of its matrix.
  expect_same("Unreal", from_unreal(-300, 150, 160),
              from_unreal(cos_pitch * cos_yaw, cos_pitch * sin_yaw, -sin_pitch),
              from_unreal(sin_pitch * cos_yaw, sin_pitch * sin_yaw, cos_pitch));
  // Quaternion.Euler(pitch, yaw, 0): its forward and up.
  expect_same("Unity", from_unity(1.5, 1.6, -3),
              from_unity(cos_pitch * sin_yaw, -sin_pitch, cos_pitch * cos_yaw),
              from_unity(sin_pitch * sin_yaw, cos_pitch, sin_pitch * cos_yaw));
  // Vector3(-pitch, -yaw, 0) as rotation: minus the z axis of its basis, and the y axis.
  expect_same("Godot", from_godot(1.5, 1.6, 3),
              from_godot(cos_pitch * sin_yaw, -sin_pitch, -cos_pitch * cos_yaw),
              from_godot(sin_pitch * sin_yaw, cos_pitch, -sin_pitch * cos_yaw));
}

// Beside the part nothing changes.
TEST_F(PartsTest, APartIsDrawnAlone) {
  const Pixels empty = picture();
  const brume_rectangle part{64, 37, 40, 21};
  draw_part(part, frustum_of(part));
  const Pixels drawn = picture();
  EXPECT_EQ(apart(empty, drawn, {0, 0, 64, 128}), 0);
  EXPECT_EQ(apart(empty, drawn, {104, 0, 24, 128}), 0);
  EXPECT_EQ(apart(empty, drawn, {64, 0, 40, 37}), 0);
  EXPECT_EQ(apart(empty, drawn, {64, 58, 40, 70}), 0);
  EXPECT_GT(apart(empty, drawn, part), 0.02);
}

TEST_F(PartsTest, RefusesPartsAndFrustaThatAreNone) {
  host_.frame([&](VkCommandBuffer commands, std::uint64_t number, std::uint64_t) {
    brume_frame_params good = brume_frame_defaults();
    good.commands = commands;
    good.frame_number = number;
    good.depth.view = depth_.view();
    good.depth.layout = VK_IMAGE_LAYOUT_GENERAL;
    const auto refused = [&](const char* words, auto change) {
      brume_frame_params params = good;
      change(params);
      expect_refused(brume_renderer_record(renderer_, field_, &params), BRUME_ERROR_ARGUMENT, words);
    };
    refused("part", [](auto& p) { p.part = {0, 0, kWhole.x + 1, 1}; });
    refused("part", [](auto& p) { p.part = {0, 0, 5, 0}; });
    refused("part", [](auto& p) { p.part = {0, 20000, 5, 5}; });
    refused("part", [](auto& p) { p.part = {10, 10, 0, 0}; });
    refused("camera.up", [](auto& p) { p.camera.up = {0, 0, 2}; });
    refused("view", [](auto& p) { p.view = BRUME_MAX_VIEWS; });
    refused("frustum.left", [](auto& p) { p.frustum = {1, -1, -1, 1}; });
    refused("frustum.left", [](auto& p) { p.frustum = {NAN, 1, -1, 1}; });
    refused("frustum.down", [](auto& p) { p.frustum = {-1, 1, 2, 2}; });
    refused("frustum.down", [](auto& p) { p.frustum = {-1, 1, -1, INFINITY}; });
  });
}

/// Pipelines that are made.
struct CountPipelines {
  static inline int made = 0;
  static VkResult call(PFN_vkCreateComputePipelines real, VkDevice device, VkPipelineCache cache,
                       std::uint32_t count, const VkComputePipelineCreateInfo* infos,
                       const VkAllocationCallbacks* callbacks, VkPipeline* pipelines) {
    made += static_cast<int>(count);
    return real(device, cache, count, infos, callbacks, pipelines);
  }
};

class DynamicPartsTest : public PartsTest {
 protected:
  DynamicPartsTest() : PartsTest(true) {
    replacements_.push_back(BRUME_INTERPOSED(CountPipelines, CreateComputePipelines));
    memory_.unmap_to_fill = reinterpret_cast<PFN_vkUnmapMemory>(
        host_.device().get_instance_proc_addr(host_.device().instance, "vkUnmapMemory"));
  }
};

// A size per frame: no pipeline and no image is made, and the mean over frames goes on (AccumulateTest).
TEST_F(DynamicPartsTest, ThirteenSizesInThirteenFrames) {
  upload_depth(0);
  const auto size = [](std::uint32_t i) { return 128 - 3 * (i * 5 % 13); };
  for (int i = 0; i < 4; ++i) draw_part({}, kWide, 1);
  const int made = CountPipelines::made, allocations = memory_.allocations;
  EXPECT_GT(made, 0);
  for (std::uint32_t i = 0; i < 13; ++i) draw_part({0, 0, size(i), size(i)}, kWide, 2 + i);
  host_.wait();
  EXPECT_EQ(CountPipelines::made, made);
  EXPECT_EQ(memory_.allocations, allocations);

  // After a resize nothing is left of it.
  begin_picture();
  draw_part({0, 0, 100, 90}, kWide, 20);
  const Pixels goes_on = picture();
  ASSERT_OK(brume_renderer_resize(renderer_, kWhole.x, kWhole.y));
  draw_part({0, 0, 100, 90}, kWide, 20);
  const Pixels starts = picture();
  ASSERT_OK(brume_renderer_resize(renderer_, kWhole.x, kWhole.y));
  draw_part({0, 0, 100, 90}, kWide, 20);
  EXPECT_EQ(starts, picture());
  EXPECT_NE(starts, goes_on);
}

// Whatever the memory held in which the images are: no filter reads beside a part what was never written.
TEST_F(DynamicPartsTest, WhatLiesBesideAPartDoesNotMatter) {
  const brume_frustum in_smoke{-0.3f, 0.3f, -0.3f, 0.3f};
  const auto last_of = [&] {
    for (const std::uint32_t size : {90u, 90u, 77u, 100u, 100u}) {
      draw_part({0, 0, size, size - 9}, in_smoke, size);
      continues_ = true;
    }
    return picture();
  };
  const Pixels first = last_of();
  continues_ = false;
  for (std::uint32_t i = 0; i < 2; ++i) draw_part({}, in_smoke, i);
  (void)picture();
  continues_ = false;
  EXPECT_LE(apart(first, last_of(), {0, 0, kWhole.x, kWhole.y}), 1 / 255.0);
}

// Two views of one renderer, in one frame, are those of two renderers, and take the memory of what
// accumulates.
TEST_F(DynamicPartsTest, TwoEyesOfOneRendererAreThoseOfTwo) {
  upload_depth(0);
  begin_picture();
  const brume_frustum left{-1.1f, 0.8f, -0.7f, 0.8f}, right{-0.8f, 1.1f, -0.7f, 0.8f};
  const Part one[] = {{renderer_, 0, {0, 0, 64, 64}, left}, {renderer_, 3, {64, 0, 64, 64}, right}};
  draw_parts({one[0]}, 1);
  const std::uint64_t of_one = device_bytes();
  draw_parts({one[0], one[1]}, 1);
  // Twice a smoke of half floats, and a distance and a number of frames.
  EXPECT_LE(device_bytes(), of_one * 115 / 100 + std::uint64_t{2} * 16 * kWhole.x * kWhole.y);

  brume_renderer* eyes[] = {renderer_, nullptr};
  ASSERT_OK(brume_renderer_resize(renderer_, kWhole.x, kWhole.y));
  ASSERT_OK(create_renderer(1));
  std::swap(renderer_, eyes[1]);
  brume_renderer* third = nullptr;
  ASSERT_OK(create_renderer(1));
  third = renderer_;
  renderer_ = eyes[0];
  for (std::uint32_t i = 0; i < 12; ++i) {
    begin_picture();
    draw_parts({one[0], one[1], {eyes[1], 0, {0, 64, 64, 64}, left}, {third, 0, {64, 64, 64, 64}, right}}, i);
  }
  const Pixels drawn = picture();
  Pixels below(drawn.size());
  std::copy(drawn.begin() + 64 * 128, drawn.end(), below.begin());
  EXPECT_LE(apart(drawn, below, {0, 0, 128, 64}), 1 / 255.0);
  EXPECT_GT(apart(drawn, picture(), {0, 0, 128, 64}), 0.02) << "smoke is in view";
  EXPECT_OK(brume_renderer_destroy(eyes[1]));
  EXPECT_OK(brume_renderer_destroy(third));
}

TEST_F(DynamicPartsTest, ViewsOfOneCallAreThoseOfSeveralCalls) {
  std::vector<Part> parts;
  for (std::uint32_t i = 0; i < BRUME_MAX_VIEWS; ++i) {
    const brume_rectangle part{64 * (i & 1), 64 * (i >> 1), 64, 64};
    parts.push_back({renderer_, BRUME_MAX_VIEWS - 1 - i, part, frustum_of(part)});
  }
  std::array<Pixels, 2> drawn;
  for (Pixels& pixels : drawn) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      begin_picture();
      draw_parts(parts, i);
    }
    pixels = picture();
    in_one_call_ = true;
    ASSERT_OK(brume_renderer_resize(renderer_, kWhole.x, kWhole.y));
  }
  EXPECT_EQ(drawn[0], drawn[1]);
  EXPECT_GT(apart(drawn[0], picture(), {0, 0, 128, 128}), 0.02) << "smoke is in view";
}

TEST_F(DynamicPartsTest, AViewThatIsWrongLeavesNone) {
  draw_part({}, kWide);
  (void)picture();
  host_.frame([&](VkCommandBuffer commands, std::uint64_t number, std::uint64_t completed) {
    const brume_frame_params params = params_of(commands, number, completed);
    std::vector<brume_frame_params> views(2, params);
    const auto refuse = [&](const char* words) {
      expect_refused(record_views(views), BRUME_ERROR_ARGUMENT, words);
    };
    refuse("view 1: an earlier one has the same `view`");
    views[1].view = 9;
    refuse("view 1: `view` must be below 4");
    views[1] = params;
    views[1].view = 1;
    views[1].frame_number = number + 1;
    refuse("view 1: `commands`, `frame_number` and `completed_frame` must be");
    views[1].frame_number = number;
    views[1].depth.near_plane = -1;
    refuse("view 1: `depth.near_plane`");
    views.resize(5, params);
    refuse("`view_count` must be from 1 to 4");
    const brume_frame_params* none[] = {&views[0], nullptr};
    expect_refused(brume_renderer_record_views(renderer_, field_, none, 2), BRUME_ERROR_ARGUMENT,
                   "`views[1]` is null");
    expect_refused(brume_renderer_record_views(renderer_, field_, nullptr, 2), BRUME_ERROR_ARGUMENT, "views");
  });
  for (const glm::dvec4& pixel : picture()) ASSERT_EQ(pixel, glm::dvec4(0));
  draw_part({}, kWide);
}

}  // namespace
}  // namespace brume::host
