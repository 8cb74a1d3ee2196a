#include "api/events.hpp"

#include <array>
#include <cstring>
#include <string>
#include <type_traits>
#include <variant>

#include "api/objects.hpp"
#include "sim/event_fields.hpp"
#include "sim/level_edit.hpp"

namespace brume::api {
namespace {

/// Reads the words of a struct of an event, whose members have the order of sim/event_fields.hpp: its
/// visitor.
struct WordReader {
  const std::uint32_t* next;

  void operator()(const sim::PositionField&, sim::Position& position) {
    for (int axis = 0; axis < 3; ++axis) position[axis] = static_cast<std::int32_t>(*next++);
  }
  void operator()(const auto&, auto& member) {
    member = static_cast<std::remove_reference_t<decltype(member)>>(*next++);
  }
};

/// An event of a kind by its place in sim::Event, the number of its brume_event_kind less one.
template <typename... Kinds>
sim::Event event_of_words(const brume_event& event, const std::variant<Kinds...>*) {
  std::array<std::uint32_t, sizeof event.u / sizeof(std::uint32_t)> words;
  std::memcpy(words.data(), &event.u, sizeof words);
  sim::Event made;
  std::uint32_t kind = 0;
  const auto read_kind = [&]<typename Kind>(Kind of_kind) {
    if (++kind != event.kind) return;
    of_kind.tick = event.tick;
    sim::visit_fields(of_kind, WordReader{words.data()});
    made = of_kind;
  };
  (read_kind(Kinds{}), ...);
  return made;
}

sim::Event event_of(std::uint32_t tick, const brume_edit_event& e, const voxel::GridLayout& layout) {
  require(e.solid <= 1, "an edit's `solid` must be 0 or 1");
  const glm::ivec3 low = to_ivec3(e.low), high = to_ivec3(e.high);
  require(glm::all(glm::lessThan(low, high)), "the box of an edit must have a voxel");
  return sim::LevelEdit{tick, sim::edit_box(layout, low, high, e.solid == 1)};
}

sim::Event event_of(const brume_event& event, const voxel::GridLayout& layout) {
  if (event.kind == 0 || event.kind > std::variant_size_v<sim::Event>)
    refuse("`kind` must be a brume_event_kind, not " + std::to_string(event.kind));
  if (event.kind == BRUME_EVENT_EDIT) return event_of(event.tick, event.u.edit, layout);
  if (event.kind == BRUME_EVENT_SHOT)
    require(event.u.shot.shape <= BRUME_HOLE_MASK, "a shot's `shape` must be a brume_hole_shape");
  return event_of_words(event, static_cast<const sim::Event*>(nullptr));
}

sim::Event checked_event(const brume_event& event, const voxel::GridLayout& layout,
                         std::uint32_t mask_count) {
  require(event.tick <= sim::kMaxTick, "`tick` must be at most 536870912");
  sim::Event checked = event_of(event, layout);
  unwrap(sim::check_event(checked, layout));
  const auto* shot = std::get_if<sim::Shot>(&checked);
  if (shot && shot->shape == sim::HoleShape::mask && shot->mask >= mask_count)
    refuse("`mask_index` is " + std::to_string(shot->mask) + ", but the world has " +
           std::to_string(mask_count) + " masks");
  return checked;
}

/// As an element of an array, an event has one size in all versions.
const brume_event& whole_event(const brume_event& event) {
  if (event.struct_size != sizeof(brume_event))
    refuse("`struct_size` is " + std::to_string(event.struct_size) + ", expected " +
           std::to_string(sizeof(brume_event)) + ": start from brume_event_defaults");
  require(event.next == nullptr, "`next` must be null");
  return event;
}

}  // namespace

std::vector<sim::Event> events_of(const brume_event* events, std::size_t count,
                                  const voxel::GridLayout& layout, std::uint32_t mask_count) {
  require(count <= BRUME_MAX_EVENTS, "at most 2^20 events");
  if (count > 0) required(events, "events");
  std::vector<sim::Event> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    try {
      out.push_back(checked_event(whole_event(events[i]), layout, mask_count));
    } catch (CallFailure& failure) {
      failure.message.insert(0, "event " + std::to_string(i) + ": ");
      throw;
    }
  }
  return out;
}

}  // namespace brume::api
