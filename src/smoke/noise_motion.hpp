// What advects the noise in the smoke at a time: the same bits on every machine.
#pragma once

#include "core/frame_memory.hpp"
#include "shared/noise_advection.h"
#include "sim/state.hpp"

namespace brume::smoke {

/// The shortest time that a roll of the noise takes [s]; shorter periods count as this one.
constexpr double kMinSwirlPeriod = 0.1;

/// What a cloud does to its noise `seconds` after tick 0. While the cloud blooms its noise grows with its
/// front, as a puff does that keeps its shape: what is at the front stays there. It ends on its place in the
/// grown cloud, and then creeps on by at most a seventh of its distance. The rolls start fast, settle to a
/// turn in `swirl_period`, and widen while the cloud dissolves. Every member is bounded and continuous in
/// time.
shared::CloudMotion cloud_motion(const sim::Cloud& cloud, std::uint32_t ticks_per_second, double seconds,
                                 double swirl_period);

/// The most impulses at a time.
constexpr std::size_t kMaxImpulses = 64;

/// The impulses of shots, bodies and explosions; of more than kMaxImpulses the latest. Each begins and ends
/// at rest.
FrameVector<shared::Impulse> make_impulses(const sim::State& state, double seconds, Allocator memory = {});

struct NoiseMotion {
  FrameVector<shared::CloudMotion> clouds;  ///< One for each cloud of the state, in their order.
  FrameVector<shared::Impulse> impulses;
  /// What the impulses add to the displacement of a point [m].
  glm::vec3 by_impulses(glm::vec3 p_world) const;
};

/// What advects the noise of a state `seconds` after tick 0.
NoiseMotion noise_motion(const sim::State& state, double seconds, double swirl_period, Allocator memory = {});

}  // namespace brume::smoke
