// A timeline: a scene, a camera path and timed events. Rendering it twice gives identical images.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera_path.hpp"
#include "scene/carrier.hpp"
#include "scene/decal_options.hpp"
#include "scene/events.hpp"
#include "scene/level_tank.hpp"
#include "scene/scene.hpp"
#include "scene/sky.hpp"
#include "scene/smoke_options.hpp"
#include "scene/tone.hpp"
#include "scene/volume_options.hpp"

namespace brume::scene {

// Units, ranges and meanings: of settings scene/options.hpp, of events scene/event_fields.hpp.

/// Placement of the voxel grid. Without size and origin the grid covers the scene's bounds and its smokes.
struct GridOptions {
  float voxel = 0.25f;
  std::optional<glm::ivec3> size;
  std::optional<glm::vec3> origin_world;
};

/// The role of all objects of a name, in the place of what the scene's file gives them.
struct RoleOptions {
  std::string object;
  Role role = Role::wall;
  std::string place = {};  ///< "file:line:column" for error messages.
};

template <typename Value>
using Plain = Value;

/// How pictures are lit and exposed. With std::optional as Field: settings of which some are given.
template <template <typename> typename Field = Plain>
struct PictureSettings {
  Field<float> exposure{};
  Field<std::uint32_t> bounces{};
  Field<ToneCurve> tone{};
};

struct Timeline : EventLists, PictureSettings<> {
  std::filesystem::path scene;  ///< Resolved against the timeline's own folder.
  float duration = 4.0f;
  glm::vec3 origin{0};
  float scale = 1;
  std::optional<float> ground;
  GridOptions grid;
  SmokeOptions smoke;
  SkyOptions sky;
  std::optional<SunOptions> sun;
  std::vector<Carrier> carriers;
  std::vector<VolumeOptions> volumes;
  std::vector<DecalOptions> decals;
  std::vector<TankOptions> tanks;
  std::vector<RoleOptions> roles;
  std::vector<CameraKey> camera;  ///< Sorted by time, no two times equal.
};

/// Sorts each list of events by time. Stable: events of the same time keep their order.
void sort_events(Timeline& timeline);

/// The camera of a timeline at a time [s].
inline Camera camera_at(const Timeline& timeline, const Camera& fallback, double time) {
  return camera_at(timeline.camera, fallback, time);
}

}  // namespace brume::scene
