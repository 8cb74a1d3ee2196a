// Views of numbers: what a slice shows, and what is counted or measured along rays.
#include <cmath>

#include "smoke/sight_holes.hpp"
#include "tests/passes/debug_view_room.hpp"

namespace brume::passes {
namespace {

using shared::FrameConstants;

class DebugNumbersTest : public DebugViewTest {
 protected:
  /// Where a ray meets a slice, and what the view shows there besides smoke.
  struct OnSlice {
    bool inside = false;  // of the level's grid
    bool solid = false;
    glm::vec3 p_voxel{0};
    glm::vec3 empty{0};
    float metres = 0;
  };
  OnSlice on_slice(const Ray& ray, ViewSlice slice) const {
    const voxel::GridLayout& grid = room_.grid.layout();
    const int axis = static_cast<int>(slice.axis);
    const float at = (slice.at_world - grid.origin_world[axis]) / grid.voxel_size;
    OnSlice on;
    const float t = (at - ray.eye_voxel[axis]) / ray.direction[axis];
    on.metres = t * grid.voxel_size;
    on.p_voxel = ray.eye_voxel + t * ray.direction;
    on.p_voxel[axis] = at;
    on.inside = t > 0 && room_.grid.contains(glm::ivec3(glm::floor(on.p_voxel)));
    if (!on.inside) return on;
    on.solid = room_.grid.solid(glm::ivec3(on.p_voxel));
    const glm::vec3 f = glm::fract(on.p_voxel);
    const glm::ivec2 axes = face_axes(axis);
    const float line =
        shared::grid_line({f[axes.x], f[axes.y]}, ray.pixel_voxels(on.metres, std::abs(ray.direction[axis])));
    on.empty = on.solid ? shared::slice_wall(line) : shared::slice_air(line, ray.behind);
    return on;
  }
};

// Texture units weigh with 8 bits in each of three axes and may round to 8 bits after each (DensityTest).
constexpr float kDensitySlack = 3 * 0.5f / 256 + 3 * 0.5f / 255;

TEST_F(DebugNumbersTest, ASliceShowsTheDensityThatTheProcessorReads) {
  for (const glm::uvec2 size : {glm::uvec2(65, 37), glm::uvec2(2, 1)}) {
    const FrameConstants frame = frame_of(size);
    const Surfaces surfaces = half_a_wall(frame);
    for (const ViewSlice slice :
         {ViewSlice{1, 0.6f}, ViewSlice{2, -1.22f}, ViewSlice{0, -1.4f}, ViewSlice{1, 2.7f}}) {
      const auto shown = show(DebugView::density, frame, surfaces, slice);
      int smoky = 0;
      expect_rays(shown, size, kRounded, [&](glm::vec2 position_px, glm::u8vec4 pixel) {
        const Ray ray = ray_of(frame, surfaces, position_px);
        const OnSlice on = on_slice(ray, slice);
        if (!on.inside) return apart(pixel, ray.behind);
        const float density = on.solid ? 0 : smoke::sample_density(room_.volume, on.p_voxel);
        smoky += density > 0.1f;
        return apart_within(pixel, density, density > 0 ? kDensitySlack : 0, [&](float d) {
          return past_surface(ray, on.solid ? on.empty : shared::density_colour(d, on.empty), on.metres);
        });
      });
      EXPECT_GE(smoky, size.x > 2 && slice.at_world < 1 ? 60 : 0);
    }
  }
  // What the processor reads in the middle of a voxel off the walls is the state's density.
  int compared = 0;
  for_each_in({glm::ivec3(2), room_.grid.size() - 2}, [&](glm::ivec3 v) {
    bool open = true;
    for_each_in({v - 1, v + 2}, [&](glm::ivec3 beside) { open = open && !room_.grid.solid(beside); });
    if (!open) return;
    EXPECT_NEAR(smoke::sample_density(room_.volume, glm::vec3(v) + 0.5f),
                room_.world.state().density(v) / 255.0f, 1e-5f);
    ++compared;
  });
  EXPECT_GT(compared, 1000);
}

TEST_F(DebugNumbersTest, ASliceShowsTheLightThatTheSmokeSends) {
  const glm::uvec2 size(65, 37);
  FrameConstants frame = frame_of(size);
  frame.exposure = 0.5f;
  runner().run([&](gpu::Recorder& recorder) {
    recorder.clear(room_.upload.resources().inscatter, {{0.8f, 0.8f, 0.8f, 1.0f}});
  });
  // Grey below the tone curve's shoulder: all that it does is to take away 0.04.
  const double grey = 0.8 * 0.9 * 0.5 - 0.04;
  const glm::vec3 light(static_cast<float>(1.055 * std::pow(grey, 1 / 2.4) - 0.055));
  const Surfaces surfaces = half_a_wall(frame);
  const ViewSlice slice{1, 0.6f};
  const auto shown = show(DebugView::light, frame, surfaces, slice);
  int lit = 0;
  // The texture holds half floats: 0.8 is 0.0002 off in it, less than a tenth of a step.
  expect_rays(shown, size, kRounded + 0.1f, [&](glm::vec2 position_px, glm::u8vec4 pixel) {
    const Ray ray = ray_of(frame, surfaces, position_px);
    const OnSlice on = on_slice(ray, slice);
    if (!on.inside) return apart(pixel, ray.behind);
    const float density = on.solid ? 0 : smoke::sample_density(room_.volume, on.p_voxel);
    lit += density > 0.1f;
    return apart_within(pixel, density, density > 0 ? kDensitySlack : 0, [&](float d) {
      return past_surface(ray, glm::mix(on.empty, light, glm::smoothstep(0.0f, 0.06f, d)), on.metres);
    });
  });
  EXPECT_GT(lit, 60);
}

/// Length of a ray over which holes remove the smoke [m].
double cleared_length(const smoke::HolesOnRay& met) {
  double length = 0;
  for (const smoke::HolePiece& piece : met.pieces) {
    constexpr int kParts = 64;  // of a piece without kinks, four samples each
    const float width = (piece.end - piece.begin) / kParts;
    for (int i = 0; i < kParts; ++i) {
      Float4 t;
      for (int k = 0; k < 4; ++k)
        t[k] = piece.begin + (static_cast<float>(i) + 0.125f + 0.25f * static_cast<float>(k)) * width;
      const Float4 remaining = piece.gone ? Float4{} : met.remaining(piece, t);
      for (int k = 0; k < 4; ++k) length += 0.25 * static_cast<double>(width * (1 - remaining[k]));
    }
  }
  return length;
}

TEST_F(DebugNumbersTest, HolesShowHowMuchOfARayTheyClear) {
  const glm::uvec2 size(65, 37);
  FrameConstants frame = frame_of(size);
  frame.time = 1.2f;
  frame.look.step_length = 0.02f;
  for (int i = 0; i < 3; ++i) {
    shared::Hole hole{};
    hole.origin_world = {-2.0f + static_cast<float>(i), 0.6f + 0.3f * static_cast<float>(i), 3.5f};
    hole.forward = glm::normalize(glm::vec3(0.1f * static_cast<float>(i), 0.05f, -1));
    hole.right = glm::normalize(glm::cross(hole.forward, glm::vec3(0, 1, 0)));
    hole.up = glm::cross(hole.right, hole.forward);
    hole.radius = 0.3f + 0.1f * static_cast<float>(i);
    hole.distance_to_far = 6;
    hole.time_to_reach_far = 0.25f;
    hole.time_start = i == 2 ? 1.1f : 0.2f;  // the last has not reached its far end
    hole.time_to_expand = 0.05f;
    hole.time_to_stay_open = 5;
    hole.time_to_fade = 0.35f;
    hole.shape = i == 1 ? shared::kHoleBox : shared::kHoleCylinder;
    open_.push_back(hole);
  }
  const Surfaces surfaces = half_a_wall(frame);
  const auto shown = show(DebugView::holes, frame, surfaces);
  const smoke::HoleSet holes(open_, frame.time, nullptr);
  const voxel::GridLayout& grid = room_.grid.layout();
  int cleared = 0;
  expect_rays(shown, size, kRounded, [&](glm::vec2 position_px, glm::u8vec4 pixel) {
    const Ray ray = ray_of(frame, surfaces, position_px);
    // Within the smoke's bounds and before the surface.
    const glm::vec3 a = (frame.smoke.bounds_min - ray.eye_voxel) / ray.direction,
                    b = (frame.smoke.bounds_max - ray.eye_voxel) / ray.direction;
    const glm::vec3 enter = glm::min(a, b), leave = glm::max(a, b);
    const float begin = std::max({enter.x, enter.y, enter.z, 0.0f}) * grid.voxel_size;
    const float end = std::min({std::min({leave.x, leave.y, leave.z}) * grid.voxel_size, ray.surface_m});
    double length = 0;
    if (begin < end) {
      smoke::HolesOnRay met;
      const glm::vec3 origin = frame.camera.eye_world + ray.direction * begin;
      holes.find(origin, ray.direction, end - begin, met);
      length = cleared_length(met);
    }
    cleared += length > 0.1;
    // Midpoints of steps: each of three holes rises to 1 and falls to 0 again, and a sum of steps misses at
    // most half a step's length for each rise of 1.
    const float slack = 3 * 0.25f * frame.look.step_length;
    return apart_within(pixel, static_cast<float>(length), length > 0 ? slack : 0, [&](float metres) {
      return shared::heat_colour(shared::kRampPlasma, std::max(metres, 0.0f) / 2, ray.behind);
    });
  });
  EXPECT_GT(cleared, 60);
}

TEST_F(DebugNumbersTest, StepsAreThoseThatTheMarchCounted) {
  const glm::uvec2 size(33, 17);
  const FrameConstants frame = frame_of(size);
  std::vector<std::uint32_t> counted(1 + size.x * size.y);
  for (std::size_t i = 0; i < counted.size(); ++i) counted[i] = static_cast<std::uint32_t>(i % 131);
  pass_.reserve({DebugView::steps, {}, {&room_.grid, nullptr}, &room_.volume, nullptr}, size);
  runner().run([&](gpu::Recorder& recorder) {
    recorder.upload(pass_.counters(), 0, std::as_bytes(std::span(counted)));
  });
  const Surfaces surfaces = half_a_wall(frame);
  const auto shown = show(DebugView::steps, frame, surfaces);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const float share = static_cast<float>(counted[i + 1]) / 96;
    const glm::vec3 expected =
        shared::heat_colour(shared::kRampInferno, share, ray_of(frame, surfaces, middle(frame, i)).behind);
    EXPECT_LE(apart(shown[i], expected), kRounded) << i;
  }
}

TEST_F(DebugNumbersTest, OverdrawIsTheNumberOfQuads) {
  const glm::uvec2 size(141, 17);
  const FrameConstants frame = frame_of(size);
  const Surfaces surfaces = half_a_wall(frame);
  const auto shown = show(DebugView::overdraw, frame, surfaces);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const float quads = from_half(quads_of(size)[i]).x;
    const glm::vec3 expected = shared::heat_colour(shared::kRampInferno, quads / 128,
                                                   ray_of(frame, surfaces, middle(frame, i)).behind);
    EXPECT_LE(apart(shown[i], expected), kRounded) << i;
  }
}

}  // namespace
}  // namespace brume::passes
