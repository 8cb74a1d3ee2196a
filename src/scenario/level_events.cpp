#include "scenario/level_events.hpp"

#include <algorithm>
#include <cmath>

#include "scenario/ticks.hpp"
#include "scenario/world_triangles.hpp"
#include "scene/files/timeline_reader.hpp"

namespace brume::scenario {
namespace {

LevelEvent event_of(double time, const voxel::LevelChange& change, const voxel::Solids& now) {
  LevelEvent event;
  event.time = time;
  event.blocks = make_edit(change, now);
  event.planes = std::make_shared<const voxel::PlanePatch>(voxel::PlanePatch{change.cells, change.planes});
  return event;
}

LevelEvent apply(const scene::EditEvent& edit, voxel::Level& level) {
  const Box<int> box = voxels_in(level.grid().layout(), edit.low_world, edit.high_world);
  return event_of(edit.time, level.set_box(box, edit.solid), level.solids());
}

LevelEvent apply(const scene::DoorEvent& door, const scene::Scene& scene, ObjectLevel& objects) {
  std::vector<std::uint32_t> named, parts;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].name != door.object) continue;
    named.push_back(i);
    if (objects.part_of[i] != scene::kNone) parts.push_back(objects.part_of[i]);
  }
  const voxel::LevelChange change = objects.level.show(parts, !door.open);
  LevelEvent event = event_of(door.time, change, objects.level.solids());
  event.objects = std::move(named);
  event.hidden = door.open;
  return event;
}

}  // namespace

ObjectLevel make_level(const Scenario& scenario) {
  const auto& objects = scenario.scene.objects;
  std::vector<std::uint32_t> part_of(objects.size(), scene::kNone);
  std::vector<voxel::LevelPart> parts;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].role == Role::ghost) continue;
    part_of[i] = static_cast<std::uint32_t>(parts.size());
    parts.push_back({object_triangles(scenario.scene, objects[i]), objects[i].role});
  }
  return {voxel::Level(scenario.voxels.grid, scenario.voxels.roles, std::move(parts)), std::move(part_of)};
}

sim::EditBlocks make_edit(const voxel::LevelChange& change, const voxel::Solids& now) {
  return sim::difference({change.before, change.roles_before}, now, change.voxels.low, change.voxels.high);
}

Box<int> voxels_in(const voxel::GridLayout& layout, glm::vec3 low_world, glm::vec3 high_world) {
  const auto first_centre_from = [&](glm::vec3 world) {
    const glm::dvec3 at =
        (glm::dvec3(world) - glm::dvec3(layout.origin_world)) / double{layout.voxel_size} - 0.5;
    return glm::ivec3(glm::clamp(glm::ceil(at), glm::dvec3(-1), glm::dvec3(layout.size) + 1.0));
  };
  return {first_centre_from(low_world), first_centre_from(high_world)};
}

std::vector<LevelEvent> apply_level_events(const scene::Timeline& timeline, const scene::Scene& scene,
                                           ObjectLevel& objects) {
  std::vector<LevelEvent> events;
  auto door = timeline.doors.begin();
  const auto doors_before = [&](double time) {
    for (; door != timeline.doors.end() && door->time < time; ++door)
      events.push_back(apply(*door, scene, objects));
  };
  for (const scene::EditEvent& edit : timeline.edits) {
    doors_before(edit.time);
    events.push_back(apply(edit, objects.level));
  }
  doors_before(INFINITY);
  return events;
}

std::size_t count_in_effect(std::span<const LevelEvent> events, const sim::World& world) {
  const auto later = std::ranges::partition_point(events, [&](const LevelEvent& event) {
    return tick_at(event.time, world.settings().ticks_per_second) <= world.tick();
  });
  return static_cast<std::size_t>(later - events.begin());
}

std::vector<std::shared_ptr<const voxel::PlanePatch>> patches_of(std::span<const LevelEvent> events) {
  std::vector<std::shared_ptr<const voxel::PlanePatch>> patches;
  patches.reserve(events.size());
  for (const LevelEvent& event : events) patches.push_back(event.planes);
  return patches;
}

Result<std::vector<LevelEvent>> level_events(const Scenario& scenario) {
  const scene::Timeline& timeline = scenario.timeline;
  if (auto checked = scene::check_objects(timeline, scenario.scene); !checked) return checked.failure();
  if (timeline.edits.empty() && timeline.doors.empty()) return std::vector<LevelEvent>();
  ObjectLevel objects = make_level(scenario);
  return apply_level_events(timeline, scenario.scene, objects);
}

}  // namespace brume::scenario
