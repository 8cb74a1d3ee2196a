#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>

#include "apps/cli/info.hpp"
#include "apps/cli/scene_options.hpp"
#include "apps/command_line/console.hpp"
#include "core/log.hpp"
#include "scenario/free_place.hpp"
#include "scenario/simulation.hpp"
#include "scenario/world_triangles.hpp"
#include "scene/files/load.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/text_reader.hpp"
#include "voxel/voxelize.hpp"

namespace brume::cli {
namespace {

std::string kind_of(const scene::Light& light) {
  switch (light.kind) {
    case scene::LightKind::point:
      return "point";
    case scene::LightKind::spot:
      return "spot";
    case scene::LightKind::directional:
      return "directional";
  }
  return "";
}

void add_lights(Summary& summary, const scene::Scene& scene) {
  constexpr std::size_t kMostLines = 8;
  Json list = Json::list({});
  for (const scene::Light& light : scene.lights) {
    const bool sun = light.kind == scene::LightKind::directional;
    list.push_back(
        {{"kind", kind_of(light)},
         {"position", sun ? Json(nullptr) : point_json(light.position_world)},
         {"direction",
          light.kind == scene::LightKind::point ? Json(nullptr) : point_json(light.direction_world)}});
  }
  summary.add("lights", list, std::to_string(scene.lights.size()));
  for (std::size_t i = 0; i < std::min(scene.lights.size(), kMostLines); ++i) {
    const scene::Light& light = scene.lights[i];
    summary.add_line("", kind_of(light) + (light.kind == scene::LightKind::directional
                                               ? " towards " + point_text(light.direction_world)
                                               : " at " + point_text(light.position_world)));
  }
  if (scene.lights.size() > kMostLines)
    summary.add_line("", std::to_string(scene.lights.size() - kMostLines) + " more");
}

/// Triangles by role, where any is no wall.
void add_roles(Summary& summary, const scene::Scene& scene) {
  std::array<std::uint64_t, kRoleNames.size()> counts{};
  for (const scene::Object& object : scene.objects)
    counts[static_cast<std::size_t>(object.role)] += scene.meshes[object.mesh].indices.size() / 3;
  Json roles = Json::object();
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    roles.set(kRoleNames[i], counts[i]);
    if (counts[i] > 0) text += (text.empty() ? "" : ", ") + std::to_string(counts[i]) + " " + kRoleNames[i];
  }
  const std::uint64_t others = counts[1] + counts[2] + counts[3];
  if (others > 0) summary.add("roles", roles, text + " triangles");
}

void add_counts(Summary& summary, const scene::Scene& scene, bool lists_objects) {
  std::uint64_t triangles = 0, solid = 0;
  for (const scene::Object& object : scene.objects) {
    const std::uint64_t count = scene.meshes[object.mesh].indices.size() / 3;
    triangles += count;
    if (stops_smoke(object.role)) solid += count;
  }
  summary.add("objects", scene.objects.size());
  std::vector<std::string> names;
  for (const scene::Object& object : scene.objects)
    if (!object.name.empty() && std::ranges::find(names, object.name) == names.end())
      names.push_back(object.name);
  summary.set("object_names", Json(names));
  for (std::size_t i = 0; i < (lists_objects ? names.size() : 0); ++i)
    summary.add_line("", printable(names[i]));
  summary.add("grenade", scene.grenade ? "from the file" : "built in");
  summary.add("meshes", scene.meshes.size());
  summary.add("materials", scene.materials.size());
  summary.add("images", scene.images.size());
  summary.add(
      "triangles", triangles,
      std::to_string(triangles) + ", " + std::to_string(solid) + " of them in objects that stop smoke");
  summary.add("solid_triangles", solid);
  add_roles(summary, scene);
}

/// Bounds in a file's units as the timeline places them [m].
Box<float> scaled(const Box<float>& bounds, const scene::Timeline& timeline) {
  if (bounds.empty()) return bounds;
  return {timeline.scale * (bounds.low - timeline.origin), timeline.scale * (bounds.high - timeline.origin)};
}

void add_bounds(Summary& summary, const Box<float>& bounds) {
  if (bounds.empty()) return;
  const glm::vec3 size = bounds.high - bounds.low;
  summary.add("bounds_min", point_json(bounds.low), point_text(bounds.low) + " m");
  summary.add("bounds_max", point_json(bounds.high), point_text(bounds.high) + " m");
  char text[96];
  std::snprintf(text, sizeof text, "%.4g m wide (x), %.4g m high (y), %.4g m deep (z)", double{size.x},
                double{size.y}, double{size.z});
  summary.add("size", point_json(size), text);
  summary.add("up", "y");
  summary.add("ground", bounds.low.y, "y = " + scene::shown(double{bounds.low.y}) + " m");
}

// A place where the smoke of `render` without a timeline fits.
void add_smoke(Summary& summary, const scene::Timeline& timeline, const voxel::BitGrid& grid) {
  if (timeline.smokes.empty()) return;
  const auto place =
      scenario::nearest_free_place(grid, timeline.smokes.front().at_world, timeline.smoke.voxels / 2);
  summary.add("smoke", place ? point_json(*place) : Json(nullptr),
              place ? "--smoke " + point_text(*place) : "none fits");
}

void add_events(Summary& summary, const scene::Timeline& timeline) {
  Json events = Json::object();
  std::string text;
  scene::for_each_event_list(timeline, [&](const char* type, const auto& list) {
    events.set(type, list.size());
    if (!list.empty()) text += (text.empty() ? "" : ", ") + std::to_string(list.size()) + " " + type;
  });
  summary.add("events", events, text.empty() ? "none" : text);

  std::vector<std::string> doors;
  for (const scene::DoorEvent& door : timeline.doors)
    if (std::ranges::find(doors, door.object) == doors.end()) doors.push_back(door.object);
  std::string names;
  for (const std::string& door : doors) names += (names.empty() ? "" : ", ") + door;
  if (!doors.empty()) summary.add("doors", Json(doors), names);
}

void add_smokes(Summary& summary, const scenario::Scenario& scenario) {
  const auto simulation = scenario::Simulation::create(scenario).value_or_throw();
  const auto reports = simulation->report_smokes(scenario);
  summary.add("smokes", report_timeline(scenario, reports), std::to_string(reports.size()));
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const scenario::SmokeReport& smoke = reports[i];
    char text[64];
    std::snprintf(text, sizeof text, "%zu: %.4g s, %u of %u voxels, at ", i + 1, smoke.time, smoke.voxels,
                  smoke.budget);
    summary.add_line("", text + point_text(smoke.at_world));
  }
}

}  // namespace

Summary scene_summary(const std::filesystem::path& path, bool lists_objects, Outputs& outputs) {
  scene::Scene scene = scene::load_scene(path).value_or_throw();
  outputs.reads(scene.files);
  Summary summary("scene");
  const bool own_camera = scene.camera.has_value();
  add_counts(summary, scene, lists_objects);
  const Box<float> bounds = scene::world_bounds(scene);
  add_lights(summary, scene);
  stop_if_interrupted();

  // As render shows it. A scale that it chooses is a warning.
  const scene::Timeline timeline = scenario::prepare_first_view(path, scene, {});
  if (timeline.scale != 1) summary.add("scale", timeline.scale);
  add_bounds(summary, scaled(bounds, timeline));
  add_camera(summary, scene::default_camera(scene), own_camera);
  const auto layout = scenario::grid_layout(timeline, scene).value_or_throw();
  add_layout(summary, layout);
  const auto grid = voxel::voxelize(scenario::world_triangles(scene), layout).value_or_throw();
  stop_if_interrupted();
  add_smoke(summary, timeline, grid);
  return summary;
}

Summary timeline_summary(const std::filesystem::path& path, bool check, Outputs& outputs) {
  scene::Timeline timeline = scene::load_timeline(path).value_or_throw();
  Summary summary("timeline");
  std::error_code ignored;
  const bool exists = std::filesystem::exists(timeline.scene, ignored);
  summary.add("scene", timeline.scene.string(), timeline.scene.string() + (exists ? "" : " (missing)"));
  summary.add("scene_exists", exists);
  summary.add("seconds", timeline.duration);
  summary.add("camera_keys", timeline.camera.size());
  add_events(summary, timeline);

  // All that rendering would load.
  const auto scenario = scenario::make_scenario(std::move(timeline), {});
  if (!scenario) {
    if (check) throw Error(scenario.failure());
    log_warning("cannot be rendered: " + scenario.failure().message);
    summary.add("problem", scenario.failure().message);
    return summary;
  }
  outputs.reads(scenario::files_of(*scenario));
  stop_if_interrupted();
  add_roles(summary, scenario->scene);
  add_layout(summary, scenario->voxels.grid.layout());
  add_smokes(summary, *scenario);
  return summary;
}

}  // namespace brume::cli
