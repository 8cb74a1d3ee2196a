#include "smoke/density_channel.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace brume::smoke {
namespace {

/// The texel of each voxel of a brick.
constexpr std::array<std::uint16_t, kVoxelsPerBrick> make_texels_of_voxels() {
  std::array<std::uint16_t, kVoxelsPerBrick> texels{};
  for (unsigned i = 0; i < kVoxelsPerBrick; ++i)
    texels[i] = static_cast<std::uint16_t>((i & 7) + 1 + 10 * ((i >> 3 & 7) + 1) + 100 * ((i >> 6) + 1));
  return texels;
}
constexpr auto kTexelOfVoxel = make_texels_of_voxels();

/// For each of the 27 bricks around, which voxels of this brick are among its texels: all of them for the
/// brick itself, else the texels of a face, an edge or a corner.
constexpr std::array<BrickBits, 27> make_shared_voxels() {
  constexpr std::uint64_t kColumn0 = 0x0101010101010101u, kRow0 = 0xff;
  std::array<BrickBits, 27> shared{};
  for (std::size_t i = 0; i < 27; ++i) {
    const std::size_t x = i % 3, y = i / 3 % 3, z = i / 9;  // 1: no step along the axis
    std::uint64_t layer = ~std::uint64_t{0};
    if (x != 1) layer &= x == 0 ? kColumn0 : kColumn0 << 7;
    if (y != 1) layer &= y == 0 ? kRow0 : kRow0 << 56;
    for (std::size_t k = z == 2 ? 7 : 0; k < (z == 0 ? 1 : 8); ++k) shared[i][k] = layer;
  }
  return shared;
}
constexpr auto kSharedVoxels = make_shared_voxels();

}  // namespace

void DensityChannel::add(std::uint32_t slot) {
  if (slot >= is_new_.size()) {
    densities_.resize(std::size_t{kVoxelsPerBrick} * (slot + 1));
    is_new_.resize(slot + 1);
  }
  is_new_[slot] = true;
}

BrickBits DensityChannel::remove(std::uint32_t slot) {
  const BrickBits changed = set_densities(slot, BrickDensities{});
  is_new_[slot] = false;
  return changed;
}

BrickBits DensityChannel::set_densities(std::uint32_t slot, const BrickDensities& densities) {
  std::uint8_t* held = densities_.data() + std::size_t{slot} * kVoxelsPerBrick;
  BrickBits changed{};
  for (std::size_t z = 0; z < 8; ++z)
    if (std::memcmp(held + 64 * z, densities.data() + 64 * z, 64) != 0)
      for (std::size_t i = 0; i < 64; ++i)
        changed[z] |= std::uint64_t{held[64 * z + i] != densities[64 * z + i]} << i;
  if (changed == BrickBits{}) return changed;
  std::memcpy(held, densities.data(), kVoxelsPerBrick);
  copy_to_texels(slot, changed);
  return changed;
}

/// Copies the densities of these voxels of a brick into its texels and into the aprons around it.
void DensityChannel::copy_to_texels(std::uint32_t slot, const BrickBits& voxels) {
  const volume::NeighbourSlots slots = volume_.slots_around(volume_.brick_of(slot));
  const std::uint8_t* densities = densities_.data() + std::size_t{slot} * kVoxelsPerBrick;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    // New bricks are filled later, as a whole.
    const std::uint32_t to = slots[i];
    if (to == volume::SparseVolume::kNoSlot || is_new_[to]) continue;
    const int n = static_cast<int>(i);
    const int shift =
        -8 * (n % 3 - 1 + 10 * (n / 3 % 3 - 1 + 10 * (n / 9 - 1)));  // from our texels to theirs
    const auto into = texels(to);
    bool any = false;
    for (std::size_t z = 0; z < 8; ++z)
      for (std::uint64_t bits = voxels[z] & kSharedVoxels[i][z]; bits != 0; bits &= bits - 1) {
        const std::size_t voxel = 64 * z + static_cast<std::size_t>(std::countr_zero(bits));
        into[static_cast<std::size_t>(kTexelOfVoxel[voxel] + shift)].density = densities[voxel];
        any = true;
      }
    if (any) volume_.mark_dirty(kDensityChannel, to);
  }
}

void DensityChannel::set_solid(std::uint32_t slot, const VoxelWindow& solid) {
  const auto into = texels(slot);
  bool changed = false;
  std::size_t texel = 0;
  for (std::size_t z = 0; z < 10; ++z)
    for (std::size_t y = 0; y < 10; ++y)
      for (unsigned x = 0; x < 10; ++x, ++texel) {
        const std::uint8_t free = (solid[z + 1][y + 1] >> (x + 1) & 1) != 0 ? 0 : 255;
        changed |= into[texel].free != free;
        into[texel].free = free;
      }
  if (changed) volume_.mark_dirty(kDensityChannel, slot);
}

void DensityChannel::fill_new(std::uint32_t slot) {
  if (!is_new_[slot]) return;
  is_new_[slot] = false;
  const volume::NeighbourSlots slots = volume_.slots_around(volume_.brick_of(slot));
  const auto into = texels(slot);
  std::size_t texel = 0;
  for (int z = -1; z < 9; ++z)
    for (int y = -1; y < 9; ++y)
      for (int x = -1; x < 9; ++x, ++texel) {
        const glm::ivec3 local(x, y, z), brick = (local >> 3) + 1;
        const std::uint32_t from = slots[static_cast<std::size_t>(brick.x + 3 * brick.y + 9 * brick.z)];
        into[texel].density = from == volume::SparseVolume::kNoSlot
                                  ? std::uint8_t{0}
                                  : densities_[std::size_t{from} * kVoxelsPerBrick + local_voxel(local)];
      }
}

void DensityChannel::shrink() {
  densities_.resize(std::size_t{kVoxelsPerBrick} * volume_.slot_count());
  is_new_.resize(volume_.slot_count());
}

}  // namespace brume::smoke
