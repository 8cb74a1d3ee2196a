// A tank of spheres on the device: the spheres, which of them touch each brick and voxel, and painted voxels.
#pragma once

#include <span>
#include <vector>

#include "gpu/recorder.hpp"
#include "shared/tank.h"
#include "spheres/brick_lists.hpp"
#include "spheres/tank.hpp"

namespace brume::passes {

/// Makes a buffer at least as large as a list and uploads it, in parts, so that staging memory stays small.
/// Not while the device uses the buffer. Throws resource_limit.
void upload_bytes(gpu::Context& context, gpu::CommandStream& stream, gpu::Buffer& buffer,
                  std::span<const std::byte> bytes);
template <typename Element>
void upload_list(gpu::Context& context, gpu::CommandStream& stream, gpu::Buffer& buffer,
                 const std::vector<Element>& list) {
  upload_bytes(context, stream, buffer, std::as_bytes(std::span(list)));
}

/// Buffers and images of a tank.
class TankVolume {
 public:
  /// Uploads the spheres of a tank. Throws resource_limit when the device has too little memory.
  TankVolume(gpu::Context& context, gpu::CommandStream& stream, const spheres::Tank& tank,
             const spheres::BrickLists& lists);

  /// Make room for ids, and for the colours of voxels: SphereVoxelsPass must then follow. When the device is
  /// done with the volume. Throw resource_limit when the device has too little memory or no images of this
  /// size.
  void add_ids(gpu::Context& context);
  void add_colors(gpu::Context& context);

  glm::ivec3 size{1}, bricks{1};
  bool wide_ids = false;                     ///< Ids have 32 bits instead of 16.
  bool is_opaque = true;                     ///< All spheres are opaque.
  bool has_ids = false, is_painted = false;  ///< `ids` and `colors` have a texel per voxel.
  gpu::Buffer spheres;                       ///< vec4 each: middle and radius.
  gpu::Buffer sphere_colors;                 ///< spheres::Color each.
  gpu::Buffer brick_ranges;                  ///< shared::SphereBrick each.
  gpu::Buffer brick_spheres;                 ///< Indices of spheres, of all bricks.
  gpu::Image ids;                            ///< shared/spheres.h; two or four words a voxel.
  gpu::Image colors;                         ///< spheres::Color per voxel, 0 where no sphere is.
};

/// Fills the images of a TankVolume.
class SphereVoxelsPass {
 public:
  explicit SphereVoxelsPass(gpu::Context& context);
  void record(gpu::Recorder& recorder, const TankVolume& volume) const;

 private:
  gpu::ComputePipeline narrow_, wide_;
  gpu::Image unused_narrow_, unused_wide_;
};

}  // namespace brume::passes
