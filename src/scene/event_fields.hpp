// Every kind of event of a timeline in one place: its fields with units, ranges and meanings, and the rules
// between them. The reader, the writer and the checker of timelines, the conversion to the simulation, the
// viewer's panels, Blender's add-on and docs/guides/timelines.md are generated from it or tested against it.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "scene/events.hpp"
#include "scene/options.hpp"

namespace brume::scene {

/// A point [m], within kFarthestEvent along each axis. Required.
struct PointField {
  const char *key, *about;
};
/// A text in UTF-8. Required.
struct TextField {
  const char *key, *about;
  bool names_object = false;  ///< An object, which the scene must have.
  std::size_t least_bytes = 0, most_bytes = SIZE_MAX;
};
/// True or false. Required.
struct FlagField {
  const char *key, *about;
};
/// A file in or below the timeline's folder. May be missing.
struct FileField {
  const char *key, *about;
};

/// What must hold between two fields. Messages are about the first of them.
enum class RuleKind : std::uint8_t {
  differs,   ///< Two points are not the same.
  at_least,  ///< A number is not below the other one.
  above,     ///< A point is above the other one along every axis.
  goes_with  ///< A file is named exactly if the choice is the name of its key.
};
struct EventRule {
  RuleKind kind;
  const char *key, *other;
};

/// Whether the rule allows the values of its two fields.
inline bool holds(const EventRule& rule, const glm::vec3& value, const glm::vec3& other) {
  return rule.kind == RuleKind::differs ? value != other : glm::all(glm::greaterThan(value, other));
}
inline bool holds(const EventRule&, float value, float other) {
  return !(value < other);
}
inline bool holds(const EventRule&, const std::filesystem::path& file, ShotShape shape) {
  return file.empty() != (shape == ShotShape::mask);
}

/// What messages expect of a text, where it is not so long.
inline std::optional<std::string> fault_of(const TextField& field, const std::string& text) {
  if (text.size() >= field.least_bytes && text.size() <= field.most_bytes) return {};
  return std::to_string(field.least_bytes) + " to " + std::to_string(field.most_bytes) + " bytes";
}

/// "a point other than \"from\"": what messages expect of its first field.
inline std::string expectation(const EventRule& rule) {
  const std::string other = '"' + std::string(rule.other) + '"';
  switch (rule.kind) {
    case RuleKind::differs:
      return "a point other than " + other;
    case RuleKind::at_least:
      return "no less than " + other;
    case RuleKind::above:
      return "more than " + other + " along every axis";
    case RuleKind::goes_with:
      break;
  }
  return "a picture if the " + std::string(rule.other) + " is a " + rule.key + ", and only then";
}

// Each function calls visit(field, member) for every field of an event besides its time, in the order of
// files, and visit(rule, member, other member) for every rule; numbers are OptionInfo and have defaults. A
// const event gives const members.

template <typename Event, typename Kind>
concept EventOf = std::same_as<std::remove_const_t<Event>, Kind>;

template <EventOf<SmokeEvent> Event, typename Visitor>
void visit_event(Event& e, Visitor&& visit) {
  visit(PointField{"from", "where the thrower is; where `at` is: it goes off there"}, e.from_world);
  visit(PointField{"at", "what the grenade flies to"}, e.at_world);
}

template <typename Options, typename Visitor>
void visit_hole_times(Options& o, Visitor&& visit) {
  visit(OptionInfo{"reach", "s", "time until the front reaches the far end", 0, 60, "time to pierce"},
        o.reach);
  visit(OptionInfo{"expand", "s", "time to open, at each depth", 0, 60, "time to open"}, o.expand);
  visit(OptionInfo{"stay", "s", "time fully open", 0, 600, "time open"}, o.stay);
  visit(OptionInfo{"fade", "s", "time to close", 0, 60, "time to close"}, o.fade);
}

inline constexpr std::array kShotShapes{"cylinder", "box", "mask"};

template <EventOf<ShotEvent> Event, typename Visitor>
void visit_event(Event& e, Visitor&& visit) {
  visit(PointField{"from", "the muzzle"}, e.from_world);
  visit(PointField{"toward", "a point that the shot passes through"}, e.toward_world);
  visit(EventRule{RuleKind::differs, "toward", "from"}, e.toward_world, e.from_world);
  visit(ChoiceField{"shape", "cross-section of the hole", kShotShapes}, e.shape);
  visit(FileField{"mask", "image of a mask's cross-section"}, e.mask);
  visit(EventRule{RuleKind::goes_with, "mask", "shape"}, e.mask, e.shape);
  visit(OptionInfo{"radius", "m", "radius of the hole; half the edge of a box or mask", 0.01, 10}, e.radius);
  visit_hole_times(e.times, visit);
  visit(OptionInfo{"roll", kDegrees, "rotates a box or mask clockwise as seen by the shooter", -360, 360},
        e.roll);
  visit(OptionInfo{"flash", "W/sr", "intensity of the muzzle flash, 0.06 s long", 0, 1e6}, e.flash);
}

template <EventOf<TextEvent> Event, typename Visitor>
void visit_event(Event& e, Visitor&& visit) {
  visit(TextField{"text", "one line", false, 1, kMaxTextBytes}, e.text);
  visit(PointField{"from", "where the shooter is"}, e.from_world);
  visit(PointField{"toward", "a point on the path of the row's middle"}, e.toward_world);
  visit(EventRule{RuleKind::differs, "toward", "from"}, e.toward_world, e.from_world);
  visit(FileField{"font", "a font file"}, e.font);
  visit(OptionInfo{"size", "m", "height of a capital letter", 0.02, 10, "letter height"}, e.size);
  visit(OptionInfo{"spacing", "", "extra space between letters, in heights of a capital", -0.5, 10,
                   "letter spacing"},
        e.spacing);
  visit(OptionInfo{"interval", "s", "time from letter to letter", 0, 10, "time between letters"}, e.interval);
  visit_hole_times(e.times, visit);
  visit(OptionInfo{"roll", kDegrees, "rotates the row clockwise as seen by the shooter", -360, 360}, e.roll);
}

template <EventOf<BlastEvent> Event, typename Visitor>
void visit_event(Event& e, Visitor&& visit) {
  visit(PointField{"at", "the centre of the explosion"}, e.at_world);
  visit(OptionInfo{"radius", "m", "radius of the cavity", 0.1, 100}, e.radius);
  visit(OptionInfo{"speed", "m/s", "speed of the front", 1, 10000, "speed of the front"}, e.speed);
  visit(OptionInfo{"remaining", "", "fraction of the density that remains", 0, 1, "smoke that remains"},
        e.remaining);
  visit(OptionInfo{"refill_rim", "s", "time until the rim is full again", 0.01, 60, "edge full after"},
        e.refill_rim);
  visit(OptionInfo{"refill_middle", "s", "time until the middle is full again; at least `refill_rim`", 0.01,
                   60, "middle full after"},
        e.refill_middle);
  visit(EventRule{RuleKind::at_least, "refill_middle", "refill_rim"}, e.refill_middle, e.refill_rim);
  visit(OptionInfo{"flash", "W/sr", "intensity of the fireball, 0.3 s long", 0, 1e6}, e.flash);
}

template <EventOf<MoveEvent> Event, typename Visitor>
void visit_event(Event& e, Visitor&& visit) {
  visit(TextField{"body", "its name"}, e.body);
  visit(PointField{"to", "where it is from then on"}, e.to_world);
}

template <EventOf<EditEvent> Event, typename Visitor>
void visit_event(Event& e, Visitor&& visit) {
  visit(PointField{"low", "low corner of the box"}, e.low_world);
  visit(PointField{"high", "its high corner"}, e.high_world);
  visit(EventRule{RuleKind::above, "high", "low"}, e.high_world, e.low_world);
  visit(FlagField{"solid", "whether its voxels become wall, or free"}, e.solid);
}

template <EventOf<DoorEvent> Event, typename Visitor>
void visit_event(Event& e, Visitor&& visit) {
  visit(TextField{"object", "the objects that make up the door", true}, e.object);
  visit(FlagField{"open", "whether it opens, or closes"}, e.open);
}

/// The short light of an event: its intensity falls from `flash` with the square of the remaining time, and
/// its colour goes from the first to the last.
struct EventFlash {
  glm::vec3 at_world{0};
  double seconds = 0;  ///< How long it lasts, from the tick of the event.
  glm::vec3 first_color{1}, last_color{1};
};
/// How far a muzzle flash is ahead of the muzzle, and a fireball's light above its centre, which may be on
/// the ground [m].
constexpr float kMuzzleAhead = 0.3f, kFireballAbove = 0.4f;

// For each kind of event with a `flash`.
inline EventFlash flash_of(const ShotEvent& shot) {
  constexpr glm::vec3 kPowder{1, 0.68f, 0.34f};
  const glm::vec3 ahead = kMuzzleAhead * glm::normalize(shot.toward_world - shot.from_world);
  return {shot.from_world + ahead, 0.06, kPowder, kPowder};
}
/// A fireball that fades from yellow to red.
inline EventFlash flash_of(const BlastEvent& blast) {
  return {blast.at_world + glm::vec3(0, kFireballAbove, 0), 0.3, {1, 0.72f, 0.38f}, {1, 0.34f, 0.08f}};
}

/// Passes on the numbers of an event alone.
template <typename Visitor>
struct EventNumbers {
  Visitor& visit;
  void operator()(const OptionInfo& info, auto& member) { visit(info, member); }
  void operator()(const auto&, auto&...) {}
};
/// As a function of scene/options.hpp.
template <typename Event, typename Visitor>
void visit_event_numbers(Event& e, Visitor&& visit) {
  visit_event(e, EventNumbers<std::remove_reference_t<Visitor>>{visit});
}

/// Raises numbers that a rule keeps from being below others.
struct RuleKeeper {
  void operator()(const EventRule&, float& value, float other) { value = std::max(value, other); }
  void operator()(const auto&, auto&...) {}
};
template <typename Event>
void keep_rules(Event& e) {
  visit_event(e, RuleKeeper{});
}

}  // namespace brume::scene
