// Volumes of a timeline that are sampled without a march: for decals, and for particles.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "grids/dense_grid.hpp"
#include "scene/timeline.hpp"

namespace brume::scenario {

/// Where the volume of a decal is, or the masks of a volume.
struct SliceVolume {
  std::size_t volume = 0;      ///< In SliceVolumes::volumes.
  glm::mat4 file_from_box{1};  ///< From the box of its grids to the world of its file.
  glm::vec3 middle{0};         ///< About the middle of the mesh that occludes, in the box of its grids.
  float radius = 0;            ///< About how far the mesh reaches from there; 0: unknown.
};

struct SliceVolumes {
  std::shared_ptr<const grids::DenseVolumes> volumes;  ///< Null: none.
  std::vector<SliceVolume> of_decals;  ///< By decal. Two channels: occlusion of what faces up, down.
  /// By volume; each mask is a channel. Empty: the volume has no masks, or is too large for an image of
  /// slices.
  std::vector<std::optional<SliceVolume>> of_volumes;
};

/// Loads the volumes of all decals, and the masks of all volumes. Fails as grids::load_grid_file, and with
/// bad_input for grids that do not exist, and for decals and volumes with particles that are sequences or
/// larger than an image of slices.
Result<SliceVolumes> load_slice_volumes(const scene::Timeline& timeline);

/// Every file that load_slice_volumes reads.
std::vector<std::filesystem::path> slice_files_of(const scene::Timeline& timeline);

/// world_from_file of a decal at a time [s]: moved by its carrier.
glm::mat4 world_from_file(std::span<const scene::Carrier> carriers, const scene::DecalOptions& decal,
                          double seconds);

}  // namespace brume::scenario
