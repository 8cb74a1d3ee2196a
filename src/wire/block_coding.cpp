#include "wire/block_coding.hpp"

#include <algorithm>
#include <span>

namespace brume::wire {
namespace {

using glm::ivec3;
using sim::VoxelBlock;

// The block in a sorted list, or null.
const VoxelBlock* find_block(std::span<const VoxelBlock> blocks, ivec3 at) {
  const auto found = std::lower_bound(
      blocks.begin(), blocks.end(), at,
      [](const VoxelBlock& b, ivec3 wanted) { return sim::block_before(b.at, glm::i16vec3(wanted)); });
  return found == blocks.end() || ivec3(found->at) != at ? nullptr : &*found;
}

std::uint64_t find_mask(std::span<const VoxelBlock> blocks, ivec3 at) {
  const VoxelBlock* block = find_block(blocks, at);
  return block ? block->mask : 0;
}

// The bits of a block inside a grid of this size.
std::uint64_t bits_inside(ivec3 size, ivec3 block) {
  const ivec3 end = glm::min(size - block * sim::kBlockSize, ivec3(sim::kBlockSize));
  std::uint64_t bits = 0;
  for (int z = 0; z < end.z; ++z)
    for (int y = 0; y < end.y; ++y) bits |= ((std::uint64_t{1} << end.x) - 1) << (4 * y + 16 * z);
  return bits;
}

// The known voxels of a block and of a one-voxel rim around it.
class Window {
 public:
  Window(std::span<const VoxelBlock> known, ivec3 at) {
    for (int dz = -1; dz <= 0; ++dz)
      for (int dy = -1; dy <= (dz < 0 ? 1 : 0); ++dy)
        for (int dx = -1; dx <= (dz < 0 || dy < 0 ? 1 : -1); ++dx)
          copy(find_mask(known, at + ivec3(dx, dy, dz)), ivec3(dx, dy, dz) * sim::kBlockSize);
  }

  void set(ivec3 v) { voxels_[index(v)] = 1; }

  // The known neighbours of a voxel as a model index.
  std::uint32_t context(ivec3 v) const {
    const std::uint8_t* at = &voxels_[index(v)];
    constexpr std::array kNeighbours{-1, -6, -36, -1 - 6, -1 - 36, -6 - 36, 1 - 6, 1 - 36, 6 - 36};
    std::uint32_t context = 0;
    for (const int neighbour : kNeighbours) context = 2 * context + at[neighbour];
    return context;
  }

 private:
  static std::size_t index(ivec3 v) {
    const glm::uvec3 in_window(v + 1);
    return in_window.x + 6u * in_window.y + 36u * in_window.z;
  }

  void copy(std::uint64_t mask, ivec3 corner) {
    for (; mask != 0; mask &= mask - 1) {
      const ivec3 v = corner + sim::voxel_of_block(ivec3(0), std::countr_zero(mask));
      if (glm::all(glm::greaterThanEqual(v, ivec3(-1))) && glm::all(glm::lessThanEqual(v, ivec3(4)))) set(v);
    }
  }

  std::array<std::uint8_t, 216> voxels_{};
};

template <typename Coder>
int code_signed(Coder& coder, NumberModel& model, int value, int reference) {
  const std::uint64_t code = coder.number(model, folded(std::int64_t{value} - reference));
  if constexpr (Coder::kReads) {
    if (code >> 20 != 0) coder.fail();
  }
  return coder.ok() ? static_cast<int>(reference + unfolded(code)) : 0;
}

template <typename Coder>
int code_gap(Coder& coder, NumberModel& model, int value, int reference) {
  const std::uint64_t code = coder.number(model, static_cast<std::uint64_t>(std::int64_t{value} - reference));
  if constexpr (Coder::kReads) {
    if (code >> 20 != 0) coder.fail();
  }
  return coder.ok() ? static_cast<int>(reference + static_cast<std::int64_t>(code)) : 0;
}

// Codes the position of the next block. `row` and `slice` are the first blocks of the current row and slice.
template <typename Coder>
ivec3 code_place(Coder& coder, BlockModels& models, std::span<const VoxelBlock> known, ivec3 row, ivec3 slice,
                 ivec3 at) {
  const ivec3 last(known.back().at);
  const ivec3 next = last + ivec3(1, 0, 0);
  const unsigned near = (find_block(known, next - ivec3(0, 1, 0)) ? 1u : 0u) |
                        (find_block(known, next - ivec3(0, 0, 1)) ? 2u : 0u);
  if (coder.bit(models.next_in_row[near], at == next)) return next;
  ivec3 place = last;
  place.z = code_gap(coder, models.gap_z, at.z, last.z);
  if (place.z != last.z) {
    place.y = code_signed(coder, models.slice_y, at.y, slice.y);
    place.x = code_signed(coder, models.slice_x, at.x, slice.x);
    return place;
  }
  place.y = code_gap(coder, models.gap_y, at.y, last.y);
  place.x = place.y != last.y ? code_signed(coder, models.row_x, at.x, row.x)
                              : code_gap(coder, models.gap_x, at.x, last.x + 2);
  return place;
}

template <typename Coder>
std::uint64_t code_mask(Coder& coder, BlockModels& models, std::span<const VoxelBlock> known, ivec3 at,
                        std::uint64_t mask) {
  Window window(known, at);
  std::uint64_t coded = 0;
  for (int i = 0; i < 64; ++i) {
    const ivec3 v = sim::voxel_of_block(ivec3(0), i);
    if (!coder.bit(models.mask[window.context(v)], mask >> i & 1)) continue;
    window.set(v);
    coded |= std::uint64_t{1} << i;
  }
  return coded;
}

// The same with a prediction: the context is how much the neighbours differ from the predicted set's.
template <typename Coder>
std::uint64_t code_mask_like(Coder& coder, BlockModels& models, std::span<const VoxelBlock> known, ivec3 at,
                             const Prediction& like, std::uint64_t mask) {
  constexpr std::uint32_t kAllNeighbours = 511;
  const std::uint64_t before = find_mask(like.set->blocks(), at);
  Window window(known, at), window_before(like.set->blocks(), at);
  std::uint64_t coded = 0;
  for (int i = 0; i < 64; ++i) {
    const ivec3 v = sim::voxel_of_block(ivec3(0), i);
    const bool was = before >> i & 1;
    const std::uint32_t neighbours = window_before.context(v);
    const int changed = std::popcount(neighbours ^ window.context(v));
    const bool at_rim = neighbours != (was ? kAllNeighbours : 0);
    const unsigned context =
        16 * like.kind + 8 * was + 4 * at_rim + static_cast<unsigned>(std::min(changed, 3));
    if (was) window_before.set(v);
    if (!coder.bit(models.predicted_mask[context], mask >> i & 1)) continue;
    window.set(v);
    coded |= std::uint64_t{1} << i;
  }
  return coded;
}

bool allowed(const BlockBounds& bounds, ivec3 at, std::uint64_t mask) {
  const ivec3 end = (bounds.size + (sim::kBlockSize - 1)) / sim::kBlockSize;
  if (glm::any(glm::lessThan(at, ivec3(0))) || glm::any(glm::greaterThanEqual(at, end))) return false;
  return mask != 0 && (bounds.whole_blocks || (mask & ~bits_inside(bounds.size, at)) == 0);
}

}  // namespace

template <typename Coder>
void code_blocks(Coder& coder, BlockModels& models, const BlockBounds& bounds, ivec3 near,
                 const Prediction& like, std::vector<VoxelBlock>& blocks) {
  const std::uint64_t count = coder.number(models.count, blocks.size());
  std::uint64_t voxels = 0;  // by cost_of
  ivec3 row(0), slice(0);
  for (std::uint64_t i = 0; i < count && coder.ok(); ++i) {
    // Its position, relative to the previous block, row or slice.
    VoxelBlock block;
    if constexpr (!Coder::kReads) block = blocks[i];
    const auto known = std::span<const VoxelBlock>(blocks).first(i);
    ivec3 at(block.at);
    if (i > 0) {
      at = code_place(coder, models, known, row, slice, at);
      if (at.z != known.back().at.z) slice = at;
      if (at.z != known.back().at.z || at.y != known.back().at.y) row = at;
    } else {
      for (int axis = 0; axis < 3; ++axis)
        at[axis] = code_signed(coder, models.first[static_cast<unsigned>(axis)], at[axis], near[axis]);
      row = slice = at;
    }

    // Its voxels; a decoder checks and appends them.
    block.mask = like.set ? code_mask_like(coder, models, known, at, like, block.mask)
                          : code_mask(coder, models, known, at, block.mask);
    if constexpr (Coder::kReads) {
      voxels += cost_of(block);
      if (!allowed(bounds, at, block.mask) || voxels > bounds.max_voxels) coder.fail();
      if (!coder.ok()) break;
      block.at = glm::i16vec3(at);
      blocks.push_back(block);
    }
  }
  if (!coder.ok()) blocks.clear();
}

template <typename Coder>
void code_densities(Coder& coder, DensityModels& models, const sim::BlockSet& set,
                    std::span<const std::uint8_t> expected, std::vector<std::uint8_t>& densities) {
  if constexpr (Coder::kReads) densities.assign(set.size(), 0);
  const auto code = [&](NumberModel& model, std::uint32_t rank, std::uint8_t near) {
    const auto difference = static_cast<std::int8_t>(static_cast<std::uint8_t>(densities[rank] - near));
    const std::int64_t coded = unfolded(coder.number(model, folded(difference)));
    densities[rank] = static_cast<std::uint8_t>(near + static_cast<std::uint8_t>(coded));
  };
  set.for_each([&](ivec3 voxel, std::uint32_t rank) {
    if (!coder.ok()) return;
    if (!expected.empty()) return code(models.against_expected, rank, expected[rank]);
    // Predict from the preceding neighbour in x, else y, else z, else from the previous voxel.
    const std::array ranks{set.rank(voxel - ivec3(1, 0, 0)), set.rank(voxel - ivec3(0, 1, 0)),
                           set.rank(voxel - ivec3(0, 0, 1))};
    int found = 0, agreeing = 0;
    std::uint8_t near = rank > 0 ? densities[rank - 1] : std::uint8_t{0};
    for (const std::uint32_t other : ranks) {
      if (other == sim::BlockSet::kNone) continue;
      if (found++ == 0) near = densities[other];
      agreeing += densities[other] == near;
    }
    code(models.step[found == 0 ? 0u : agreeing == found ? 1u : 2u], rank, near);
  });
}

template <typename Coder>
void code_delays(Coder& coder, DelayModels& models, std::span<const std::uint32_t> order,
                 std::span<const std::uint8_t> group, std::vector<std::uint16_t>& delays) {
  if constexpr (Coder::kReads) delays.assign(order.size(), 0);
  std::array<std::uint16_t, 2> last{};
  std::array<bool, 2> none{};
  for (const std::uint32_t rank : order) {
    if (!coder.ok()) return;
    const std::size_t g = group[rank] != 0;
    std::uint16_t& delay = delays[rank];
    none[g] = coder.bit(models.none[2 * g + none[g]], delay == 0);
    if (none[g]) continue;
    const auto difference = static_cast<std::int16_t>(static_cast<std::uint16_t>(delay - last[g]));
    const std::int64_t coded = unfolded(coder.number(models.step[g], folded(difference)));
    delay = last[g] = static_cast<std::uint16_t>(last[g] + static_cast<std::uint16_t>(coded));
  }
}

template void code_blocks(Encoder&, BlockModels&, const BlockBounds&, ivec3, const Prediction&,
                          std::vector<VoxelBlock>&);
template void code_blocks(Decoder&, BlockModels&, const BlockBounds&, ivec3, const Prediction&,
                          std::vector<VoxelBlock>&);
template void code_densities(Encoder&, DensityModels&, const sim::BlockSet&, std::span<const std::uint8_t>,
                             std::vector<std::uint8_t>&);
template void code_densities(Decoder&, DensityModels&, const sim::BlockSet&, std::span<const std::uint8_t>,
                             std::vector<std::uint8_t>&);
template void code_delays(Encoder&, DelayModels&, std::span<const std::uint32_t>,
                          std::span<const std::uint8_t>, std::vector<std::uint16_t>&);
template void code_delays(Decoder&, DelayModels&, std::span<const std::uint32_t>,
                          std::span<const std::uint8_t>, std::vector<std::uint16_t>&);

}  // namespace brume::wire
