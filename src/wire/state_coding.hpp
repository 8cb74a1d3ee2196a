// Coding of a State as its difference from another one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/state.hpp"
#include "wire/limits.hpp"

namespace brume::wire {

/// The differences of `now` from `base`. `base` has no more events than `now`, and either the same level,
/// ticks_per_second and masks, or is a default State.
std::vector<std::byte> write_body(const sim::State& base, const sim::State& now);

/// Applies the differences to `base`; returns the state of `tick`, which shares the unchanged items of the
/// base. Fails with bad_input for bytes that are truncated, too many or beyond the limits, and for states
/// that no simulation produces: ids out of order, numbers out of range, clouds with inconsistent parts. Does
/// not verify checksums.
Result<sim::State> read_body(std::span<const std::byte> body, const sim::State& base, std::uint32_t tick,
                             const Limits& limits);

}  // namespace brume::wire
