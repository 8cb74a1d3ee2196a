#include "scenario/events.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "scenario/smoke_start.hpp"
#include "smoke/holes.hpp"

namespace brume::scenario {
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

sim::HoleTimingMs timing_of(const scene::HoleTimes& times) {
  return {milliseconds(times.reach), milliseconds(times.expand), milliseconds(times.stay),
          milliseconds(times.fade)};
}

/// An angle in 1/65536 turn, [0, 65535].
std::uint32_t turn_of(float radians) {
  const double turns = double{radians} / (2 * std::numbers::pi);
  return static_cast<std::uint32_t>(std::lround((turns - std::floor(turns)) * sim::kFullTurn)) %
         sim::kFullTurn;
}

sim::Shot shot_of(const scene::ShotEvent& event, std::uint32_t tick, const ShotMasks& masks) {
  sim::Shot shot;
  shot.tick = tick;
  shot.origin = position(event.from_world);
  shot.toward = position(event.toward_world);
  shot.radius = units(event.radius);
  shot.timing = timing_of(event.times);
  shot.roll = turn_of(event.roll);
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

/// One shot per letter, offset sideways by whole units so that all are parallel.
std::vector<sim::Shot> shots_of(const scene::TextEvent& event, std::uint32_t ticks_per_second,
                                const ShotMasks& masks) {
  // The shot through the middle of the text.
  sim::Shot middle;
  middle.origin = position(event.from_world);
  middle.toward = position(event.toward_world);
  middle.timing = timing_of(event.times);
  middle.shape = sim::HoleShape::mask;
  middle.roll = turn_of(event.roll);
  std::vector<sim::Shot> shots;
  if (middle.origin == middle.toward) {  // closer than 1/1024 m: check_event rejects it
    shots.push_back(middle);
    return shots;
  }

  // Its copies, one for each letter.
  const smoke::ShotAxes axes = smoke::axes_of(middle);
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
  blast.remaining = static_cast<std::uint32_t>(std::lround(event.remaining * 255));
  blast.refill_rim_ms = milliseconds(event.refill_rim);
  blast.refill_middle_ms = milliseconds(event.refill_middle);
  return blast;
}

/// Collects events, checked one by one.
class EventList {
 public:
  explicit EventList(const voxel::GridLayout& layout) : layout_(layout) {}

  void add(EventKind kind, double time, sim::Event event, const std::string& place) {
    if (auto checked = sim::check_event(event, layout_); !checked && !failure_)
      failure_ =
          Failure{checked.failure().code, (place.empty() ? "" : place + ": ") + checked.failure().message};
    events_.push_back({{sim::tick_of(event), kind, time}, std::move(event)});
  }
  Result<std::vector<OrderedEvent>> sorted() && {
    if (failure_) return *failure_;
    std::stable_sort(events_.begin(), events_.end(),
                     [](const OrderedEvent& a, const OrderedEvent& b) { return a.order < b.order; });
    return std::move(events_);
  }

 private:
  const voxel::GridLayout& layout_;
  std::vector<OrderedEvent> events_;
  std::optional<Failure> failure_;
};

}  // namespace

std::uint32_t tick_at(double seconds, std::uint32_t ticks_per_second) {
  // A time meant as an exact tick may lie below it by a rounding error.
  return static_cast<std::uint32_t>(std::floor(std::max(0.0, seconds) * ticks_per_second + 1e-9));
}

BodyNumbers number_bodies(const scene::Timeline& timeline) {
  BodyNumbers bodies;
  for (const scene::MoveEvent& event : timeline.moves) bodies[event.body];
  return bodies;
}

Result<std::vector<OrderedEvent>> ordered_events(const scene::Timeline& timeline,
                                                 const std::vector<LevelEvent>& changes, BodyNumbers& bodies,
                                                 const EventSettings& settings) {
  const std::uint32_t rate = settings.ticks_per_second;
  const auto tick = [&](const auto& event) { return tick_at(event.time, rate); };
  EventList events(settings.layout);

  // Level changes.
  for (const LevelEvent& event : changes)
    if (!event.blocks.empty())
      events.add(EventKind::level, event.time, sim::LevelEdit{tick(event), event.blocks}, {});

  // Smokes, shots and texts.
  const sim::SmokeSettings smoke = smoke_settings(settings.smoke, rate);
  for (const scene::SmokeEvent& event : timeline.smokes) {
    const bool is_placed = event.from_world == event.at_world;
    const glm::vec3 at = is_placed ? smoke_start(settings.level, event.at_world) : event.at_world;
    const glm::vec3 from = is_placed ? at : event.from_world;
    events.add(EventKind::smoke, event.time,
               sim::ThrowSmoke{tick(event), position(from), position(at), smoke}, event.place);
  }
  for (const scene::ShotEvent& event : timeline.shots)
    events.add(EventKind::shot, event.time, shot_of(event, tick(event), settings.masks), event.place);
  for (const scene::TextEvent& event : timeline.texts)
    for (const sim::Shot& shot : shots_of(event, rate, settings.masks))
      events.add(EventKind::letter, event.time, shot, event.place);

  // Blasts and moves.
  for (const scene::BlastEvent& event : timeline.blasts)
    events.add(EventKind::blast, event.time, blast_of(event, tick(event)), event.place);
  for (const scene::MoveEvent& event : timeline.moves)
    events.add(EventKind::move, event.time,
               sim::MoveBody{tick(event), bodies[event.body], position(event.to_world)}, event.place);
  return std::move(events).sorted();
}

Result<std::vector<sim::Event>> events_of(const Scenario& scenario, std::uint32_t ticks_per_second) {
  const auto changes = level_events(scenario);
  if (!changes) return changes.failure();
  BodyNumbers bodies;
  auto events = ordered_events(scenario.timeline, *changes, bodies,
                               {scenario.voxels.grid.layout(), scenario.timeline.smoke, scenario.shot_masks,
                                scenario, ticks_per_second});
  if (!events) return events.failure();
  return without_order(std::move(*events));
}

std::vector<sim::Event> without_order(std::vector<OrderedEvent> events) {
  std::vector<sim::Event> result;
  result.reserve(events.size());
  for (OrderedEvent& event : events) result.push_back(std::move(event.event));
  return result;
}

}  // namespace brume::scenario
