// What moves the noise in the smoke at a moment, as the drift pass takes it.
#pragma once

#include <vector>

#include "shared/noise_advection.h"
#include "sim/state.hpp"

namespace brume::planning {

/// Of the rolls of the noise: how long one takes once the cloud has settled.
constexpr double kMinSwirlPeriod = 0.1;

/// What a cloud does to its noise `seconds` after tick 0. While the cloud blooms its noise grows with its
/// front, as a puff does that keeps its shape: what is at the front stays there. It ends on its place in the
/// grown cloud, and then creeps on by at most a seventh of its way. The rolls start fast, settle to a turn in
/// `swirl_period`, and widen while the cloud dissolves. Every member is bounded and continuous in time.
shared::CloudMotion cloud_motion(const sim::Cloud& cloud, std::uint32_t ticks_per_second, double seconds,
                                 double swirl_period);

/// The most things that move the noise at a time.
constexpr std::size_t kMaxImpulses = 64;

/// Shots, bodies and explosions that move the noise; of more than kMaxImpulses the latest. Each begins and ends
/// with nothing moved.
std::vector<shared::Impulse> impulses_of(const sim::State& state, double seconds);

}  // namespace brume::planning
