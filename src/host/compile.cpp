#include "host/compile.hpp"

#include <algorithm>
#include <vector>

#include "api/smoke_field.hpp"
#include "gpu/dropped_commands.hpp"
#include "host/frame.hpp"
#include "host/tanks.hpp"
#include "host/volumes.hpp"
#include "sim/world.hpp"

namespace brume::host {
namespace {

/// Two metres ahead of a camera, in the middle of its picture.
glm::vec3 middle_of_view(const planning::View& view) {
  const scene::Camera& camera = view.camera;
  const glm::vec3 forward = glm::normalize(camera.target_world - camera.position_world);
  const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up_world));
  const scene::Frustum frustum = camera.frustum.value_or(scene::Frustum{});
  const float ahead = 2, scale = view.projection == planning::Projection::parallel ? 1 : ahead;
  const float across = scale / 2 * (frustum.left + frustum.right),
              up = scale / 2 * (frustum.down + frustum.up);
  // The smoke's grid reaches 3 m farther, and lies within the world.
  const glm::vec3 room(kMostMetres - 8);
  return glm::clamp(
      camera.position_world + ahead * forward + across * right + up * glm::cross(right, forward), -room,
      room);
}

/// A smoke in the open around a point.
std::unique_ptr<const api::SmokeField> smoke_around(glm::vec3 middle) {
  constexpr glm::ivec3 kVoxels(24);
  constexpr float kVoxelSize = 0.25f;
  const voxel::GridLayout layout{kVoxels, kVoxelSize, middle - kVoxelSize / 2 * glm::vec3(kVoxels)};
  auto level = std::make_shared<const api::LevelData>(voxel::BitGrid(layout), voxel::SurfacePlanes(),
                                                      voxel::RoleGrids());
  sim::ThrowSmoke smoke;
  smoke.from = smoke.at = sim::position_from_metres(glm::dvec3(middle));
  sim::World world(level->grid);
  world.append(smoke).value_or_throw();
  world.advance_to(64);  // a second: it is grown
  auto field = std::make_unique<api::SmokeField>(std::move(level), nullptr, 1.0f);
  field->update(world.state());
  return field;
}

/// The volumes of a frame that others may see together: none, each alone, and all.
std::vector<std::span<const brume_shown_volume>> seen_together(const brume_frame_params& frame) {
  const std::span<const brume_shown_volume> all(frame.volumes, frame.volume_count);
  std::vector<std::span<const brume_shown_volume>> sets(1);
  for (std::size_t i = 0; i < all.size(); ++i) sets.push_back(all.subspan(i, 1));
  if (all.size() > 1) sets.push_back(all);
  return sets;
}

/// A frame that is not drawn.
struct Shown {
  planning::FrameInput input;
  ShownVolumes volumes;  // that `input` points to
};
Shown shown(api::Call& call, const brume_frame_params& frame, const api::SmokeField* smoke) {
  Shown made;
  set_frame_input(frame, smoke, made.input);
  made.volumes = add_volumes(call, frame, made.input);
  add_tanks(call, frame, made.input);
  made.input.view.size_px = {};  // all of a renderer that may be smaller than the part
  return made;
}

}  // namespace

void compile(api::Call& call, DeviceData& device, const brume_renderer_params& renderer_params,
             const brume_frame_params& frame) {
  // What may be wrong, before any work.
  const VkFormat format = frame.picture.format;
  api::require(format == VK_FORMAT_UNDEFINED || can_blend(device.context, format),
               "`picture.format` must be one that the device can blend");
  brume_frame_params like = frame;
  like.picture.view = VK_NULL_HANDLE;
  render::RendererOptions options = renderer_options(renderer_params);
  scene::Scene scene;
  scene.lights = scene_lights(renderer_params.lights, renderer_params.light_count);
  const auto smoke = smoke_around(middle_of_view(shown(call, like, nullptr).input.view));
  (void)shown(call, like, smoke.get());

  // A renderer of a small size in the proportions of the host's.
  options.size_px = glm::max(options.size_px / 16u, glm::uvec2(1));
  options.smoke.prepare_all = true;
  gpu::Context context(device.host, &device.context);
  gpu::DroppedCommands commands(context);
  render::Renderer renderer(context, commands, scene, options);
  renderer.reserve_over(
      {.decals = true, .shadows = true, .tanks = frame.tank_count > 0, .samples = true, .picture = format});

  // What frames see, without and with smoke.
  for (const std::span<const brume_shown_volume> volumes : seen_together(frame)) {
    like.volumes = volumes.data();
    like.volume_count = volumes.size();
    for (const api::SmokeField* field : {static_cast<const api::SmokeField*>(nullptr), smoke.get()}) {
      const Shown one = shown(call, like, field);
      (void)renderer.plan(one.input);
    }
  }
}

}  // namespace brume::host
