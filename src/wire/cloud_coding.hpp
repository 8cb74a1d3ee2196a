// A cloud through a coder: its masks, and while it flows on after an edit the densities that it had.
#pragma once

#include <cstdint>

#include "sim/cloud.hpp"
#include "wire/archive.hpp"

namespace brume::wire {

template <typename F>
void serialize(F& archive, sim::CloudOrigin& origin) {
  archive.field(Field::detonation_tick, origin.detonation_tick);
  describe_position(archive, Field::voxel, origin.source);
  serialize(archive, origin.settings);
}

/// Codes all of a cloud's parts at a tick. `before` is the same cloud in the state that both sides have, or
/// null: what it foretells costs next to nothing. Of what is read the origin and the flow are in range; all
/// else is for Cloud::from_parts to judge.
template <typename Coder>
void code_cloud(Archive<Coder>& archive, const sim::Cloud* before, std::uint32_t tick, sim::CloudParts& parts);

}  // namespace brume::wire
