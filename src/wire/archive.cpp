#include "wire/archive.hpp"

#include <algorithm>
#include <iterator>

namespace brume::wire {
namespace {

/// Predicts an event of each kind with its defaults.
template <typename... Kinds>
void predict_events(DeltaContext& context, std::uint32_t tick, const std::variant<Kinds...>*) {
  const auto predict = [&]<typename Kind>(Kind event) {
    event.tick = tick;
    serialize_event(context, event);
  };
  (predict(Kinds{}), ...);
}

}  // namespace

DeltaContext::DeltaContext(std::uint32_t tick) {
  for (const Field field :
       {Field::throw_tick, Field::detonation_tick, Field::body_tick, Field::body_tick_before})
    at(field) = tick;
  predict_events(*this, tick, static_cast<const sim::Event*>(nullptr));
  sim::SmokeSettings smoke;
  serialize(*this, smoke);
}

sim::EditBlocks folded(const sim::EditBlocks& edits) {
  sim::EditBlocks result = edits;
  for (sim::EditBlock& edit : result) {
    const std::uint64_t roles = edit.make_glass | edit.make_grille;
    edit.make_solid |= roles;
    edit.make_free |= roles;
    edit.make_glass = 0;
  }
  return result;
}

std::optional<sim::EditBlocks> unfolded(const sim::EditBlocks& folded) {
  sim::EditBlocks result = folded;
  for (sim::EditBlock& edit : result) {
    const std::uint64_t both = edit.make_solid & edit.make_free;
    if ((edit.make_grille & ~both) != 0) return std::nullopt;
    edit.make_glass = both & ~edit.make_grille;
    edit.make_solid &= ~both;
    edit.make_free &= ~both;
  }
  return result;
}

sim::EditBlocks flipped(const sim::EditBlocks& a, const sim::EditBlocks& b) {
  sim::EditBlocks both;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both),
             [](const sim::EditBlock& x, const sim::EditBlock& y) { return sim::block_before(x.at, y.at); });
  sim::EditBlocks result;
  for (const sim::EditBlock& edit : both) {
    if (!result.empty() && result.back().at == edit.at) {
      sim::EditBlock& block = result.back();
      block.make_solid ^= edit.make_solid;
      block.make_free ^= edit.make_free;
      block.make_glass ^= edit.make_glass;
      block.make_grille ^= edit.make_grille;
    } else {
      result.push_back(edit);
    }
  }
  std::erase_if(result, [](const sim::EditBlock& edit) { return edit.all() == 0; });
  return result;
}

bool has_roles(const sim::EditBlocks& folded) {
  return std::ranges::any_of(
      folded, [](const sim::EditBlock& edit) { return (edit.make_solid & edit.make_free) != 0; });
}

template <typename Coder>
void serialize_solid_and_free(Archive<Coder>& archive, sim::EditBlocks& edits) {
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

template <typename Coder>
void serialize_grilles(Archive<Coder>& archive, sim::EditBlocks& edits) {
  std::vector<sim::VoxelBlock> grilles;
  for (const sim::EditBlock& edit : edits)
    if (edit.make_grille != 0) grilles.push_back({edit.at, edit.make_grille, 0});
  grilles = archive.edit_blocks(std::move(grilles));
  if constexpr (Coder::kReads) {
    sim::EditBlocks third;
    for (const sim::VoxelBlock& block : grilles) third.push_back({block.at, 0, 0, 0, block.mask});
    edits = flipped(edits, third);
  }
}

template <typename Coder>
void serialize(Archive<Coder>& archive, sim::EditBlocks& edits) {
  sim::EditBlocks lists = folded(edits);
  serialize_solid_and_free(archive, lists);
  if (has_roles(lists)) serialize_grilles(archive, lists);
  if constexpr (Coder::kReads) {
    auto read = unfolded(lists);
    if (!read) archive.fail("an edit makes a voxel a grille and something else");
    edits = read ? std::move(*read) : sim::EditBlocks();
  }
}

template void serialize_solid_and_free(Archive<Encoder>&, sim::EditBlocks&);
template void serialize_solid_and_free(Archive<Decoder>&, sim::EditBlocks&);
template void serialize_grilles(Archive<Encoder>&, sim::EditBlocks&);
template void serialize_grilles(Archive<Decoder>&, sim::EditBlocks&);
template void serialize(Archive<Encoder>&, sim::EditBlocks&);
template void serialize(Archive<Decoder>&, sim::EditBlocks&);

}  // namespace brume::wire
