// Coding of a cloud: its masks, and while it flows after an edit its densities before the flow.
#pragma once

#include <cstdint>

#include "sim/cloud.hpp"
#include "wire/archive.hpp"

namespace brume::wire {

template <typename F>
void serialize(F& archive, sim::CloudOrigin& origin) {
  archive.field(Field::detonation_tick, origin.detonation_tick);
  serialize_position(archive, Field::voxel, origin.source);
  serialize(archive, origin.settings);
}

/// Codes all of a cloud's parts at a tick. `before` is the same cloud in the state both sides have, or null;
/// values it predicts cost almost nothing. Of decoded parts only the origin and flow_tick are validated here;
/// Cloud::from_parts checks the rest.
template <typename Coder>
void code_cloud(Archive<Coder>& archive, const sim::Cloud* before, std::uint32_t tick,
                sim::CloudParts& parts);

}  // namespace brume::wire
