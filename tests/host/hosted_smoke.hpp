// A renderer of the C interface on a host's device, and what a frame of it shows.
#pragma once

#include <brume/brume_vulkan.h>
#include <gtest/gtest.h>

#include <brume/brume.hpp>
#include <cmath>
#include <vector>

#include "planning/device_camera.hpp"
#include "scenario/events.hpp"
#include "scenario/world_triangles.hpp"
#include "tests/gpu/host_application.hpp"
#include "tests/render/two_smokes.hpp"

namespace brume::host {

constexpr glm::uvec2 kSize{64, 36};
constexpr std::uint32_t kTicks = 64;  // a second

#define ASSERT_OK(call) ASSERT_EQ(call, BRUME_OK) << brume_last_error()
#define EXPECT_OK(call) EXPECT_EQ(call, BRUME_OK) << brume_last_error()

/// A call is refused, with an error that has these words.
inline void expect_refused(brume_result result, brume_result expected, const std::string& words) {
  EXPECT_EQ(result, expected) << words;
  EXPECT_NE(std::string(brume_last_error()).find(words), std::string::npos) << brume_last_error();
}

inline brume_device_params params_of(const gpu::HostDevice& host) {
  brume_device_params params = brume_device_defaults();
  params.get_instance_proc_addr = host.get_instance_proc_addr;
  params.instance = host.instance;
  params.physical_device = host.physical_device;
  params.device = host.device;
  params.enabled_features = host.enabled_features;
  return params;
}

inline brume_point point_of(glm::vec3 p) {
  return {p.x, p.y, p.z};
}
inline brume_position position_of(sim::Position p) {
  return {p.x, p.y, p.z};
}

/// The level of the scenario, by its triangles.
struct Mesh {
  explicit Mesh(const scenario::Scenario& scenario) {
    for (const voxel::Triangle& t : scenario::world_triangles(scenario.scene))
      for (const glm::vec3 corner : {t.a, t.b, t.c}) {
        indices.push_back(static_cast<std::uint32_t>(points.size()));
        points.push_back(point_of(corner));
      }
  }
  /// Into the parameters of a level or a renderer.
  template <typename Params>
  void write_to(Params& params) const {
    params.points = points.data();
    params.point_count = points.size();
    params.indices = indices.data();
    params.index_count = indices.size();
  }
  std::vector<brume_point> points;
  std::vector<std::uint32_t> indices;
};

inline api::Level level_of(const api::Context& context, const scenario::Scenario& scenario,
                           const Mesh& mesh) {
  const voxel::GridLayout& layout = scenario.voxels.grid.layout();
  brume_triangles_params params = brume_triangles_defaults();
  params.layout = {
      {layout.size.x, layout.size.y, layout.size.z}, layout.voxel_size, point_of(layout.origin_world)};
  mesh.write_to(params);
  return {context, params};
}

inline brume_event event_of(const sim::ThrowSmoke& smoke) {
  brume_event event = brume_event_defaults(BRUME_EVENT_SMOKE, smoke.tick);
  event.u.smoke = {position_of(smoke.from), position_of(smoke.at),  smoke.smoke.voxels,
                   smoke.smoke.bloom_ticks, smoke.smoke.hold_ticks, smoke.smoke.dissolve_ticks};
  return event;
}
inline brume_event event_of(const sim::Shot& shot) {
  brume_event event = brume_event_defaults(BRUME_EVENT_SHOT, shot.tick);
  event.u.shot.origin = position_of(shot.origin);
  event.u.shot.toward = position_of(shot.toward);
  event.u.shot.radius_1024 = shot.radius;
  event.u.shot.reach_far_ms = shot.timing.reach_far;
  event.u.shot.expand_ms = shot.timing.expand;
  event.u.shot.stay_open_ms = shot.timing.stay_open;
  event.u.shot.fade_ms = shot.timing.fade;
  return event;
}

inline std::vector<brume_light> lights_of(const scene::Scene& scene) {
  std::vector<brume_light> lights;
  for (const scene::Light& light : scene.lights)
    lights.push_back({static_cast<std::uint32_t>(light.kind),
                      point_of(light.position_world),
                      point_of(light.direction_world),
                      {light.intensity.r, light.intensity.g, light.intensity.b},
                      std::acos(light.cos_inner),
                      std::acos(light.cos_outer)});
  return lights;
}

/// A renderer of the interface, on a host's device.
struct HostedSmoke {
  enum class Failure { none, allowed };
  static inline bool prepares_all = false, is_temporal = false, is_timed = false;
  static inline glm::uvec2 size = kSize;

  /// Where failure is allowed, made() tries again.
  HostedSmoke(const gpu::HostDevice& host, const scenario::Scenario& scenario, std::uint32_t march_scale,
              Failure failure = Failure::none)
      : mesh(scenario),
        level(level_of(context, scenario, mesh)),
        world(level),
        field(level, field_params(scenario)),
        on(params_of(host)) {
    std::vector<brume_event> events;
    for (const sim::Event& event : scenario::events_of(scenario, kTicks).value_or_throw()) {
      if (const auto* smoke = std::get_if<sim::ThrowSmoke>(&event)) events.push_back(event_of(*smoke));
      if (const auto* shot = std::get_if<sim::Shot>(&event)) events.push_back(event_of(*shot));
    }
    world.append(events);
    const bool is_made = made(scenario, march_scale);
    EXPECT_TRUE(is_made || failure == Failure::allowed) << brume_last_error();
  }
  ~HostedSmoke() {
    EXPECT_OK(brume_renderer_destroy(renderer));
    EXPECT_OK(brume_device_destroy(device));
  }
  HostedSmoke(const HostedSmoke&) = delete;
  HostedSmoke& operator=(const HostedSmoke&) = delete;

  /// Whether device and renderer exist; makes what does not.
  bool made(const scenario::Scenario& scenario, std::uint32_t march_scale) {
    if (!device && brume_device_create(context.get(), &on, &device) != BRUME_OK) return false;
    if (renderer) return true;
    brume_renderer_params params = brume_renderer_defaults();
    params.width = size.x;
    params.height = size.y;
    params.march_scale = march_scale;
    params.prepare_all = prepares_all ? 1 : 0;
    params.temporal = is_temporal ? 1 : 0;
    params.timings = is_timed ? 1 : 0;
    const std::vector<brume_light> lights = lights_of(scenario.scene);
    params.lights = lights.data();
    params.light_count = lights.size();
    mesh.write_to(params);
    return brume_renderer_create(device, &params, &renderer) == BRUME_OK;
  }
  /// The field at a time.
  void advance_to(double seconds) {
    world.advance_to(static_cast<std::uint32_t>(seconds * kTicks));
    field.update(world.state());
  }
  static brume_field_params field_params(const scenario::Scenario& scenario) {
    brume_field_params params = brume_field_defaults();
    params.extinction = scenario.timeline.smoke.extinction;
    return params;
  }

  api::Context context;
  Mesh mesh;
  api::Level level;
  api::World world;
  api::Field field;
  brume_device_params on;
  brume_device* device = nullptr;
  brume_renderer* renderer = nullptr;
};

/// What a frame of the interface shows, as the timeline's frame does.
inline brume_frame_params frame_of(const scenario::Scenario& scenario, double seconds) {
  brume_frame_params params = brume_frame_defaults();
  const scene::Camera& camera = scenario.camera;
  params.camera.position = point_of(camera.position_world);
  params.camera.forward = point_of(camera.target_world - camera.position_world);
  params.camera.vertical_fov = camera.vertical_fov;
  params.depth.near_plane = planning::kNearPlane;
  params.depth.far_plane = INFINITY;
  params.depth.reversed = 1;
  params.look.erosion = scenario.timeline.smoke.erosion;
  const scene::SkyOptions& sky = scenario.timeline.sky;
  for (int c = 0; c < 3; ++c) params.ambient[c] = sky.ambient[c];
  params.ambient_indoors = sky.bounce;
  params.seconds = seconds;
  return params;
}

}  // namespace brume::host
