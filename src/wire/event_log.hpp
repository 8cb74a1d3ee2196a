// The bytes of an event log.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/events.hpp"
#include "wire/limits.hpp"

namespace brume::wire {

/// Events of a world of this layout, in their order. The same bytes for the same events.
std::vector<std::byte> write_events(std::span<const sim::Event> events, const voxel::GridLayout& layout);

/// Reads them again. Fails with bad_input when the bytes are damaged, cut short, or beyond the limits, and
/// for an event that sim::check_event refuses.
Result<std::vector<sim::Event>> read_events(std::span<const std::byte> bytes, const voxel::GridLayout& layout,
                                            const Limits& limits = {});

}  // namespace brume::wire
