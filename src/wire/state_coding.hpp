// A whole State through a coder: as its difference from another one.
#pragma once

#include "sim/state.hpp"
#include "wire/form.hpp"

namespace brume::wire {

/// Codes what is different in `now` from `base`; frame, ticks_per_second and tick are set before. What is not
/// different is shared with the base. A decoder refuses what no simulation makes: ids out of order, numbers
/// out of range, clouds whose parts contradict each other.
template <typename Coder>
void code_state(Form<Coder>& form, const sim::State& base, sim::State& now);

}  // namespace brume::wire
