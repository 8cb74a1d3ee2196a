#include "apps/viewer/tank_handles.hpp"

#include "scene/options.hpp"

namespace brume::viewer {
namespace {

template <typename Owner>
void move_with_keys(Owner& owner, const glm::vec3& by) {
  const auto in_range = [](const glm::vec3& place) {
    const glm::vec3 farthest(static_cast<float>(scene::kFarthestPoint));
    return glm::clamp(place, -farthest, farthest);
  };
  owner.position_world = in_range(owner.position_world + by);
  for (auto& key : owner.keys) key.position_world = in_range(key.position_world + by);
}

}  // namespace

std::vector<TankHandle> handles_of(const scene::TankScene& scene) {
  std::vector<TankHandle> handles;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) handles.push_back({TankHandle::Kind::light, i});
  if (scene.glass) handles.push_back({TankHandle::Kind::glass, 0});
  return handles;
}

glm::vec3 place_of(const scene::TankScene& scene, const TankHandle& handle, double time) {
  if (handle.kind == TankHandle::Kind::glass) return scene::glass_at(*scene.glass, time).position_world;
  return scene::light_at(scene.lights[handle.index], time).position_world;
}

std::optional<TankMark> mark_in(const scene::Camera& camera, glm::vec2 size, const glm::vec3& world) {
  constexpr float kEdge = 14;  // [px]
  const auto at = in_picture(camera, size, world);
  if (!at) return std::nullopt;
  const glm::vec2 inside = glm::clamp(*at, glm::vec2(0), size);
  if (inside == *at) return TankMark{*at, false};
  return TankMark{glm::clamp(*at, glm::vec2(kEdge), glm::max(size - kEdge, glm::vec2(kEdge))), true};
}

std::optional<TankHandle> handle_at(const scene::TankScene& scene, double time, const scene::Camera& camera,
                                    glm::vec2 size, glm::vec2 point, float reach) {
  std::optional<TankHandle> nearest;
  for (const TankHandle& handle : handles_of(scene)) {
    const auto mark = mark_in(camera, size, place_of(scene, handle, time));
    if (!mark || glm::distance(mark->at, point) > reach) continue;
    reach = glm::distance(mark->at, point);
    nearest = handle;
  }
  return nearest;
}

void move_handle(scene::TankScene& scene, const TankHandle& handle, double time, const glm::vec3& to) {
  const glm::vec3 by = to - place_of(scene, handle, time);
  if (handle.kind == TankHandle::Kind::glass) {
    move_with_keys(*scene.glass, by);
  } else {
    move_with_keys(scene.lights[handle.index], by);
  }
}

}  // namespace brume::viewer
