#include "stage/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>

namespace brume::stage {
namespace {

std::uint32_t milliseconds(float seconds) {
  return static_cast<std::uint32_t>(std::lround(seconds * 1000));
}

std::uint32_t units(float metres) {
  return static_cast<std::uint32_t>(std::lround(metres * sim::kUnitsPerMetre));
}

static_assert(scene::kFarthestEvent * sim::kUnitsPerMetre == sim::kMaxCoordinate);

sim::Position position(glm::vec3 world) {
  return sim::position_from_metres(glm::dvec3(world));
}

sim::SmokeSettings smoke_settings(const scene::SmokeOptions& smoke, std::uint32_t ticks_per_second) {
  sim::SmokeSettings settings;
  settings.voxels = smoke.voxels;
  settings.bloom_ticks = std::max(1u, tick_at(double{smoke.bloom}, ticks_per_second));
  settings.hold_ticks = tick_at(double{smoke.hold}, ticks_per_second);
  settings.dissolve_ticks = std::max(1u, tick_at(double{smoke.dissolve}, ticks_per_second));
  return settings;
}

sim::HoleTiming timing_of(const scene::HoleTimes& times) {
  return {milliseconds(times.reach), milliseconds(times.expand), milliseconds(times.stay),
          milliseconds(times.fade)};
}

std::uint32_t turns(float radians) {
  const double share = double{radians} / (2 * std::numbers::pi);
  return static_cast<std::uint32_t>(std::lround((share - std::floor(share)) * sim::kFullTurn)) %
         sim::kFullTurn;
}

sim::Shot shot_of(const scene::ShotEvent& event, std::uint32_t tick, const ShotMasks& masks) {
  sim::Shot shot;
  shot.tick = tick;
  shot.origin = position(event.from_world);
  shot.toward = position(event.toward_world);
  shot.radius = units(event.radius);
  shot.timing = timing_of(event.times);
  shot.roll = turns(event.roll);
  switch (event.shape) {
    case scene::ShotShape::cylinder:
      break;
    case scene::ShotShape::box:
      shot.shape = sim::HoleShape::box;
      break;
    case scene::ShotShape::mask:
      shot.shape = sim::HoleShape::mask;
      shot.mask = masks.pictures.at(event.mask.string());
      break;
  }
  return shot;
}

/// One shot a letter: each the text's own, moved aside by whole units, so that all are parallel.
std::vector<sim::Shot> shots_of(const scene::TextEvent& event, std::uint32_t ticks_per_second,
                                const ShotMasks& masks) {
  sim::Shot middle;
  middle.origin = position(event.from_world);
  middle.toward = position(event.toward_world);
  middle.timing = timing_of(event.times);
  middle.shape = sim::HoleShape::mask;
  middle.roll = turns(event.roll);
  std::vector<sim::Shot> shots;
  if (middle.origin == middle.toward) {  // nearer than 1/1024 m: refused where events are checked
    shots.push_back(middle);
    return shots;
  }
  const sim::ShotAxes axes = sim::axes_of(middle);
  double time = event.time;
  for (const Letter& letter : masks.texts.at(ShotMasks::key(event))) {
    const glm::dvec3 aside =
        double{event.size} * (double{letter.right} * axes.right + double{letter.up} * axes.up);
    const sim::Position units_aside = sim::position_from_metres(aside);
    sim::Shot shot = middle;
    shot.tick = tick_at(time, ticks_per_second);
    shot.origin += units_aside;
    shot.toward += units_aside;
    shot.radius = std::max(1u, units(event.size * letter.half_side));
    shot.mask = letter.mask;
    shots.push_back(shot);
    time += double{event.interval};
  }
  return shots;
}

sim::Blast blast_of(const scene::BlastEvent& event, std::uint32_t tick) {
  sim::Blast blast;
  blast.tick = tick;
  blast.at = position(event.at_world);
  blast.radius = units(event.radius);
  blast.speed = units(event.speed);
  blast.left = static_cast<std::uint32_t>(std::lround(event.left * 255));
  blast.refill_rim_ms = milliseconds(event.refill_rim);
  blast.refill_middle_ms = milliseconds(event.refill_middle);
  return blast;
}

/// Collects events, checked one by one.
class EventList {
 public:
  explicit EventList(const voxel::GridFrame& frame) : frame_(frame) {}

  void add(sim::Event event, const std::string& place) {
    if (auto checked = sim::check_event(event, frame_); !checked && !failure_)
      failure_ =
          Failure{checked.failure().code, (place.empty() ? "" : place + ": ") + checked.failure().message};
    events_.push_back(std::move(event));
  }
  /// All of them by tick; those of one tick as they were added.
  Result<std::vector<sim::Event>> sorted() && {
    if (failure_) return *failure_;
    std::stable_sort(events_.begin(), events_.end(), [](const sim::Event& a, const sim::Event& b) {
      return sim::tick_of(a) < sim::tick_of(b);
    });
    return std::move(events_);
  }

 private:
  const voxel::GridFrame& frame_;
  std::vector<sim::Event> events_;
  std::optional<Failure> failure_;
};

Result<std::vector<sim::Event>> make_events(const Stage& stage, const std::vector<LevelEvent>& changes,
                                            std::uint32_t ticks_per_second) {
  const scene::Timeline& timeline = stage.timeline;
  const auto tick = [&](const auto& event) { return tick_at(event.time, ticks_per_second); };
  EventList events(stage.voxels.grid.frame());
  for (const LevelEvent& event : changes)
    if (!event.blocks.empty()) events.add(sim::LevelEdit{tick(event), event.blocks}, {});
  const sim::SmokeSettings smoke = smoke_settings(timeline.smoke, ticks_per_second);
  for (const scene::SmokeEvent& event : timeline.smokes)
    events.add(sim::ThrowSmoke{tick(event), position(event.from_world), position(event.at_world), smoke},
               event.place);
  for (const scene::ShotEvent& event : timeline.shots)
    events.add(shot_of(event, tick(event), stage.shot_masks), event.place);
  for (const scene::TextEvent& event : timeline.texts)
    for (const sim::Shot& shot : shots_of(event, ticks_per_second, stage.shot_masks))
      events.add(shot, event.place);
  for (const scene::BlastEvent& event : timeline.blasts)
    events.add(blast_of(event, tick(event)), event.place);
  std::vector<std::string> names;
  for (const scene::MoveEvent& event : timeline.moves) {
    const auto known = std::find(names.begin(), names.end(), event.body);
    const auto body = static_cast<std::uint32_t>(known - names.begin());
    if (known == names.end()) names.push_back(event.body);
    events.add(sim::MoveBody{tick(event), body, position(event.to_world)}, event.place);
  }
  return std::move(events).sorted();
}

}  // namespace

std::uint32_t tick_at(double seconds, std::uint32_t ticks_per_second) {
  // A time that was meant to be a tick may fall short of it by a rounding.
  return static_cast<std::uint32_t>(std::floor(std::max(0.0, seconds) * ticks_per_second + 1e-9));
}

Result<std::vector<sim::Event>> events_of(const Stage& stage, std::uint32_t ticks_per_second) {
  const auto changes = level_events(stage);
  if (!changes) return changes.failure();
  return make_events(stage, *changes, ticks_per_second);
}

Simulation::Simulation(const Stage& stage, std::vector<LevelEvent> level_events)
    : level_events_(std::move(level_events)),
      world_(stage.voxels.grid, {.masks = stage.masks.key()}),
      planes_(stage.voxels.planes),
      volume_(stage.voxels.grid, [this](glm::ivec3 cell) { return planes_.at(cell); }) {}

Result<std::unique_ptr<Simulation>> Simulation::create(const Stage& stage) {
  auto changes = level_events(stage);
  if (!changes) return changes.failure();
  auto events = make_events(stage, *changes, sim::WorldSettings{}.ticks_per_second);
  if (!events) return events.failure();
  std::unique_ptr<Simulation> simulation(new Simulation(stage, std::move(*changes)));
  if (auto done = simulation->world_.append(std::move(*events)); !done) return done.failure();
  simulation->advance_to(0);
  return simulation;
}

void Simulation::advance_to(double seconds) {
  world_.advance_to(tick_at(seconds, world_.settings().ticks_per_second));
  follow_level();
  volume_.update(world_);
}

void Simulation::follow_level() {
  const auto later = std::partition_point(level_events_.begin(), level_events_.end(), [&](const auto& event) {
    return tick_at(event.time, world_.settings().ticks_per_second) <= world_.tick();
  });
  const auto count = static_cast<std::size_t>(later - level_events_.begin());
  if (count == in_effect_) return;

  // Planes: on top of those that stay, or all anew when time ran backwards.
  for (std::size_t i = std::min(count, in_effect_); i < std::max(count, in_effect_); ++i) {
    const voxel::IntBox& cells = level_events_[i].planes->cells;
    if (!cells.empty()) volume_.planes_changed(cells.low, cells.high - 1);
  }
  if (count < in_effect_) planes_.clear();
  for (std::size_t i = count < in_effect_ ? 0 : in_effect_; i < count; ++i)
    planes_.add(level_events_[i].planes);
  in_effect_ = count;

  // The last word on each object.
  std::map<std::uint32_t, bool> hidden;
  for (std::size_t i = 0; i < count; ++i)
    for (const std::uint32_t object : level_events_[i].objects) hidden[object] = level_events_[i].hidden;
  hidden_objects_.clear();
  for (const auto& [object, is_hidden] : hidden)
    if (is_hidden) hidden_objects_.push_back(object);
}

}  // namespace brume::stage
