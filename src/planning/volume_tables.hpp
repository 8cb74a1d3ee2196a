// Tables that shaders read of a volume besides its grids: what its heat emits, and its transfer function.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "planning/frame_input.hpp"

namespace brume::planning {

/// shared::kVolumeColors colours, each of four half floats: what a grid emits, from a value of 0 to its
/// largest.
using GlowTable = std::vector<std::uint64_t>;
/// shared::kTransferEntries entries (transfer_table).
using TransferTable = std::vector<glm::vec4>;

GlowTable glow_table(const HeatInput& heat);

/// Null where a volume has none. Of the frames of a renderer two equal pointers are the same table.
struct VolumeTables {
  std::shared_ptr<const GlowTable> glow;
  std::shared_ptr<const TransferTable> transfer;
};

/// Makes the tables of a frame's volumes where they differ from the last frame's.
class VolumeTableCache {
 public:
  /// The tables of each volume, valid until the next call.
  std::span<const VolumeTables> update(std::span<const VolumeInput> volumes);

 private:
  /// All that the tables follow from.
  struct Source {
    glm::vec3 heat{0};  ///< Its kelvin, largest value and emission.
    TransferInput transfer;
    glm::vec3 albedo{0};
  };
  std::vector<Source> sources_;
  std::vector<VolumeTables> tables_;
};

}  // namespace brume::planning
