// A whole State through a coder: as its difference from another one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/state.hpp"
#include "wire/limits.hpp"

namespace brume::wire {

/// What is different in `now` from `base`, which has no more events, and the same layout,
/// ticks_per_second and masks or nothing at all.
std::vector<std::byte> write_body(const sim::State& base, const sim::State& now);

/// The state of `tick` that differs from the base as the bytes say; what does not differ is shared with it.
/// Fails with bad_input for bytes that are cut short, too many or beyond the limits, and for what no
/// simulation makes: ids out of order, numbers out of range, clouds whose parts contradict each other. No
/// checksum is looked at here.
Result<sim::State> read_body(std::span<const std::byte> body, const sim::State& base, std::uint32_t tick,
                             const Limits& limits);

}  // namespace brume::wire
