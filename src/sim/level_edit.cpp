#include "sim/level_edit.hpp"

#include <algorithm>
#include <bit>

namespace brume::sim {
namespace {

/// The bits of the block's voxels within [low, high).
std::uint64_t bits_within(glm::ivec3 block, glm::ivec3 low, glm::ivec3 high) {
  const glm::ivec3 first = glm::max(low - block * kBlockSize, glm::ivec3(0));
  const glm::ivec3 end = glm::min(high - block * kBlockSize, glm::ivec3(kBlockSize));
  if (first == glm::ivec3(0) && end == glm::ivec3(kBlockSize)) return ~std::uint64_t{0};
  std::uint64_t bits = 0;
  for (int z = first.z; z < end.z; ++z)
    for (int y = first.y; y < end.y; ++y)
      for (int x = first.x; x < end.x; ++x) bits |= std::uint64_t{1} << block_bit_index({x, y, z});
  return bits;
}

/// Calls visit(block) in order for each block that contains voxels of [low, high).
template <typename Visit>
void for_each_block(glm::ivec3 low, glm::ivec3 high, Visit visit) {
  if (glm::any(glm::greaterThanEqual(low, high))) return;
  const glm::ivec3 first = low >> 2, last = (high - 1) >> 2;
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) visit(glm::ivec3(x, y, z));
}

/// What of an edit within some bits is not already so.
EditBlock differing(const EditBlock& edit, const EditBlock& already, std::uint64_t within) {
  return {edit.at, edit.make_solid & ~already.make_solid & within,
          edit.make_free & ~already.make_free & within, edit.make_glass & ~already.make_glass & within,
          edit.make_grille & ~already.make_grille & within};
}

bool has_only_walls(const voxel::Solids& level) {
  return &level.sight == &level.smoke && &level.bodies == &level.smoke;
}

void apply_to(voxel::BitGrid& grid, const EditBlock& edit) {
  for (std::uint64_t bits = edit.make_solid | edit.make_free; bits != 0; bits &= bits - 1) {
    const int bit = std::countr_zero(bits);
    const glm::ivec3 v = voxel_of_block(glm::ivec3(edit.at), bit);
    if (grid.contains(v)) grid.set(v, edit.make_solid >> bit & 1);
  }
}

}  // namespace

std::uint64_t solid_bits(const voxel::BitGrid& grid, glm::ivec3 block) {
  const glm::ivec3 bricks = (grid.size() + voxel::kBrickSize - 1) / voxel::kBrickSize;
  const glm::ivec3 at = block >> 1;
  if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, bricks))) return 0;
  const voxel::BitGrid::Brick* brick = grid.find_brick(at);
  if (!brick) return 0;
  const glm::ivec3 corner = (block & 1) * kBlockSize;
  std::uint64_t bits = 0;
  for (int z = 0; z < kBlockSize; ++z) {
    const std::uint64_t slice = (*brick)[static_cast<std::size_t>(corner.z + z)];
    for (int y = 0; y < kBlockSize; ++y)
      bits |= (slice >> (corner.x + 8 * (corner.y + y)) & 0xf) << (4 * y + 16 * z);
  }
  return bits;
}

EditBlocks edit_box(const voxel::GridLayout& layout, glm::ivec3 low, glm::ivec3 high, bool solid) {
  low = glm::max(low, glm::ivec3(0));
  high = glm::min(high, layout.size);
  EditBlocks edits;
  for_each_block(low, high, [&](glm::ivec3 block) {
    const std::uint64_t bits = bits_within(block, low, high);
    edits.push_back({glm::i16vec3(block), solid ? bits : 0, solid ? 0 : bits});
  });
  return edits;
}

EditBlocks difference(const voxel::Solids& from, const voxel::Solids& to, glm::ivec3 low, glm::ivec3 high) {
  low = glm::max(low, glm::ivec3(0));
  high = glm::min(high, from.smoke.size());
  const bool of_walls = has_only_walls(from) && has_only_walls(to);
  EditBlocks edits;
  for_each_block(low, high, [&](glm::ivec3 block) {
    const std::uint64_t within = bits_within(block, low, high);
    EditBlock change;
    if (of_walls) {
      const std::uint64_t before = solid_bits(from.smoke, block), after = solid_bits(to.smoke, block);
      change = {glm::i16vec3(block), after & ~before & within, before & ~after & within};
    } else {
      change = differing(content_of(to, block), content_of(from, block), within);
    }
    if (change.all() != 0) edits.push_back(change);
  });
  return edits;
}

EditBlocks merge_edits(std::span<const EditBlock> earlier, std::span<const EditBlock> later) {
  EditBlocks merged;
  for_each_pair(earlier, later,
                [&](const EditBlock& a, const EditBlock& b) { merged.push_back(merge_edits(a, b)); });
  return merged;
}

EditBlock merge_edits(const EditBlock& earlier, const EditBlock& later) {
  const std::uint64_t kept = ~later.all();
  return {earlier.at, (earlier.make_solid & kept) | later.make_solid,
          (earlier.make_free & kept) | later.make_free, (earlier.make_glass & kept) | later.make_glass,
          (earlier.make_grille & kept) | later.make_grille};
}

EditBlocks effective_edits(const voxel::Solids& level, std::span<const EditBlock> edits) {
  EditBlocks effective;
  for (const EditBlock& edit : edits) {
    const glm::ivec3 block(edit.at);
    const std::uint64_t within = bits_within(block, glm::ivec3(0), level.smoke.size());
    const EditBlock change = differing(edit, content_of(level, block), within);
    if (change.all() != 0) effective.push_back(change);
  }
  return effective;
}

EditBlock content_of(const voxel::Solids& level, glm::ivec3 block) {
  const std::uint64_t smoke = solid_bits(level.smoke, block);
  const auto bits_of = [&](const voxel::BitGrid& grid) {
    return &grid == &level.smoke ? smoke : solid_bits(grid, block);
  };
  const std::uint64_t walls = bits_of(level.sight), bodies = bits_of(level.bodies);
  const std::uint64_t within = bits_within(block, glm::ivec3(0), level.smoke.size());
  return {glm::i16vec3(block), walls, ~bodies & within, smoke & ~walls, bodies & ~smoke};
}

void apply_edits(voxel::BitGrid& grid, std::span<const EditBlock> edits) {
  for (const EditBlock& edit : edits) apply_to(grid, edit.of_smoke());
}

void apply_edits(voxel::BitGrid& grid, voxel::RoleGrids& roles, std::span<const EditBlock> edits) {
  for (const EditBlock& edit : edits) {
    if (edit.make_glass != 0 && !roles.sight) roles.sight = grid;
    if (edit.make_grille != 0 && !roles.bodies) roles.bodies = grid;
    apply_to(grid, edit.of_smoke());
    if (roles.sight) apply_to(*roles.sight, edit.of_sight());
    if (roles.bodies) apply_to(*roles.bodies, edit.of_bodies());
  }
}

}  // namespace brume::sim
