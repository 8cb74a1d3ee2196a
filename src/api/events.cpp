#include "api/events.hpp"

#include <cstring>

#include "api/objects.hpp"
#include "sim/event_fields.hpp"
#include "sim/level_edit.hpp"

namespace brume::api {
namespace {

sim::Position position_of(const brume_position& p) {
  return {p.x, p.y, p.z};
}

sim::Event event_of(std::uint32_t tick, const brume_smoke_event& e) {
  return sim::ThrowSmoke{tick,
                         position_of(e.from),
                         position_of(e.at),
                         {e.voxels, e.bloom_ticks, e.hold_ticks, e.dissolve_ticks}};
}

sim::Event event_of(std::uint32_t tick, const brume_shot_event& e) {
  require(e.shape <= BRUME_HOLE_MASK, "a shot's `shape` must be a brume_hole_shape");
  return sim::Shot{tick,
                   position_of(e.origin),
                   position_of(e.toward),
                   e.radius_1024,
                   {e.reach_far_ms, e.expand_ms, e.stay_open_ms, e.fade_ms},
                   static_cast<sim::HoleShape>(e.shape),
                   e.mask_index,
                   e.roll_65536};
}

sim::Event event_of(std::uint32_t tick, const brume_blast_event& e) {
  return sim::Blast{tick,
                    position_of(e.at),
                    e.radius_1024,
                    e.speed_1024,
                    e.remaining_255,
                    e.refill_rim_ms,
                    e.refill_middle_ms};
}

sim::Event event_of(std::uint32_t tick, const brume_move_event& e) {
  return sim::MoveBody{tick, e.body, position_of(e.to)};
}

sim::Event event_of(std::uint32_t tick, const brume_edit_event& e, const voxel::GridLayout& layout) {
  require(e.solid <= 1, "an edit's `solid` must be 0 or 1");
  const glm::ivec3 low = to_ivec3(e.low), high = to_ivec3(e.high);
  require(glm::all(glm::lessThan(low, high)), "the box of an edit must have a voxel");
  return sim::LevelEdit{tick, sim::edit_box(layout, low, high, e.solid == 1)};
}

sim::Event event_of(const brume_event& event, const voxel::GridLayout& layout) {
  switch (event.kind) {
    case BRUME_EVENT_SMOKE:
      return event_of(event.tick, event.u.smoke);
    case BRUME_EVENT_SHOT:
      return event_of(event.tick, event.u.shot);
    case BRUME_EVENT_BLAST:
      return event_of(event.tick, event.u.blast);
    case BRUME_EVENT_MOVE:
      return event_of(event.tick, event.u.move);
    case BRUME_EVENT_EDIT:
      return event_of(event.tick, event.u.edit, layout);
    default:
      refuse("`kind` must be a brume_event_kind, not " + std::to_string(event.kind));
  }
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
