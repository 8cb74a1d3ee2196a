// Dense volumes as the slices of one image on the device, for what samples them without a march: particles
// and decals (docs/guides/volume-textures.md).
#pragma once

#include <span>
#include <vector>

#include "gpu/recorder.hpp"
#include "grids/dense_grid.hpp"
#include "grids/slice_layout.hpp"
#include "shared/slice_texture.h"

namespace brume::passes {

/// The most channels of a volume.
inline constexpr std::size_t kMostSliceChannels = 4;

/// Where volumes are in one image: each a slice atlas of its own below the one before.
struct SlicePacking {
  glm::uvec2 image_size{1};
  std::vector<grids::SliceLayout> layouts;  ///< Axes +x +y +z.
  std::vector<glm::uvec2> first_texels;     ///< The upper left corner of each.

  shared::SliceTexture texture(std::size_t volume) const;
};

/// Packs volumes of `sizes` voxels, each at least 1 along every axis. Tiles are in near-square images, and
/// have one texel of padding, so that no rounding of a device brings a texel of another tile into a sample.
/// Fails with resource_limit for an image with more than `most_texels` along an axis, or of more than
/// grids::kMostAtlasTexels.
Result<SlicePacking> pack_slices(std::span<const glm::uvec3> sizes, std::uint32_t most_texels);

class SliceTextures {
 public:
  /// No volumes.
  SliceTextures(gpu::Context& context, gpu::CommandStream& stream);
  /// Uploads volumes of one to four channels each, all of a volume of one size and box: r, g, b and a of its
  /// samples; those that it lacks are 0. Values are rounded to half floats and clamped to their range, NaN is
  /// 0. Fails as pack_slices, and with bad_input for a volume of another number of channels or of several
  /// sizes. Throws resource_limit when the device has too little memory.
  static Result<SliceTextures> create(gpu::Context& context, gpu::CommandStream& stream,
                                      std::span<const std::span<const grids::DenseGrid>> volumes);

  std::size_t size() const { return textures_.size(); }
  /// What lib/slice_texture.glsl reads of a volume, by its place in `volumes`.
  const shared::SliceTexture& operator[](std::size_t volume) const { return textures_[volume]; }
  std::span<const shared::SliceTexture> textures() const { return textures_; }
  /// RGBA16F; one texel of 0 without volumes. To be sampled linearly.
  const gpu::Image& image() const { return image_; }

 private:
  SliceTextures(gpu::Image image, std::vector<shared::SliceTexture> textures)
      : image_(std::move(image)), textures_(std::move(textures)) {}

  gpu::Image image_;
  std::vector<shared::SliceTexture> textures_;
};

}  // namespace brume::passes
