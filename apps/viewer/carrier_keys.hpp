// The keys of a carrier at the current time.
#pragma once

#include <cstddef>
#include <optional>

#include "scene/carrier.hpp"

namespace brume::viewer {

/// The key of a time [s]: the nearest one, if it is within a tick of the session, which no player tells
/// apart.
std::optional<std::size_t> key_of_time(const scene::Carrier& carrier, double seconds);

/// Sets where a carrier is at the time of `pose` [s]: moves the key of that time, which keeps its time, or
/// adds one.
void set_key(scene::Carrier& carrier, const scene::CarrierKey& pose);

/// Removes the key of a time; false if there is none, or no other.
bool remove_key(scene::Carrier& carrier, double seconds);

/// Times of the keys before and after a time, not of a key at the time itself.
std::optional<double> key_time_before(const scene::Carrier& carrier, double seconds);
std::optional<double> key_time_after(const scene::Carrier& carrier, double seconds);

}  // namespace brume::viewer
