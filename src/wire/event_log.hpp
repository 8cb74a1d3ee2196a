// Serialization of event logs.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/events.hpp"
#include "wire/limits.hpp"

namespace brume::wire {

/// Serializes events of a world with this layout, in order. Equal events give equal bytes.
std::vector<std::byte> write_events(std::span<const sim::Event> events, const voxel::GridLayout& layout);

/// Reads the output of write_events. Fails with bad_input when the bytes are damaged, truncated or beyond the
/// limits, and for an event that sim::check_event rejects.
Result<std::vector<sim::Event>> read_events(std::span<const std::byte> bytes, const voxel::GridLayout& layout,
                                            const Limits& limits = {});

}  // namespace brume::wire
