#include "wire/archive.hpp"

namespace brume::wire {

DeltaContext::DeltaContext(std::uint32_t tick) {
  for (const Field field : {Field::throw_tick, Field::detonation_tick, Field::shot_tick, Field::blast_tick,
                            Field::body_tick, Field::body_tick_before, Field::edit_tick})
    at(field) = tick;
  sim::Shot shot;
  shot.tick = tick;
  serialize(*this, shot);
  sim::Blast blast;
  blast.tick = tick;
  serialize(*this, blast);
  sim::SmokeSettings smoke;
  serialize(*this, smoke);
}

template <typename Coder>
void serialize(Archive<Coder>& archive, sim::EditBlocks& edits) {
  std::vector<sim::VoxelBlock> solid, free;
  for (const sim::EditBlock& edit : edits) {
    if (edit.make_solid != 0) solid.push_back({edit.at, edit.make_solid, 0});
    if (edit.make_free != 0) free.push_back({edit.at, edit.make_free, 0});
  }
  solid = archive.edit_blocks(std::move(solid));
  free = archive.edit_blocks(std::move(free));
  if constexpr (Coder::kReads) {
    edits.clear();
    auto a = solid.begin();
    auto b = free.begin();
    while (a != solid.end() || b != free.end()) {
      const bool of_a = b == free.end() || (a != solid.end() && !sim::block_before(b->at, a->at));
      const bool of_b = a == solid.end() || (b != free.end() && !sim::block_before(a->at, b->at));
      edits.push_back({of_a ? a->at : b->at, of_a ? a->mask : 0, of_b ? b->mask : 0});
      if (of_a) ++a;
      if (of_b) ++b;
    }
  }
}

template void serialize(Archive<Encoder>&, sim::EditBlocks&);
template void serialize(Archive<Decoder>&, sim::EditBlocks&);

}  // namespace brume::wire
