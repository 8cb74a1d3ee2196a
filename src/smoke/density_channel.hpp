// The density channel of the smoke volume: RG8 texels written from the densities of single voxels and from
// what is solid. A voxel at a brick's face has copies in the aprons of up to seven other bricks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "smoke/smoke_brick.hpp"
#include "smoke/voxel_window.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::smoke {

/// The channel of density in the smoke's volume, of Texel.
inline constexpr volume::ChannelId kDensityChannel{0};

/// Marks what it writes dirty; SparseVolume::sort_dirty has to follow. Texels of a brick are right when the
/// densities of the 27 bricks around it are set and fill_new was called for it.
class DensityChannel {
 public:
  /// `volume` must outlive it.
  explicit DensityChannel(volume::SparseVolume& volume) : volume_(volume) {}

  /// The brick of a slot is new: its voxels hold 0.
  void add(std::uint32_t slot);
  /// The brick of a slot goes: sets its voxels to 0, in the aprons around too; returns those that were not.
  /// To be called before the volume releases the slot.
  BrickBits remove(std::uint32_t slot);
  /// Sets the densities of a brick, in the aprons around too; returns the voxels that changed.
  BrickBits set_densities(std::uint32_t slot, const BrickDensities& densities);
  /// Sets which voxels of a brick and its apron are solid.
  void set_solid(std::uint32_t slot, const VoxelWindow& solid);
  /// Writes all densities into the texels of a brick that was added; nothing where that was done.
  void fill_new(std::uint32_t slot);
  /// Follows the volume's slot count after releases.
  void shrink();

  /// By slot * kVoxelsPerBrick + local_voxel.
  std::span<const std::uint8_t> densities() const { return densities_; }
  std::uint64_t bytes() const { return densities_.capacity() + is_new_.capacity() / 8; }

 private:
  std::span<Texel, shared::kTexelsPerBrick> texels(std::uint32_t slot) {
    return volume_.texels<Texel>(kDensityChannel, slot);
  }
  void copy_to_texels(std::uint32_t slot, const BrickBits& voxels);

  volume::SparseVolume& volume_;
  std::vector<std::uint8_t> densities_;  // kVoxelsPerBrick a slot
  std::vector<bool> is_new_;             // by slot: whether its texels are to be filled
};

}  // namespace brume::smoke
