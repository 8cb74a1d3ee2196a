// A slice atlas: grids of one box as the tiles of an image that any engine can sample, and a description that
// brings them back (docs/guides/volume-textures.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "grids/dense_grid.hpp"
#include "grids/grid.hpp"
#include "grids/limits.hpp"
#include "grids/slice_layout.hpp"

namespace brume::grids {

/// How a texel stores a value.
enum class AtlasDepth : std::uint32_t {
  unorm8,   ///< PNG of 8 bits.
  unorm16,  ///< PNG of 16 bits.
  half,     ///< OpenEXR of half floats.
  float32,  ///< OpenEXR of floats.
};
/// "unorm8".
const char* name_of(AtlasDepth depth);

inline constexpr std::size_t kMostAtlasChannels = 4;

/// The values that the least and the greatest number of a channel stand for, low < high. Floats store values
/// as they are, whatever the range.
struct AtlasRange {
  float low = 0, high = 1;
  bool operator==(const AtlasRange&) const = default;
};

struct SliceAtlas {
  SliceLayout layout;
  AtlasDepth depth = AtlasDepth::unorm8;
  /// Affine, from the space of the boxes to the world of the volume.
  glm::dmat4 world_from_box{1};
  /// One to kMostAtlasChannels, of the layout's size and one box; in R, G, B and A.
  std::vector<DenseGrid> channels;
  std::vector<AtlasRange> ranges;  ///< Range of each channel.
};

/// The range that holds all values of a grid: [0, 1] where it does, else from the least (at most 0) to the
/// greatest value.
AtlasRange range_of(const DenseGrid& grid);

/// nullopt: the atlas can be stored. Else what is wrong with it, such as a range that is so narrow beside its
/// values that floats cannot hold the steps of the depth.
std::optional<std::string> fault_of(const SliceAtlas& atlas);

/// The image of a description: "smoke.png" or "smoke.exr" of "smoke.json".
std::filesystem::path atlas_image_path(const std::filesystem::path& json, AtlasDepth depth,
                                       std::uint32_t level);

/// Writes `levels` images, [1, level_count], and then the description. Values beyond a range are clamped, NaN
/// becomes the lowest. Fails with bad_input for what fault_of names, and as write_file_atomic.
Result<void> save_slice_atlas(const std::filesystem::path& json, const SliceAtlas& atlas,
                              std::uint32_t levels = 1);

/// The layout that a JSON file describes; nullopt: it describes something else. Fails as load_slice_atlas.
Result<std::optional<SliceLayout>> read_slice_layout(const std::filesystem::path& json);

/// Whether a JSON file describes a slice atlas. Fails as load_slice_atlas for a file that is no JSON object.
Result<bool> is_slice_atlas(const std::filesystem::path& json);

/// The images that a description names, the whole resolution first. Fails with bad_input.
Result<std::vector<std::filesystem::path>> read_atlas_images(const std::filesystem::path& json);

/// Reads a description and the image that it names, which lies in the same folder. Fails with bad_input for
/// missing or damaged files and for an image that differs from its description, resource_limit beyond the
/// limits.
Result<SliceAtlas> load_slice_atlas(const std::filesystem::path& json, const GridLimits& limits = {});

/// The channels as grids of float32 whose voxels are all active.
GridFile to_grids(const SliceAtlas& atlas);

}  // namespace brume::grids
