#include "stage/live_stage.hpp"

#include <algorithm>
#include <utility>

#include "scene/timeline_check.hpp"

namespace brume::stage {
namespace {

scene::GridOptions grid_of(const voxel::GridFrame& frame) {
  return {frame.voxel_size, frame.size, frame.origin_world};
}

/// Each event behind those that are at its time or before.
template <typename Event>
void merge(std::vector<Event>& list, const std::vector<Event>& more) {
  for (const Event& event : more) {
    const auto place = std::upper_bound(list.begin(), list.end(), event.time,
                                        [](double time, const Event& other) { return time < other.time; });
    list.insert(place, event);
  }
}

void merge_events(scene::Timeline& timeline, const scene::Timeline& more) {
  merge(timeline.smokes, more.smokes);
  merge(timeline.shots, more.shots);
  merge(timeline.texts, more.texts);
  merge(timeline.blasts, more.blasts);
  merge(timeline.moves, more.moves);
  merge(timeline.edits, more.edits);
  merge(timeline.doors, more.doors);
}

bool changes_level(const scene::Timeline& timeline) {
  return !timeline.edits.empty() || !timeline.doors.empty();
}

/// Whether some event of a list, of a time or before, is such.
template <typename Event, typename Is>
bool is_there_by(const std::vector<Event>& list, double time, Is is) {
  for (const Event& event : list) {
    if (event.time > time) return false;
    if (is(event)) return true;
  }
  return false;
}

bool same_life(const scene::SmokeOptions& a, const scene::SmokeOptions& b) {
  return a.voxels == b.voxels && a.bloom == b.bloom && a.hold == b.hold && a.dissolve == b.dissolve;
}

}  // namespace

Result<std::unique_ptr<LiveStage>> LiveStage::create(Stage stage) {
  std::unique_ptr<LiveStage> live(new LiveStage(std::move(stage)));
  live->stage_.timeline.grid = grid_of(live->stage_.voxels.grid.frame());
  scene::sort_events(live->stage_.timeline);
  auto simulation = Simulation::create(live->stage_);
  if (!simulation) return simulation.failure();
  live->simulation_ = std::move(*simulation);
  live->bodies_ = number_bodies(live->stage_.timeline);
  return live;
}

Result<void> LiveStage::add(const scene::Timeline& deeds) {
  if (auto checked = scene::check_events(deeds); !checked) return checked;
  if (auto checked = scene::check_doors(deeds, stage_.scene); !checked) return checked;
  scene::Timeline sorted = deeds;
  scene::sort_events(sorted);
  const bool masks = knows_masks_of(sorted), level = changes_are_last(sorted);
  if (masks && level && moves_are_last(sorted)) return add_in_place(sorted);
  scene::Timeline timeline = stage_.timeline;
  merge_events(timeline, sorted);
  return play_anew(std::move(timeline), {masks, !changes_level(sorted)});
}

/// Whether each mask is known, and from a shot or text that is no later: then all keep their numbers.
bool LiveStage::knows_masks_of(const scene::Timeline& deeds) const {
  const scene::Timeline& timeline = stage_.timeline;
  const auto known_shot = [&](const scene::ShotEvent& shot) {
    const auto is_same = [&](const scene::ShotEvent& other) {
      return other.shape == scene::ShotShape::mask && other.mask == shot.mask;
    };
    return shot.shape != scene::ShotShape::mask || is_there_by(timeline.shots, shot.time, is_same);
  };
  const auto known_text = [&](const scene::TextEvent& text) {
    const auto is_same = [&](const scene::TextEvent& other) {
      return ShotMasks::key(other) == ShotMasks::key(text);
    };
    return is_there_by(timeline.texts, text.time, is_same);
  };
  return std::all_of(deeds.shots.begin(), deeds.shots.end(), known_shot) &&
         std::all_of(deeds.texts.begin(), deeds.texts.end(), known_text);
}

/// Whether no move is before one that is there: then all bodies keep their numbers.
bool LiveStage::moves_are_last(const scene::Timeline& deeds) const {
  const auto& moves = stage_.timeline.moves;
  return deeds.moves.empty() || moves.empty() || deeds.moves.front().time >= moves.back().time;
}

/// Whether no edit or door comes before one that is there.
bool LiveStage::changes_are_last(const scene::Timeline& deeds) const {
  const auto& edits = stage_.timeline.edits;
  const auto& doors = stage_.timeline.doors;
  const double last_edit = edits.empty() ? -1 : edits.back().time;
  const double last_door = doors.empty() ? -1 : doors.back().time;
  // Of the same time edits come before doors.
  const bool edits_are_last =
      deeds.edits.empty() || (deeds.edits.front().time >= last_edit && deeds.edits.front().time > last_door);
  return edits_are_last &&
         (deeds.doors.empty() || deeds.doors.front().time >= std::max(last_edit, last_door));
}

Result<void> LiveStage::add_in_place(const scene::Timeline& deeds) {
  const EventSettings settings{stage_.voxels.grid.frame(), stage_.timeline.smoke, stage_.shot_masks};
  BodyNumbers bodies = bodies_;
  auto events = ordered_events(deeds, {}, bodies, settings);
  if (!events) return events.failure();
  std::vector<LevelEvent> changes;
  if (changes_level(deeds)) {
    changes = apply_level_events(deeds, stage_.scene, last_level());
    events = ordered_events(deeds, changes, bodies, settings);
    if (!events) last_level_.reset();
    if (!events) return events.failure();
  }
  if (auto added = simulation_->add(std::move(*events), std::move(changes)); !added) {
    last_level_.reset();
    return added;
  }
  bodies_ = std::move(bodies);
  merge_events(stage_.timeline, deeds);
  return {};
}

Result<void> LiveStage::play_anew(scene::Timeline timeline, const Staying& staying) {
  std::optional<LoadedMasks> masks;
  if (!staying.masks) {
    auto loaded = load_masks(timeline);
    if (!loaded) return loaded.failure();
    masks = std::move(*loaded);
  }
  const ShotMasks& shot_masks = masks ? masks->of_shots : stage_.shot_masks;
  const sim::MaskKey key = masks ? masks->atlas.key() : stage_.masks.key();

  std::vector<LevelEvent> changes;
  std::optional<ObjectLevel> level;
  if (staying.level) {
    changes = simulation_->level_events();
  } else if (changes_level(timeline)) {
    level = make_level(stage_);
    changes = apply_level_events(timeline, stage_.scene, *level);
  }
  BodyNumbers bodies;
  auto events =
      ordered_events(timeline, changes, bodies, {stage_.voxels.grid.frame(), timeline.smoke, shot_masks});
  if (!events) return events.failure();
  if (auto done = simulation_->replace(std::move(*events), std::move(changes), key); !done) return done;

  if (!staying.level) last_level_ = std::move(level);
  if (masks) {
    stage_.masks = std::move(masks->atlas);
    stage_.shot_masks = std::move(masks->of_shots);
  }
  bodies_ = std::move(bodies);
  stage_.timeline = std::move(timeline);
  return {};
}

ObjectLevel& LiveStage::last_level() {
  if (!last_level_) {
    last_level_ = make_level(stage_);
    apply_level_events(stage_.timeline, stage_.scene, *last_level_);
  }
  return *last_level_;
}

Result<void> LiveStage::set_smoke(const scene::SmokeOptions& smoke) {
  scene::Timeline chosen;
  chosen.smoke = smoke;
  if (auto checked = scene::check_settings(chosen); !checked) return checked;
  if (same_life(smoke, stage_.timeline.smoke)) {
    stage_.timeline.smoke = smoke;
    return {};
  }
  chosen = stage_.timeline;
  chosen.smoke = smoke;
  return play_anew(std::move(chosen), {true, true});
}

Result<void> LiveStage::set_sky(const scene::SkyOptions& sky) {
  scene::Timeline chosen;
  chosen.sky = sky;
  if (auto checked = scene::check_settings(chosen); !checked) return checked;
  stage_.timeline.sky = sky;
  return {};
}

Result<void> LiveStage::set_exposure(float exposure) {
  scene::Timeline chosen;
  chosen.exposure = exposure;
  if (auto checked = scene::check_settings(chosen); !checked) return checked;
  stage_.timeline.exposure = exposure;
  return {};
}

Result<void> LiveStage::set_duration(float duration) {
  scene::Timeline chosen;
  chosen.duration = duration;
  if (auto checked = scene::check_settings(chosen); !checked) return checked;
  stage_.timeline.duration = duration;
  return {};
}

Result<void> LiveStage::set_camera(std::vector<scene::CameraKey> keys) {
  scene::Timeline chosen;
  chosen.camera = std::move(keys);
  if (auto checked = scene::check_settings(chosen); !checked) return checked;
  stage_.timeline.camera = std::move(chosen.camera);
  return {};
}

Result<void> LiveStage::reset(scene::Timeline timeline) {
  const scene::GridOptions grid = grid_of(stage_.voxels.grid.frame());
  std::error_code error;
  if (timeline.scene != stage_.timeline.scene &&
      !std::filesystem::equivalent(timeline.scene, stage_.timeline.scene, error))
    return Failure{ErrorCode::bad_input, timeline.scene.string() + ": expected the scene that is on stage, " +
                                             stage_.timeline.scene.string()};
  if (timeline.grid.voxel != grid.voxel || timeline.grid.size.value_or(*grid.size) != *grid.size ||
      timeline.grid.origin_world.value_or(*grid.origin_world) != *grid.origin_world)
    return Failure{ErrorCode::bad_input, "the timeline has another grid than the stage; load it anew"};
  timeline.grid = grid;
  if (auto checked = scene::check_settings(timeline); !checked) return checked;
  if (auto checked = scene::check_events(timeline); !checked) return checked;
  if (auto checked = scene::check_doors(timeline, stage_.scene); !checked) return checked;
  scene::sort_events(timeline);
  return play_anew(std::move(timeline), {});
}

}  // namespace brume::stage
