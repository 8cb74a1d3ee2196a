// The fields of the events of a world's log: units and ranges. check_event, logs and packets, and the
// conversions from timelines, C and Python walk it; tests compare brume.h with it.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "core/error.hpp"
#include "sim/events.hpp"

namespace brume::sim {

/// What one step of a number is.
enum class FieldUnit : std::uint8_t { one, tick, metre_1024, millisecond, fraction_255, turn_65536 };

/// Steps of a metre, a second, the whole, a turn; 1 for what is counted.
constexpr std::uint32_t steps_of(FieldUnit unit) {
  switch (unit) {
    case FieldUnit::metre_1024:
      return kUnitsPerMetre;
    case FieldUnit::millisecond:
      return 1000;
    case FieldUnit::fraction_255:
      return 255;
    case FieldUnit::turn_65536:
      return kFullTurn;
    default:
      return 1;
  }
}

/// A position, within kMaxCoordinate along each axis.
struct PositionField {
  const char* key;               ///< As in timelines.
  const char* about;             ///< For messages.
  const char* c_name = nullptr;  ///< In the structs of brume.h; null: the key.
};
/// One of some values of an enumeration.
struct ChoiceField {
  const char* c_name;  ///< In the structs of brume.h.
};
/// A number.
struct NumberField {
  const char* key;     ///< As in timelines.
  const char* c_name;  ///< In the structs of brume.h, without its unit.
  const char* about;   ///< For messages.
  FieldUnit unit;
  std::uint64_t low, high;  ///< Inclusive; with in_voxels the high end in voxels.
  bool in_voxels = false;
};

template <typename Event, typename Kind>
concept EventOf = std::same_as<std::remove_const_t<Event>, Kind>;

/// What messages call a kind of event.
constexpr const char* name_of(const ThrowSmoke&) {
  return "smoke";
}
constexpr const char* name_of(const Shot&) {
  return "shot";
}
constexpr const char* name_of(const Blast&) {
  return "blast";
}
constexpr const char* name_of(const MoveBody&) {
  return "move";
}
constexpr const char* name_of(const LevelEdit&) {
  return "edit";
}

// Each function calls visit(field, member) for every position, number and choice of an event besides its
// tick, in the order of its struct in brume.h, which logs and packets have, too; a const event gives const
// members.

template <EventOf<ThrowSmoke> Event, typename Visitor>
void visit_fields(Event& e, Visitor&& visit) {
  visit(PositionField{"from", "`from`"}, e.from);
  visit(PositionField{"at", "`at`"}, e.at);
  visit(NumberField{"voxels", "voxels", "voxels", FieldUnit::one, 1, kMaxFillVoxels}, e.smoke.voxels);
  visit(NumberField{"bloom", "bloom", "bloom ticks", FieldUnit::tick, 1, kMaxTick}, e.smoke.bloom_ticks);
  visit(NumberField{"hold", "hold", "hold ticks", FieldUnit::tick, 0, kMaxTick}, e.smoke.hold_ticks);
  visit(NumberField{"dissolve", "dissolve", "dissolve ticks", FieldUnit::tick, 1, kMaxTick},
        e.smoke.dissolve_ticks);
}

template <EventOf<Shot> Event, typename Visitor>
void visit_fields(Event& e, Visitor&& visit) {
  const auto time = [](const char* key, const char* c_name) {
    return NumberField{key, c_name, "milliseconds", FieldUnit::millisecond, 0, kMaxMilliseconds};
  };
  visit(PositionField{"from", "the muzzle", "origin"}, e.origin);
  visit(PositionField{"toward", "`toward`"}, e.toward);
  visit(NumberField{"radius", "radius", "a radius", FieldUnit::metre_1024, 1, kMaxCoordinate}, e.radius);
  visit(time("reach", "reach_far"), e.timing.reach_far);
  visit(time("expand", "expand"), e.timing.expand);
  visit(time("stay", "stay_open"), e.timing.stay_open);
  visit(time("fade", "fade"), e.timing.fade);
  visit(ChoiceField{"shape"}, e.shape);
  visit(NumberField{"mask", "mask_index", "a mask", FieldUnit::one, 0, kMaxMasks - 1}, e.mask);
  visit(NumberField{"roll", "roll", "a roll", FieldUnit::turn_65536, 0, kFullTurn - 1}, e.roll);
}

template <EventOf<Blast> Event, typename Visitor>
void visit_fields(Event& e, Visitor&& visit) {
  visit(PositionField{"at", "`at`"}, e.at);
  visit(NumberField{"radius", "radius", "a radius", FieldUnit::metre_1024, 1, kMaxBlastVoxels, true},
        e.radius);
  visit(NumberField{"speed", "speed", "a speed", FieldUnit::metre_1024, kUnitsPerMetre, 1u << 24}, e.speed);
  visit(NumberField{"remaining", "remaining", "a remaining fraction", FieldUnit::fraction_255, 0, 255},
        e.remaining);
  visit(NumberField{"refill_rim", "refill_rim", "milliseconds to refill the rim", FieldUnit::millisecond, 1,
                    kMaxMilliseconds},
        e.refill_rim_ms);
  // The rule between the two: the middle is full no earlier than the rim.
  visit(NumberField{"refill_middle", "refill_middle", "milliseconds to refill the middle",
                    FieldUnit::millisecond, e.refill_rim_ms, kMaxMilliseconds},
        e.refill_middle_ms);
}

template <EventOf<MoveBody> Event, typename Visitor>
void visit_fields(Event& e, Visitor&& visit) {
  visit(NumberField{"body", "body", "a body", FieldUnit::one, 0, UINT32_MAX}, e.body);
  visit(PositionField{"to", "`to`"}, e.to);
}

/// Its blocks are no fields.
template <EventOf<LevelEdit> Event, typename Visitor>
void visit_fields(Event&, Visitor&&) {}

/// Fails with bad_input, in one line, when a number of the event is outside its range, a position is
/// outside the world, or the blocks of an edit lie outside the grid or are out of order.
Result<void> check_event(const Event& event, const voxel::GridLayout& layout);

}  // namespace brume::sim
