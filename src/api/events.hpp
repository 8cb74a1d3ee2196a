// From the events of the C interface to events of the simulation.
#pragma once

#include <vector>

#include "api/call.hpp"
#include "sim/events.hpp"

namespace brume::api {

/// Throws a CallFailure for events that the simulation does not accept in a world with this layout and so
/// many masks.
std::vector<sim::Event> events_of(const brume_event* events, std::size_t count,
                                  const voxel::GridLayout& layout, std::uint32_t mask_count);

}  // namespace brume::api
