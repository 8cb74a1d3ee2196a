// A level of boxes, a camera, and smoke between them.
#pragma once

#include <array>
#include <brume/brume_vulkan.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

struct Vec3 {
  float x, y, z;
};
inline Vec3 minus(Vec3 a, Vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline float dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec3 unit(Vec3 v) {
  const float length = std::sqrt(dot(v, v));
  return {v.x / length, v.y / length, v.z / length};
}

struct Box {
  float low[4], high[4], colour[4];
};
/// A floor, a wall with a gap in it, a pillar.
constexpr Box kLevel[] = {{{-8, -0.5f, -8}, {8, 0, 8}, {0.5f, 0.48f, 0.45f}},
                          {{-8, 0, -3.25f}, {-1, 3, -2.75f}, {0.6f, 0.35f, 0.25f}},
                          {{1, 0, -3.25f}, {8, 3, -2.75f}, {0.6f, 0.35f, 0.25f}},
                          {{2.5f, 0, 1}, {3.25f, 3, 1.75f}, {0.3f, 0.4f, 0.55f}}};

/// Edge of a voxel of the smoke [m].
constexpr float kVoxel = 0.25f;
/// A light behind the pillar.
constexpr Vec3 kLight{5, 2, 3.5f};
/// The depth is 1 at kNear [m] and 0 at infinity.
constexpr float kNear = 0.1f, kFieldOfView = 1.0f;

struct Camera {
  Vec3 position, forward, up;
};
/// Where a player is at a time.
inline Camera camera_at(double seconds, std::uint32_t player = 0) {
  const auto around = static_cast<float>(0.6 + 2.2 * player + 0.12 * seconds);
  const Vec3 position{9 * std::sin(around), 2.2f, 9 * std::cos(around)};
  return {position, unit(minus({0, 1.2f, 0}, position)), {0, 1, 0}};
}

/// Where a frame samples its pixels, from their middles [px].
struct Jitter {
  float x = 0, y = 0;
};
/// What one player sees: in a part of the picture.
struct View {
  Camera camera;
  std::uint32_t x, y, width, height;  // [px]
};

/// The smoke: everything that a host adds to its renderer.
struct Smoke {
  /// `has_motion`: frames have brume_renderer_motion.
  Smoke(const brume_device_params& host, std::uint32_t width, std::uint32_t height, bool has_motion)
      : level(context, triangles()),
        world(level),
        field(level),
        device(context, host),
        renderer(device, renderer_params(width, height, has_motion)) {
    brume_event grenade = brume_event_defaults(BRUME_EVENT_SMOKE, 0);
    grenade.u.smoke.voxels = brume_smoke_voxels(140, kVoxel);  // m^3
    grenade.u.smoke.from = brume::api::position(0, 1.5, 6);
    grenade.u.smoke.at = brume::api::position(0, 0.3, -1);
    brume_event shot = brume_event_defaults(BRUME_EVENT_SHOT, 192);
    shot.u.shot.origin = brume::api::position(5, 1.6, 6);
    shot.u.shot.toward = brume::api::position(0, 1.2, 0);
    world.append({grenade, shot});
  }

  /// Two triangles a side, three corners each.
  brume_triangles_params triangles() {
    for (const Box& box : kLevel)
      for (int vertex = 0; vertex < 36; ++vertex) {
        const int face = vertex / 6,
                  corner = std::array{0, 1, 2, 2, 1, 3}[static_cast<std::size_t>(vertex % 6)];
        const int axis = face / 2;
        float at[3];
        at[axis] = face % 2 ? box.high[axis] : box.low[axis];
        at[(axis + 1) % 3] = corner & 1 ? box.high[(axis + 1) % 3] : box.low[(axis + 1) % 3];
        at[(axis + 2) % 3] = corner & 2 ? box.high[(axis + 2) % 3] : box.low[(axis + 2) % 3];
        indices.push_back(static_cast<std::uint32_t>(points.size()));
        points.push_back({at[0], at[1], at[2]});
      }
    brume_triangles_params params = brume_triangles_defaults();
    params.layout = {{64, 24, 64}, kVoxel, {-8, -1, -8}};
    params.points = points.data();
    params.point_count = points.size();
    params.indices = indices.data();
    params.index_count = indices.size();
    return params;
  }

  brume_renderer_params renderer_params(std::uint32_t width, std::uint32_t height, bool has_motion) const {
    static constexpr brume_light light{
        BRUME_LIGHT_POINT, {kLight.x, kLight.y, kLight.z}, {0, -1, 0}, {60, 40, 22}, 0, 0};
    brume_renderer_params params = brume_renderer_defaults();
    params.width = width;
    params.height = height;
    params.temporal = 1;
    params.motion = has_motion ? 1 : 0;
    params.lights = &light;
    params.light_count = 1;
    params.points = points.data();
    params.point_count = points.size();
    params.indices = indices.data();
    params.index_count = indices.size();
    return params;
  }

  void record(VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed, double seconds,
              VkImageView depth, VkImageView picture, const std::vector<View>& views, Jitter jitter) {
    world.advance_to(static_cast<std::uint32_t>(seconds * 64));
    field.update(world.state());
    brume_frame_params params = brume_frame_defaults();
    params.commands = commands;
    params.frame_number = frame;
    params.completed_frame = completed;
    params.jitter_index = static_cast<std::uint32_t>(frame);
    params.continues_previous = 1;
    params.camera.vertical_fov = kFieldOfView;
    params.camera.jitter_x = jitter.x;
    params.camera.jitter_y = jitter.y;
    params.depth = {depth, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kNear, INFINITY, 1};
    params.picture = {picture, VK_FORMAT_R16G16B16A16_SFLOAT, 1.0f};
    params.ambient[0] = 0.04f;
    params.ambient[1] = 0.055f;
    params.ambient[2] = 0.09f;
    params.look.erosion = 0.7f;
    params.seconds = seconds;
    // The first view updates light and lists; the others share them.
    std::vector<brume_frame_params> parts;
    for (const View& view : views) {
      const Camera& camera = view.camera;
      params.view = static_cast<std::uint32_t>(&view - views.data());
      params.part = {view.x, view.y, view.width, view.height};
      params.camera.position = {camera.position.x, camera.position.y, camera.position.z};
      params.camera.forward = {camera.forward.x, camera.forward.y, camera.forward.z};
      parts.push_back(params);
    }
    renderer.record(&field, parts);
  }

  std::vector<brume_point> points;
  std::vector<std::uint32_t> indices;
  brume::api::Context context;
  brume::api::Level level;
  brume::api::World world;
  brume::api::Field field;
  brume::api::Device device;
  brume::api::Renderer renderer;
};
