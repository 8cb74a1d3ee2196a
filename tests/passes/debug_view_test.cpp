#include "passes/debug_view.hpp"

#include <cmath>
#include <random>

#include "shared/frame.h"
#include "tests/passes/half.hpp"
#include "tests/passes/smoke_room.hpp"
#include "voxel/traverse.hpp"

namespace brume::passes {
namespace {

using shared::FrameConstants;

/// A room with a wall of its own in the middle, smoke in it.
std::vector<voxel::Triangle> walls() {
  std::vector<voxel::Triangle> out;
  add_quad(out, {-4.1f, -0.1f, -4.1f}, {4.1f, -0.1f, -4.1f}, {4.1f, -0.1f, 4.1f}, {-4.1f, -0.1f, 4.1f});
  add_quad(out, {-4.1f, -0.1f, -4.1f}, {4.1f, -0.1f, -4.1f}, {4.1f, 3.1f, -4.1f}, {-4.1f, 3.1f, -4.1f});
  add_quad(out, {-4.1f, -0.1f, -4.1f}, {-4.1f, -0.1f, 4.1f}, {-4.1f, 3.1f, 4.1f}, {-4.1f, 3.1f, -4.1f});
  add_quad(out, {1.1f, -0.1f, -4.1f}, {1.1f, -0.1f, 1.1f}, {1.1f, 2.1f, 1.1f}, {1.1f, 2.1f, -4.1f});
  return out;
}

class DebugViewTest : public gpu::GpuTest {
 protected:
  DebugViewTest()
      : room_(context(), runner(), walls(), {{37, 15, 37}, 0.25f, {-4.6f, -0.5f, -4.6f}}, {-1, 0.6, -1}, 2500,
              200),
        holes_(context(), runner(), {}) {}

  /// A view of the room from a corner.
  FrameConstants frame_of(glm::uvec2 size) const {
    FrameConstants frame{};
    frame.camera.eye_world = {4.4f, 2.6f, 5.2f};
    frame.camera.near_z = 0.05f;
    frame.camera.forward = glm::normalize(glm::vec3(-0.62f, -0.23f, -0.75f));
    const glm::vec3 right = glm::normalize(glm::cross(frame.camera.forward, glm::vec3(0, 1, 0)));
    frame.camera.right = 0.8f * right;
    frame.camera.up = 0.45f * glm::cross(right, frame.camera.forward);
    frame.volume = room_.volume.frame();
    frame.look.albedo = glm::vec3(0.9f);
    frame.look.extinction = 0.7f;
    frame.look.step_length = 0.1f;
    frame.look.noise_period = 1;
    frame.exposure = 1;
    frame.size_px = size;
    return frame;
  }
  static glm::vec3 along(const FrameConstants& frame, glm::vec2 position_px) {
    const glm::vec2 ndc = position_px / glm::vec2(frame.size_px) * 2.0f - 1.0f;
    return frame.camera.forward + ndc.x * frame.camera.right - ndc.y * frame.camera.up;
  }
  static glm::vec2 middle(const FrameConstants& frame, std::size_t pixel) {
    const auto i = static_cast<std::uint32_t>(pixel);
    return glm::vec2(i % frame.size_px.x, i / frame.size_px.x) + 0.5f;
  }

  /// What the G-buffer holds, pixel by pixel.
  struct Surfaces {
    std::vector<glm::u8vec4> albedo;  // as sRGB
    std::vector<Half4> normal;
    std::vector<float> depth;
    explicit Surfaces(glm::uvec2 size)
        : albedo(std::size_t{size.x} * size.y),
          normal(albedo.size(), to_half({0, 0, 1, 0})),
          depth(albedo.size()) {}
  };
  static gpu::Image sampled_image(glm::uvec2 size, VkFormat format, std::span<const std::byte> texels) {
    gpu::ImageInfo info;
    info.format = format;
    info.size = {size, 1};
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    gpu::Image image(context(), info);
    const gpu::Recorder::Region all{texels, glm::ivec3(0), {size, 1}};
    runner().run([&](gpu::Recorder& recorder) { recorder.upload(image, {&all, 1}); });
    return image;
  }

  std::vector<glm::u8vec4> show(DebugView view, FrameConstants frame, const Surfaces& surfaces,
                                ViewSlice slice = {}) {
    const glm::uvec2 size = frame.size_px;
    GBuffer gbuffer(context(), size);
    gbuffer.albedo_roughness =
        sampled_image(size, VK_FORMAT_R8G8B8A8_SRGB, std::as_bytes(std::span(surfaces.albedo)));
    gbuffer.normal_metallic =
        sampled_image(size, VK_FORMAT_R16G16B16A16_SFLOAT, std::as_bytes(std::span(surfaces.normal)));
    gbuffer.depth = sampled_image(size, VK_FORMAT_R32_SFLOAT, std::as_bytes(std::span(surfaces.depth)));
    holes_.reserve(open_, frame.time, 0, frame.volume, room_.volume.slot_count(), size);
    frame.holes = holes_.frame();
    const auto frame_buffer = upload(std::vector{frame});
    const auto display = test_image(context(), size, VK_FORMAT_R8G8B8A8_UNORM);
    const DebugSubject subject{view, slice, {&room_.grid, nullptr}, &room_.volume, &room_.world.state()};
    pass_.reserve(subject, size);
    runner().run([&](gpu::Recorder& recorder) {
      holes_.record(recorder, frame_buffer, room_.upload.resources());
      pass_.record(recorder, subject, {frame_buffer, gbuffer, room_.upload.resources(), holes_.resources()},
                   display);
    });
    return read_back<glm::u8vec4>(display);
  }

  SmokeRoom room_;
  OpenHoles holes_;
  DebugViewPass pass_{context()};
  std::vector<shared::Hole> open_;
};

/// How far a shown colour is from one in [0, 1], in steps of 255.
float apart(glm::u8vec4 shown, glm::vec3 expected) {
  const glm::vec3 d = glm::abs(glm::vec3(shown) - 255.0f * glm::clamp(expected, 0.0f, 1.0f));
  return std::max({d.x, d.y, d.z});
}

// A step of 255 is rounded to the nearest; powers and logarithms of a device are good for far more than a
// tenth of one.
constexpr float kRounded = 0.6f;

TEST(DebugViewNames, GoThereAndBack) {
  for (std::uint32_t i = 0; i < shared::kViewCount; ++i) {
    const auto view = static_cast<DebugView>(i);
    EXPECT_EQ(find_debug_view(debug_view_name(view)), view);
  }
  EXPECT_EQ(debug_view_name(DebugView::depth), "depth");
  EXPECT_EQ(find_debug_view("voxels"), std::nullopt);
}

TEST_F(DebugViewTest, NormalsAlbedoAndDepthAreThoseOfTheSurfaces) {
  for (const glm::uvec2 size : {glm::uvec2(33, 17), glm::uvec2(1, 1), glm::uvec2(7, 61)}) {
    FrameConstants frame = frame_of(size);
    Surfaces surfaces(size);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> signed_one(-1, 1), log_distance(-2.5f, 7);
    std::vector<float> distances;
    for (std::size_t i = 0; i < surfaces.depth.size(); ++i) {
      surfaces.albedo[i] = glm::u8vec4(random() % 256, random() % 256, random() % 256, 255);
      const glm::vec3 n(signed_one(random), signed_one(random), signed_one(random));
      surfaces.normal[i] = to_half({glm::normalize(n), 0});
      distances.push_back(std::exp2(log_distance(random)));
      surfaces.depth[i] = i % 5 == 4 ? 0 : frame.camera.near_z / distances[i];
    }
    const auto normals = show(DebugView::normals, frame, surfaces),
               albedo = show(DebugView::albedo, frame, surfaces),
               depth = show(DebugView::depth, frame, surfaces);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if (surfaces.depth[i] == 0) {
        for (const auto& picture : {normals, albedo, depth})
          EXPECT_LE(apart(picture[i], shared::backdrop()), kRounded);
        continue;
      }
      const glm::vec3 n = glm::normalize(glm::vec3(from_half(surfaces.normal[i])));
      EXPECT_LE(apart(normals[i], 0.5f * n + 0.5f), kRounded);
      EXPECT_EQ(glm::u8vec3(albedo[i]), glm::u8vec3(surfaces.albedo[i]));
      const double octaves = std::log2(static_cast<double>(distances[i])) / 6;  // of 1 m to 64 m
      const auto share = static_cast<float>(1 - std::clamp(octaves, 0.0, 1.0));
      EXPECT_LE(apart(depth[i], shared::ramp_colour(shared::kRampViridis, share)), kRounded);
    }
  }
}

/// A picture of what a ray shows against the shown one. At the edges of voxels a ray may see either side:
/// there one of those close by must agree.
template <typename Expected>
void expect_rays(const std::vector<glm::u8vec4>& shown, glm::uvec2 size, float tolerance, Expected expected) {
  std::size_t off = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto pixel = static_cast<std::uint32_t>(i);
    const glm::vec2 middle = glm::vec2(pixel % size.x, pixel / size.x) + 0.5f;
    float least = apart(shown[i], expected(middle));
    for (int k = 0; k < 8 && least > tolerance; ++k) {
      // Rounding moves a ray by some 1e-6 of its way, less than a thousandth of a pixel here.
      const float angle = 0.785398f * static_cast<float>(k);
      least = std::min(
          least, apart(shown[i], expected(middle + 1e-3f * glm::vec2(std::cos(angle), std::sin(angle)))));
    }
    EXPECT_LE(least, tolerance) << "pixel " << i;
    off += least > tolerance;
    if (off > 10) return;
  }
}

TEST_F(DebugViewTest, SolidVoxelsAreThoseThatRaysMeet) {
  for (const glm::uvec2 size : {glm::uvec2(65, 37), glm::uvec2(3, 50)}) {
    const FrameConstants frame = frame_of(size);
    const auto shown = show(DebugView::solid, frame, Surfaces(size));
    const voxel::GridFrame& grid = room_.grid.frame();
    int seen = 0;
    expect_rays(shown, size, kRounded, [&](glm::vec2 position_px) {
      const glm::vec3 way = along(frame, position_px), direction = glm::normalize(way);
      const glm::vec3 eye = voxel::voxel_from_world(grid, frame.camera.eye_world);
      const auto hit = voxel::first_solid(room_.grid, eye, direction);
      if (!hit) return shared::backdrop();
      ++seen;
      const int axis = hit->normal.x != 0 ? 0 : hit->normal.y != 0 ? 1 : 2;
      const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
      std::uint32_t around = 0;
      for (int i = 0; i < 9; ++i) {
        glm::ivec3 beside = hit->voxel + hit->normal;
        beside[u] += i % 3 - 1;
        beside[v] += i / 3 - 1;
        if (i != 4 && room_.grid.solid(beside)) around |= 1u << i;
      }
      const glm::vec3 at = eye + direction * hit->t - glm::vec3(hit->voxel);
      const glm::vec2 f = glm::clamp(glm::vec2(at[u], at[v]), 0.0f, 1.0f);
      const float metres = hit->t * grid.voxel_size, facing = std::abs(direction[axis]);
      const float width = 2 * glm::length(frame.camera.up) / static_cast<float>(size.y) / glm::length(way) *
                          metres / grid.voxel_size / std::max(facing, 0.1f);
      return shared::solid_colour(hit->normal, shared::face_light(around, f), shared::grid_line(f, width),
                                  metres);
    });
    EXPECT_GT(seen, static_cast<int>(size.x * size.y / 4));
  }
}

}  // namespace
}  // namespace brume::passes
