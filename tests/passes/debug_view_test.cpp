#include "passes/debug_view.hpp"

#include <map>
#include <random>

#include "tests/passes/debug_view_room.hpp"
#include "voxel/traverse.hpp"

namespace brume::passes {
namespace {

using shared::FrameConstants;

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
        for (const auto& image : {normals, albedo, depth})
          EXPECT_LE(apart(image[i], shared::backdrop()), kRounded);
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

TEST_F(DebugViewTest, SolidVoxelsAreThoseThatRaysMeet) {
  for (const glm::uvec2 size : {glm::uvec2(65, 37), glm::uvec2(3, 50)}) {
    const FrameConstants frame = frame_of(size);
    const Surfaces nothing(size);
    const auto shown = show(DebugView::solid, frame, nothing);
    int met = 0;
    expect_rays(shown, size, kRounded, [&](glm::vec2 position_px, glm::u8vec4 pixel) {
      const Ray ray = ray_of(frame, nothing, position_px);
      const auto hit = voxel::first_solid(room_.grid, ray.eye_voxel, ray.direction);
      if (!hit) return apart(pixel, shared::backdrop());
      ++met;
      const int axis = hit->normal.x != 0 ? 0 : hit->normal.y != 0 ? 1 : 2;
      const glm::ivec2 axes = face_axes(axis);
      std::uint32_t around = 0;
      for (int i = 0; i < 9; ++i) {
        glm::ivec3 beside = hit->voxel + hit->normal;
        beside[axes.x] += i % 3 - 1;
        beside[axes.y] += i / 3 - 1;
        if (i != 4 && room_.grid.solid(beside)) around |= 1u << i;
      }
      const glm::vec3 at = ray.eye_voxel + ray.direction * hit->t - glm::vec3(hit->voxel);
      const glm::vec2 f = glm::clamp(glm::vec2(at[axes.x], at[axes.y]), 0.0f, 1.0f);
      const float metres = hit->t * room_.grid.layout().voxel_size;
      const float line = shared::grid_line(f, ray.pixel_voxels(metres, std::abs(ray.direction[axis])));
      return apart(pixel, shared::solid_colour(hit->normal, shared::face_light(around, f), line, metres));
    });
    EXPECT_GT(met, static_cast<int>(size.x * size.y / 4));
  }
}

/// Voxels that hold smoke, and the distance that it came to each, in tenths of a voxel.
std::map<std::array<int, 3>, std::uint32_t> distances_of(const sim::State& state) {
  std::map<std::array<int, 3>, std::uint32_t> distances;
  for (const sim::LiveCloud& live : state.clouds)
    live.cloud->voxels().for_each([&](glm::ivec3 v, std::uint32_t rank) {
      if (state.density(v) > 0) distances[{v.x, v.y, v.z}] = live.cloud->distances()[rank];
    });
  return distances;
}

/// Coverage of the lines on a face of a voxel: the grid, and where the distance passes a whole metre.
float line_on_face(const auto& distance_at, glm::ivec3 voxel, glm::ivec2 axes, glm::vec2 f, float width) {
  float line = 0.18f * shared::grid_line(f, width);
  for (int side = 0; side < 4; ++side) {
    glm::ivec3 beside(0);
    beside[side < 2 ? axes.x : axes.y] = side % 2 == 0 ? -1 : 1;
    const float other = distance_at(voxel + beside), x = side < 2 ? f.x : f.y;
    if (other >= 0 && std::floor(other) != std::floor(distance_at(voxel)))
      line = std::max(line, 0.75f * shared::line_coverage(side % 2 == 0 ? x : 1 - x, 1.5f * width));
  }
  return line;
}

float farthest_metres(const sim::Cloud& cloud) {
  float farthest = 0;
  for (const std::uint32_t distance : cloud.distances())
    farthest = std::max(farthest, static_cast<float>(distance) * 0.025f);
  return farthest;
}

TEST_F(DebugViewTest, DistancesAreThoseOfTheCloudBeyondTheSlice) {
  const auto distances = distances_of(room_.world.state());
  ASSERT_GT(distances.size(), 1500u);
  const auto distance_at = [&](glm::ivec3 v) {
    const auto found = distances.find({v.x, v.y, v.z});
    return found == distances.end()
               ? -1.0f
               : static_cast<float>(found->second) * 0.1f * room_.grid.layout().voxel_size;
  };
  const float farthest = farthest_metres(*room_.world.state().clouds[0].cloud);
  const glm::uvec2 size(65, 37);
  const FrameConstants frame = frame_of(size);
  const Surfaces surfaces = half_a_wall(frame);
  const float voxel_size = room_.grid.layout().voxel_size;
  for (const ViewSlice slice : {ViewSlice{2, 5.0f}, ViewSlice{2, -0.975f}, ViewSlice{0, -1.22f}}) {
    const auto shown = show(DebugView::distance, frame, surfaces, slice);
    const int across = static_cast<int>(slice.axis);
    int met = 0, cut = 0;
    expect_rays(shown, size, kRounded, [&](glm::vec2 position_px, glm::u8vec4 pixel) {
      const Ray ray = ray_of(frame, surfaces, position_px);
      const float t_slice = (slice.at_world - frame.camera.eye_world[across]) / ray.direction[across];
      if (!(t_slice > 0)) return apart(pixel, ray.behind);
      const float t_begin = std::max(1.0f, t_slice) / voxel_size;
      glm::ivec3 voxel(-1), before(-1);
      float t = 0;
      voxel::visit_voxels(room_.grid.layout(), ray.eye_voxel, ray.direction, 1e6f,
                          [&](glm::ivec3 v, float enter, float leave) {
                            if (leave > t_begin && distance_at(v) >= 0) {
                              voxel = v;
                              t = std::max(enter, t_begin);
                              return false;
                            }
                            before = v;
                            return true;
                          });
      if (voxel.x < 0) return apart(pixel, ray.behind);
      ++met;
      glm::ivec3 normal = before - voxel;
      if (t == t_begin) {  // it begins inside
        normal = glm::ivec3(0);
        normal[across] = ray.direction[across] > 0 ? -1 : 1;
        ++cut;
      }
      const int axis = normal.x != 0 ? 0 : normal.y != 0 ? 1 : 2;
      const glm::ivec2 axes = face_axes(axis);
      const glm::vec3 at = ray.eye_voxel + ray.direction * t - glm::vec3(voxel);
      const glm::vec2 f = glm::clamp(glm::vec2(at[axes.x], at[axes.y]), 0.0f, 1.0f);
      const float metres = t * voxel_size, width = ray.pixel_voxels(metres, std::abs(ray.direction[axis]));
      const float distance = distance_at(voxel);
      const float line = line_on_face(distance_at, voxel, axes, f, width);
      const glm::vec3 colour = shared::ramp_colour(shared::kRampViridis, distance / std::ceil(farthest));
      const glm::vec3 lit = glm::min(colour * shared::distance_tone(normal), 1.0f) * (1 - line);
      return apart(pixel, past_surface(ray, lit, metres));
    });
    EXPECT_GT(met, 150);
    EXPECT_EQ(cut > 100, slice.at_world < 4) << cut;
    EXPECT_EQ(cut == 0, slice.at_world > 4) << cut;
  }
}

TEST_F(DebugViewTest, BricksShowWhereTheyAreAndNothingElsewhere) {
  const glm::uvec2 size(65, 37);
  const FrameConstants frame = frame_of(size);
  const Surfaces surfaces = half_a_wall(frame);
  const auto shown = show(DebugView::bricks, frame, surfaces);
  int through = 0, past = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const Ray ray = ray_of(frame, surfaces, middle(frame, i));
    const float t_end = ray.surface_m / room_.grid.layout().voxel_size;
    // The longest distance through one brick's filled cells; -1 where the ray is in no brick.
    float filled = -1;
    for (std::uint32_t slot = 0; slot < room_.volume.slot_count(); ++slot) {
      const glm::vec3 low(room_.volume.brick_of(slot) * 8);
      const std::uint32_t cells = filled_cells(room_.volume, slot);
      const glm::vec3 cells_low(shared::cells_low(cells)), cells_end(shared::cells_end(cells));
      const auto way_in = [&](glm::vec3 from, glm::vec3 to) {
        const glm::vec3 a = (from - ray.eye_voxel) / ray.direction, b = (to - ray.eye_voxel) / ray.direction;
        const glm::vec3 enter = glm::min(a, b), leave = glm::max(a, b);
        return std::min({leave.x, leave.y, leave.z, t_end}) - std::max({enter.x, enter.y, enter.z, 0.0f});
      };
      if (way_in(low - 0.02f, low + 8.02f) <= 0) continue;
      filled = std::max(filled, 0.0f);
      if (cells_end.x > cells_low.x)
        filled = std::max(
            filled, way_in(low + glm::max(cells_low - 0.5f, 0.0f), low + glm::min(cells_end - 0.5f, 8.0f)));
    }
    if (filled < 0) {
      EXPECT_LE(apart(shown[i], ray.behind), kRounded) << i;
      ++past;
    } else if (filled > 2) {
      // Two voxels of a filled brick cover 7 %, in a colour that is far from grey.
      EXPECT_GT(apart(shown[i], ray.behind), 3) << i;
      ++through;
    }
  }
  EXPECT_GT(through, 200);
  EXPECT_GT(past, 200);
}

TEST_F(DebugViewTest, TheLegendSaysWhatTheColoursAre) {
  const glm::uvec2 size(320, 180);
  const FrameConstants frame = frame_of(size);
  const auto at = [&](const std::vector<glm::u8vec4>& shown, std::uint32_t x, std::uint32_t y) {
    return shown[x + std::size_t{size.x} * y];
  };
  const auto depth = show(DebugView::depth, frame, Surfaces(size));
  for (std::uint32_t x = 0; x < 88; ++x)
    for (std::uint32_t y = 156; y < 161; ++y) {
      const float share = (static_cast<float>(x) + 0.5f) / 88;
      EXPECT_LE(apart(at(depth, 18 + x, y), shared::ramp_colour(shared::kRampViridis, share)), kRounded);
    }
  // 64m, 8m and 1m: in the rows of the digits so many pixels are inked.
  int inked = 0;
  for (std::uint32_t x = 0; x < size.x; ++x)
    for (std::uint32_t y = 164; y < 169; ++y) inked += at(depth, x, y).g > 200;
  constexpr int kSix = 12, kFour = 9, kM = 10, kEight = 13, kOne = 8;
  EXPECT_EQ(inked, kSix + kFour + kM + kEight + kM + kOne + kM);
  // Elsewhere nothing, and nothing at all in an image too small.
  for (std::uint32_t y = 0; y < 150; ++y) EXPECT_LE(apart(at(depth, 20, y), shared::backdrop()), kRounded);
  for (const glm::u8vec4 pixel : show(DebugView::depth, frame_of({199, 180}), Surfaces({199, 180})))
    EXPECT_LE(apart(pixel, shared::backdrop()), kRounded);
}

TEST(Ramps, BeginDarkEndLightAndNeverGetDarker) {
  for (std::uint32_t ramp = 0; ramp < 4; ++ramp) {
    double last = -1;
    for (int i = 0; i <= 256; ++i) {
      const glm::dvec3 c(shared::ramp_colour(ramp, static_cast<float>(i) / 256));
      const double lightness = glm::dot(glm::pow(c, glm::dvec3(2.2)), glm::dvec3(0.2126, 0.7152, 0.0722));
      EXPECT_GE(lightness, last) << ramp << " at " << i;
      last = lightness;
    }
    EXPECT_GT(last, 0.6);
    EXPECT_EQ(shared::ramp_colour(ramp, -1), shared::ramp_colour(ramp, 0));
    EXPECT_EQ(shared::ramp_colour(ramp, 2), shared::ramp_colour(ramp, 1));
  }
}

}  // namespace
}  // namespace brume::passes
