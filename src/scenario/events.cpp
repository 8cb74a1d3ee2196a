#include "scenario/events.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <string_view>
#include <variant>

#include "scenario/smoke_start.hpp"
#include "scene/event_fields.hpp"
#include "sim/event_fields.hpp"
#include "smoke/holes.hpp"

namespace brume::scenario {
namespace {

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

/// An angle in 1/65536 turn, [0, 65535].
std::uint32_t turn_of(float radians) {
  const double turns = double{radians} / (2 * std::numbers::pi);
  return static_cast<std::uint32_t>(std::lround((turns - std::floor(turns)) * sim::kFullTurn)) %
         sim::kFullTurn;
}

/// Metres, seconds, a fraction or radians in steps of a unit.
std::uint32_t steps(sim::FieldUnit unit, float value) {
  if (unit == sim::FieldUnit::turn_65536) return turn_of(value);
  return static_cast<std::uint32_t>(std::lround(value * static_cast<float>(sim::steps_of(unit))));
}

/// Finds a field of a timeline's event by its key: a visitor of scene/event_fields.hpp.
struct FieldFinder {
  std::string_view key;
  std::optional<float> number = {};
  std::optional<glm::vec3> point = {};

  void operator()(const scene::OptionInfo& info, float member) {
    if (info.key == key) number = member;
  }
  void operator()(const scene::PointField& field, const glm::vec3& member) {
    if (field.key == key) point = member;
  }
  void operator()(const auto&, const auto&...) {}
};

/// Sets the fields of an event of the simulation that a timeline's event has, too: its visitor.
template <typename Event>
struct Converter {
  const Event& event;

  void operator()(const sim::PositionField& field, sim::Position& member) const {
    if (const auto point = found(field.key).point) member = position(*point);
  }
  void operator()(const sim::NumberField& field, std::uint32_t& member) const {
    if (const auto number = found(field.key).number) member = steps(field.unit, *number);
  }
  void operator()(const sim::ChoiceField&, const auto&) const {}

 private:
  FieldFinder found(const char* key) const {
    FieldFinder finder{key};
    scene::visit_event(event, finder);
    return finder;
  }
};

template <typename SimEvent, typename Event>
SimEvent convert(const Event& event, std::uint32_t tick) {
  SimEvent made;
  made.tick = tick;
  sim::visit_fields(made, Converter<Event>{event});
  return made;
}

sim::Shot shot_of(const scene::ShotEvent& event, std::uint32_t tick, const ShotMasks& masks) {
  auto shot = convert<sim::Shot>(event, tick);
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
  auto middle = convert<sim::Shot>(event, 0);
  middle.shape = sim::HoleShape::mask;
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
    shot.radius = std::max(1u, steps(sim::FieldUnit::metre_1024, event.size * letter.half_side));
    shot.mask = letter.mask;
    shots.push_back(shot);
    time += double{event.interval};
  }
  return shots;
}

// The events of the simulation that an event of a timeline becomes, where it is more than same_kind makes.
std::vector<sim::Event> make_events(const scene::SmokeEvent& event, const EventSettings& settings,
                                    BodyNumbers&) {
  const std::uint32_t rate = settings.ticks_per_second;
  auto thrown = convert<sim::ThrowSmoke>(event, tick_at(event.time, rate));
  if (event.from_world == event.at_world)
    thrown.from = thrown.at = position(smoke_start(settings.level, event.at_world));
  thrown.smoke = smoke_settings(settings.smoke, rate);
  return {thrown};
}

std::vector<sim::Event> make_events(const scene::ShotEvent& event, const EventSettings& settings,
                                    BodyNumbers&) {
  return {shot_of(event, tick_at(event.time, settings.ticks_per_second), settings.masks)};
}

std::vector<sim::Event> make_events(const scene::TextEvent& event, const EventSettings& settings,
                                    BodyNumbers&) {
  const auto shots = shots_of(event, settings.ticks_per_second, settings.masks);
  return {shots.begin(), shots.end()};
}

std::vector<sim::Event> make_events(const scene::MoveEvent& event, const EventSettings& settings,
                                    BodyNumbers& bodies) {
  auto move = convert<sim::MoveBody>(event, tick_at(event.time, settings.ticks_per_second));
  move.body = bodies[event.body];
  return {move};
}

// Changes of the level, which come on their own.
std::vector<sim::Event> make_events(const scene::EditEvent&, const EventSettings&, BodyNumbers&) {
  return {};
}
std::vector<sim::Event> make_events(const scene::DoorEvent&, const EventSettings&, BodyNumbers&) {
  return {};
}

/// The event of the simulation of the same name, with the fields that both have.
template <typename Event, typename... Kinds>
sim::Event same_kind(const char* name, const Event& event, std::uint32_t tick,
                     const std::variant<Kinds...>*) {
  sim::Event made;
  const auto try_kind = [&]<typename Kind>(const Kind& kind) {
    if (std::string_view(name) == sim::name_of(kind)) made = convert<Kind>(event, tick);
  };
  (try_kind(Kinds{}), ...);
  return made;
}

template <typename Event>
std::string place_of(const Event& event) {
  if constexpr (requires { event.place; }) return event.place;
  return {};
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

BodyNumbers number_bodies(const scene::Timeline& timeline) {
  BodyNumbers bodies;
  for (const scene::MoveEvent& event : timeline.moves) bodies[event.body];
  return bodies;
}

Result<std::vector<OrderedEvent>> ordered_events(const scene::Timeline& timeline,
                                                 const std::vector<LevelEvent>& changes, BodyNumbers& bodies,
                                                 const EventSettings& settings) {
  EventList events(settings.layout);

  // Level changes.
  for (const LevelEvent& event : changes)
    if (!event.blocks.empty())
      events.add(0, event.time, sim::LevelEdit{tick_at(event.time, settings.ticks_per_second), event.blocks},
                 {});

  // All others, of one tick in the order of the kinds.
  EventKind kind = 0;
  scene::for_each_event_list(timeline, [&](const char* name, const auto& list) {
    ++kind;
    for (const auto& event : list)
      if constexpr (requires { make_events(event, settings, bodies); })
        for (sim::Event& made : make_events(event, settings, bodies))
          events.add(kind, event.time, std::move(made), place_of(event));
      else
        events.add(kind, event.time,
                   same_kind(name, event, tick_at(event.time, settings.ticks_per_second),
                             static_cast<const sim::Event*>(nullptr)),
                   place_of(event));
  });
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
