#include <bit>

#include "bench/bench.hpp"
#include "scenario/level_events.hpp"
#include "scene/files/load.hpp"

namespace brume::bench {
namespace {

/// Opens or closes a door at each call: updates voxels and planes, and builds the edit for the event log.
Result<Measurement> swing_door(const Bench& bench, const std::string& name, const std::filesystem::path& path,
                               const voxel::GridLayout& frame, const std::string& door) {
  auto scene = scene::load_scene(path);
  if (!scene) return scene.failure();
  auto voxels = scenario::load_or_voxelize(*scene, frame, {});
  if (!voxels) return voxels.failure();
  const scenario::Scenario scenario{{}, std::move(*scene), {}, std::move(*voxels)};
  scenario::ObjectLevel objects = scenario::make_level(scenario);
  std::vector<std::uint32_t> parts;
  for (std::size_t i = 0; i < scenario.scene.objects.size(); ++i)
    if (scenario.scene.objects[i].name == door) parts.push_back(objects.part_of[i]);
  if (parts.empty()) return Failure{ErrorCode::bad_input, path.string() + ": no object \"" + door + "\""};

  bool shut = true;
  std::size_t changed = 0, planes = 0;
  auto m = bench.time_calls(name, 400, [&] {
    shut = !shut;
    const voxel::LevelChange change = objects.level.show(parts, shut);
    changed = 0;
    for (const sim::EditBlock& block : scenario::make_edit(change, objects.level.solids()))
      changed += static_cast<std::size_t>(std::popcount(block.make_solid | block.make_free));
    planes = change.planes.plane_count();
  });
  m.details = {{"triangles", static_cast<double>(scenario.voxels.triangles)},
               {"changed_voxels", static_cast<double>(changed)},
               {"planes", static_cast<double>(planes)}};
  return m;
}

Result<std::vector<Measurement>> doors(Bench& bench) {
  std::vector<Measurement> all;
  const voxel::GridLayout demo{{114, 38, 114}, 0.25f, {-14.1f, -0.35f, -12.1f}};
  const auto in_demo = swing_door(bench, "edit/door/demo", scene_file("demo.glb"), demo, "door_leaf");
  if (!in_demo) return in_demo.failure();
  all.push_back(*in_demo);
  const auto motel = motel_scene();
  if (!motel) return all;
  const std::pair<const char*, voxel::GridLayout> frames[] = {
      {"edit/door/motel", {{120, 20, 120}, 0.5f, {-30, 0, -30}}},
      {"edit/door/motel@0.25", {{240, 40, 240}, 0.25f, {-30, 0, -30}}}};
  for (const auto& [name, frame] : frames) {
    const auto measured = swing_door(bench, name, *motel, frame, "DoorRoom_E");
    if (!measured) return measured.failure();
    all.push_back(*measured);
  }
  return all;
}

}  // namespace

std::vector<Case> edit_cases() {
  return {{"edit/door", "a door opens or closes: voxels, planes and edit, one thread", doors}};
}

}  // namespace brume::bench
