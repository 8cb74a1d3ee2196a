// Ticks of the simulation from seconds of timelines.
#pragma once

#include <cstdint>

#include "sim/world.hpp"

namespace brume::scenario {

/// The tick at or before a time [s]; 0 for times before 0. The only place where seconds become ticks.
std::uint32_t tick_at(double seconds, std::uint32_t ticks_per_second = sim::WorldSettings{}.ticks_per_second);

}  // namespace brume::scenario
