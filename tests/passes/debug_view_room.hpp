// A room that debug views are taken of, and what its pixels are compared with.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "passes/debug_view.hpp"
#include "shared/frame.h"
#include "tests/passes/half.hpp"
#include "tests/passes/smoke_room.hpp"

namespace brume::passes {

using shared::FrameConstants;

/// A room with a wall of its own in the middle, smoke in it.
inline std::vector<voxel::Triangle> room_walls() {
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
      : room_(context(), runner(), room_walls(), {{37, 15, 37}, 0.25f, {-4.6f, -0.5f, -4.6f}}, {-1, 0.6, -1},
              2500, 200),
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
    frame.smoke = room_.volume.layout();
    frame.look.albedo = glm::vec3(0.9f);
    frame.look.extinction = 0.7f;
    frame.look.step_length = 0.1f;
    frame.look.noise_frequency = 1;
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

  /// A pixel's ray, or one close by.
  struct Ray {
    glm::vec3 eye_voxel, direction;
    float surface_m;       ///< To what the G-buffer has there.
    glm::vec3 behind;      ///< How the scene shows below the view.
    float pixel_at_metre;  ///< [voxels]
    float pixel_voxels(float metres, float facing) const {
      return pixel_at_metre * metres / std::max(facing, 0.1f);
    }
  };
  struct Surfaces;
  Ray ray_of(const FrameConstants& frame, const Surfaces& surfaces, glm::vec2 position_px) const {
    const voxel::GridLayout& grid = room_.grid.layout();
    const glm::vec3 way = along(frame, position_px);
    Ray ray{voxel::voxel_from_world(grid, frame.camera.eye_world), glm::normalize(way), 1e9f,
            shared::backdrop(), 0};
    const glm::uvec2 px(position_px);
    const std::size_t i = px.x + std::size_t{frame.size_px.x} * px.y;
    ray.pixel_at_metre = 2 * glm::length(frame.camera.up) / static_cast<float>(frame.size_px.y) /
                         glm::length(way) / grid.voxel_size;
    if (surfaces.depth[i] > 0) {
      ray.surface_m = frame.camera.near_z / surfaces.depth[i] * glm::length(way);
      const glm::vec3 normal = glm::normalize(glm::vec3(from_half(surfaces.normal[i])));
      ray.behind = shared::dimmed_surface(surfaces.luminance(i), std::abs(glm::dot(normal, ray.direction)));
    }
    return ray;
  }
  /// The colour at a distance, mixed over a surface that is nearer.
  static glm::vec3 past_surface(const Ray& ray, glm::vec3 colour, float metres) {
    return metres > ray.surface_m ? glm::mix(ray.behind, colour, shared::kOccludedOpacity) : colour;
  }
  /// The axes of a face across `axis`.
  static glm::ivec2 face_axes(int axis) { return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}; }

  /// What the G-buffer holds, pixel by pixel.
  struct Surfaces {
    std::vector<glm::u8vec4> albedo;  // as sRGB
    std::vector<Half4> normal;
    std::vector<float> depth;
    explicit Surfaces(glm::uvec2 size)
        : albedo(std::size_t{size.x} * size.y),
          normal(albedo.size(), to_half({0, 0, 1, 0})),
          depth(albedo.size()) {}
    /// Of the albedo, linear.
    float luminance(std::size_t i) const {
      const glm::dvec3 encoded = glm::dvec3(albedo[i]) / 255.0;
      double sum = 0;
      for (int c = 0; c < 3; ++c) {
        const double linear =
            encoded[c] <= 0.04045 ? encoded[c] / 12.92 : std::pow((encoded[c] + 0.055) / 1.055, 2.4);
        sum += linear * glm::dvec3(0.2126, 0.7152, 0.0722)[c];
      }
      return static_cast<float>(sum);
    }
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

  /// Nothing on the left, a grey surface some way off on the right.
  static Surfaces half_a_wall(const FrameConstants& frame) {
    Surfaces surfaces(frame.size_px);
    for (std::size_t i = 0; i < surfaces.depth.size(); ++i) {
      if (2 * (i % frame.size_px.x) < frame.size_px.x) continue;
      surfaces.albedo[i] = {120, 130, 90, 255};
      surfaces.depth[i] = frame.camera.near_z / 5.5f;
    }
    return surfaces;
  }

  /// As many quads on a pixel as its column.
  static std::vector<Half4> quads_of(glm::uvec2 size) {
    std::vector<Half4> quads(std::size_t{size.x} * size.y);
    for (std::size_t i = 0; i < quads.size(); ++i)
      quads[i] = to_half(glm::vec4(static_cast<float>(i % size.x), 0, 0, 0));
    return quads;
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
    const auto holes =
        planning::plan_holes(open_, frame.time, 0, frame.smoke, room_.volume.slot_count(), size);
    holes_.reserve(holes);
    frame.holes = holes.layout();
    const auto frame_buffer = upload(std::vector{frame});
    const auto display = test_image(context(), size, VK_FORMAT_R8G8B8A8_UNORM);
    const auto quads = upload_image(context(), runner(), size, VK_FORMAT_R16G16B16A16_SFLOAT, quads_of(size));
    const DebugSubject subject{view, slice, {&room_.grid, nullptr}, &room_.volume, &room_.world.state()};
    pass_.reserve(subject, size);
    runner().run([&](gpu::Recorder& recorder) {
      holes_.record(recorder, holes, frame_buffer, room_.upload.resources());
      pass_.record(
          recorder, subject,
          {frame_buffer, gbuffer, gbuffer.depth, room_.upload.resources(), holes_.resources(), quads},
          display);
    });
    return read_back<glm::u8vec4>(display);
  }

  SmokeRoom room_;
  HoleClusters holes_;
  DebugViewPass pass_{context()};
  std::vector<shared::Hole> open_;
};

/// How far a shown colour is from one in [0, 1], in steps of 255.
inline float apart(glm::u8vec4 shown, glm::vec3 expected) {
  const glm::vec3 d = glm::abs(glm::vec3(shown) - 255.0f * glm::clamp(expected, 0.0f, 1.0f));
  return std::max({d.x, d.y, d.z});
}

// A step of 255 is rounded to the nearest; powers and logarithms of a device are good for far more than a
// tenth of one.
constexpr float kRounded = 0.6f;

/// Every pixel against what its ray should show: `off(position_px, shown)` says how far it is from that. At
/// the edges of voxels a ray may see either side: there one of those close by must agree.
template <typename Off>
void expect_rays(const std::vector<glm::u8vec4>& shown, glm::uvec2 size, float tolerance, Off off) {
  std::size_t bad = 0;
  for (std::size_t i = 0; i < shown.size() && bad < 10; ++i) {
    const auto pixel = static_cast<std::uint32_t>(i);
    const glm::vec2 middle = glm::vec2(pixel % size.x, pixel / size.x) + 0.5f;
    float least = off(middle, shown[i]);
    for (int k = 0; k < 8 && least > tolerance; ++k) {
      // Rounding moves a ray by some 1e-6 of its way, less than a thousandth of a pixel here.
      const float angle = 0.785398f * static_cast<float>(k);
      least = std::min(least, off(middle + 1e-3f * glm::vec2(std::cos(angle), std::sin(angle)), shown[i]));
    }
    EXPECT_LE(least, tolerance) << "pixel " << i;
    bad += least > tolerance;
  }
}

/// The least distance from a colour of a number within `slack` of x; `colour` changes by less than 60 steps
/// of 255 for each hundredth.
template <typename Colour>
float apart_within(glm::u8vec4 shown, float x, float slack, Colour colour) {
  const int parts = 1 + static_cast<int>(slack * 1e5f);  // each less than a tenth of a step
  float least = apart(shown, colour(x));
  for (int i = -parts; i <= parts && least > kRounded; ++i)
    least =
        std::min(least, apart(shown, colour(x + slack * static_cast<float>(i) / static_cast<float>(parts))));
  return least;
}

}  // namespace brume::passes
