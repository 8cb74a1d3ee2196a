#include "scenario/editable_scenario.hpp"

#include <algorithm>
#include <utility>

#include "scene/files/timeline_check.hpp"
#include "scene/files/timeline_reader.hpp"

namespace brume::scenario {
namespace {

scene::GridOptions grid_of(const voxel::GridLayout& layout) {
  return {layout.voxel_size, layout.size, layout.origin_world};
}

/// Inserts each event after all events of its time or earlier.
template <typename Event>
void merge(std::vector<Event>& list, const std::vector<Event>& more) {
  for (const Event& event : more) {
    const auto place = std::upper_bound(list.begin(), list.end(), event.time,
                                        [](double time, const Event& other) { return time < other.time; });
    list.insert(place, event);
  }
}

void merge_events(scene::Timeline& timeline, const scene::Timeline& more) {
  scene::for_each_event_kind([&](const char*, auto list) { merge(timeline.*list, more.*list); });
}

bool changes_level(const scene::Timeline& timeline) {
  return !timeline.edits.empty() || !timeline.doors.empty();
}

/// Whether any event at or before a time satisfies the predicate.
template <typename Event, typename Predicate>
bool any_until(const std::vector<Event>& list, double time, Predicate predicate) {
  for (const Event& event : list) {
    if (event.time > time) return false;
    if (predicate(event)) return true;
  }
  return false;
}

bool same_decal(const scene::DecalOptions& a, const scene::DecalOptions& b) {
  return a.file == b.file && a.grid == b.grid;
}

bool same_carrier(const scene::Carrier& a, const scene::Carrier& b) {
  return a.name == b.name && a.object == b.object;
}

bool same_role(const scene::RoleOptions& a, const scene::RoleOptions& b) {
  return a.object == b.object && a.role == b.role;
}

/// Whether a scenario of one timeline has loaded what the other one refers to, besides its scene.
bool same_parts(const scene::Timeline& a, const scene::Timeline& b) {
  return std::ranges::equal(a.volumes, b.volumes, {}, &scene::VolumeOptions::file,
                            &scene::VolumeOptions::file) &&
         std::ranges::equal(a.decals, b.decals, same_decal) &&
         std::ranges::equal(a.tanks, b.tanks, {}, &scene::TankOptions::file, &scene::TankOptions::file) &&
         std::ranges::equal(a.carriers, b.carriers, same_carrier) &&
         std::ranges::equal(a.roles, b.roles, same_role);
}

bool same_life(const scene::SmokeOptions& a, const scene::SmokeOptions& b) {
  return a.voxels == b.voxels && a.bloom == b.bloom && a.hold == b.hold && a.dissolve == b.dissolve;
}

}  // namespace

Result<std::unique_ptr<EditableScenario>> EditableScenario::create(Scenario scenario) {
  std::unique_ptr<EditableScenario> live(new EditableScenario(std::move(scenario)));
  live->scenario_.timeline.grid = grid_of(live->scenario_.voxels.grid.layout());
  scene::sort_events(live->scenario_.timeline);
  auto simulation = Simulation::create(live->scenario_);
  if (!simulation) return simulation.failure();
  live->simulation_ = std::move(*simulation);
  live->bodies_ = number_bodies(live->scenario_.timeline);
  return live;
}

Result<void> EditableScenario::add(const scene::Timeline& actions) {
  if (auto checked = scene::check_events(actions); !checked) return checked;
  if (auto checked = scene::check_objects(actions, scenario_.scene); !checked) return checked;
  scene::Timeline sorted = actions;
  scene::sort_events(sorted);
  const bool masks = has_masks_of(sorted), level = changes_are_last(sorted);
  if (masks && level && moves_are_last(sorted)) return add_in_place(sorted);
  scene::Timeline timeline = scenario_.timeline;
  merge_events(timeline, sorted);
  return replay(std::move(timeline), {masks, !changes_level(sorted)});
}

/// Whether a shot or text no later already uses each mask: then all masks keep their numbers.
bool EditableScenario::has_masks_of(const scene::Timeline& actions) const {
  const scene::Timeline& timeline = scenario_.timeline;
  const auto known_shot = [&](const scene::ShotEvent& shot) {
    const auto is_same = [&](const scene::ShotEvent& other) {
      return other.shape == scene::ShotShape::mask && other.mask == shot.mask;
    };
    return shot.shape != scene::ShotShape::mask || any_until(timeline.shots, shot.time, is_same);
  };
  const auto known_text = [&](const scene::TextEvent& text) {
    const auto is_same = [&](const scene::TextEvent& other) {
      return ShotMasks::key(other) == ShotMasks::key(text);
    };
    return any_until(timeline.texts, text.time, is_same);
  };
  return std::all_of(actions.shots.begin(), actions.shots.end(), known_shot) &&
         std::all_of(actions.texts.begin(), actions.texts.end(), known_text);
}

/// Whether no new move precedes an existing one: then all bodies keep their numbers.
bool EditableScenario::moves_are_last(const scene::Timeline& actions) const {
  const auto& moves = scenario_.timeline.moves;
  return actions.moves.empty() || moves.empty() || actions.moves.front().time >= moves.back().time;
}

/// Whether no new edit or door precedes an existing one.
bool EditableScenario::changes_are_last(const scene::Timeline& actions) const {
  const auto& edits = scenario_.timeline.edits;
  const auto& doors = scenario_.timeline.doors;
  const double last_edit = edits.empty() ? -1 : edits.back().time;
  const double last_door = doors.empty() ? -1 : doors.back().time;
  // Edits precede doors of the same time.
  const bool edits_are_last = actions.edits.empty() || (actions.edits.front().time >= last_edit &&
                                                        actions.edits.front().time > last_door);
  return edits_are_last &&
         (actions.doors.empty() || actions.doors.front().time >= std::max(last_edit, last_door));
}

Result<void> EditableScenario::add_in_place(const scene::Timeline& actions) {
  // Check the events first, because applying level changes is expensive to undo.
  const EventSettings settings{scenario_.voxels.grid.layout(), scenario_.timeline.smoke, scenario_.shot_masks,
                               scenario_};
  BodyNumbers bodies = bodies_;
  auto events = ordered_events(actions, {}, bodies, settings);
  if (!events) return events.failure();
  std::vector<LevelEvent> changes;
  if (changes_level(actions)) {
    changes = apply_level_events(actions, scenario_.scene, last_level());
    events = ordered_events(actions, changes, bodies, settings);
    if (!events) last_level_.reset();
    if (!events) return events.failure();
  }

  // Commit.
  if (auto added = simulation_->add(std::move(*events), std::move(changes)); !added) {
    last_level_.reset();
    return added;
  }
  bodies_ = std::move(bodies);
  merge_events(scenario_.timeline, actions);
  return {};
}

Result<void> EditableScenario::replay(scene::Timeline timeline, const Unchanged& unchanged) {
  // Masks.
  std::optional<LoadedMasks> masks;
  if (!unchanged.masks) {
    auto loaded = load_masks(timeline);
    if (!loaded) return loaded.failure();
    masks = std::move(*loaded);
  }
  const ShotMasks& shot_masks = masks ? masks->of_shots : scenario_.shot_masks;
  const sim::MaskKey key = masks ? masks->atlas.key() : scenario_.masks.key();

  // Level changes.
  std::vector<LevelEvent> changes;
  std::optional<ObjectLevel> level;
  if (unchanged.level) {
    changes = simulation_->level_events();
  } else if (changes_level(timeline)) {
    level = make_level(scenario_);
    changes = apply_level_events(timeline, scenario_.scene, *level);
  }

  // Events.
  BodyNumbers bodies;
  auto events = ordered_events(timeline, changes, bodies,
                               {scenario_.voxels.grid.layout(), timeline.smoke, shot_masks, scenario_});
  if (!events) return events.failure();
  if (auto done = simulation_->replace(std::move(*events), std::move(changes), key); !done) return done;

  // Commit.
  if (!unchanged.level) last_level_ = std::move(level);
  if (masks) {
    scenario_.masks = std::move(masks->atlas);
    scenario_.shot_masks = std::move(masks->of_shots);
  }
  bodies_ = std::move(bodies);
  scenario_.timeline = std::move(timeline);
  return {};
}

ObjectLevel& EditableScenario::last_level() {
  if (!last_level_) {
    last_level_ = make_level(scenario_);
    apply_level_events(scenario_.timeline, scenario_.scene, *last_level_);
  }
  return *last_level_;
}

/// Fails unless the scenario has loaded what a timeline refers to.
Result<void> EditableScenario::expect_same_parts(const scene::Timeline& timeline) const {
  const scene::GridOptions grid = grid_of(scenario_.voxels.grid.layout());
  std::error_code error;
  if (timeline.scene != scenario_.timeline.scene &&
      !std::filesystem::equivalent(timeline.scene, scenario_.timeline.scene, error))
    return Failure{ErrorCode::bad_input, timeline.scene.string() + ": expected the scenario's own scene, " +
                                             scenario_.timeline.scene.string()};
  if (timeline.grid.voxel != grid.voxel || timeline.grid.size.value_or(*grid.size) != *grid.size ||
      timeline.grid.origin_world.value_or(*grid.origin_world) != *grid.origin_world)
    return Failure{ErrorCode::bad_input,
                   "the timeline has another grid than the scenario; load it as a new scenario"};
  if (!same_parts(timeline, scenario_.timeline))
    return Failure{
        ErrorCode::bad_input,
        "the timeline has other volumes, decals, tanks, carriers or roles than the scenario; load it as a "
        "new scenario"};
  return {};
}

/// All or none.
Result<void> EditableScenario::choose_grids(const std::vector<scene::VolumeOptions>& volumes) {
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    auto done = scenario_.volumes->choose_grids(i, volumes[i]);
    if (done) continue;
    // Volumes::at warns where those before cannot be read again.
    for (std::size_t k = 0; k < i; ++k)
      static_cast<void>(scenario_.volumes->choose_grids(k, scenario_.timeline.volumes[k]));
    return done;
  }
  return {};
}

Result<void> EditableScenario::set_settings(scene::Timeline settings) {
  const scene::Timeline& present = scenario_.timeline;
  if (auto done = expect_same_parts(settings); !done) return done;
  settings.grid = grid_of(scenario_.voxels.grid.layout());
  scene::for_each_event_kind([&](const char*, auto list) { settings.*list = present.*list; });
  // Volumes that stay may be anywhere: a file of grids alone decides where its volume is.
  scene::Timeline checked = settings;
  if (settings.volumes == present.volumes) checked.volumes.clear();
  if (auto done = scene::check_settings(checked); !done) return done;
  if (auto done = load_lens_openings(settings, scenario_.lens_openings); !done) return done;
  if (auto done = choose_grids(settings.volumes); !done) return done;
  if (same_life(settings.smoke, present.smoke)) {
    scenario_.timeline = std::move(settings);
    return {};
  }
  auto done = replay(std::move(settings), {true, true});
  if (!done) static_cast<void>(choose_grids(present.volumes));
  return done;
}

Result<void> EditableScenario::reset(scene::Timeline timeline) {
  if (auto done = expect_same_parts(timeline); !done) return done;
  timeline.grid = grid_of(scenario_.voxels.grid.layout());
  if (auto checked = scene::check_settings(timeline); !checked) return checked;
  if (auto checked = scene::check_events(timeline); !checked) return checked;
  if (auto checked = scene::check_objects(timeline, scenario_.scene); !checked) return checked;
  if (auto loaded = load_lens_openings(timeline, scenario_.lens_openings); !loaded) return loaded;
  scene::sort_events(timeline);
  return replay(std::move(timeline), {});
}

}  // namespace brume::scenario
