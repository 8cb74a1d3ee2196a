#include "passes/sphere_voxels.hpp"

#include <algorithm>
#include <limits>

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

gpu::Image voxel_image(gpu::Context& context, const glm::uvec3& size, VkFormat format) {
  return gpu::Image(context, gpu::storage_image_3d(size, format));
}

// An image of all voxels.
gpu::Image whole_image(gpu::Context& context, const glm::uvec3& size, VkFormat format) {
  const std::uint32_t most = context.limits().maxImageDimension3D;
  if (std::max({size.x, size.y, size.z}) > most)
    throw Error(ErrorCode::resource_limit, "the device has no images of more than " + std::to_string(most) +
                                               " voxels along an axis; make the tank smaller");
  return voxel_image(context, size, format);
}

}  // namespace

void upload_bytes(gpu::Context& context, gpu::CommandStream& stream, gpu::Buffer& buffer,
                  std::span<const std::byte> bytes) {
  constexpr std::size_t kPart = std::size_t{32} << 20;
  gpu::grow(context, buffer, std::max<std::size_t>(bytes.size(), 16));
  for (std::size_t done = 0; done < bytes.size(); done += kPart)
    stream.run([&](gpu::Recorder& recorder) {
      recorder.upload(buffer, done, bytes.subspan(done, std::min(kPart, bytes.size() - done)));
    });
}

TankVolume::TankVolume(gpu::Context& context, gpu::CommandStream& stream, const spheres::Tank& tank,
                       const spheres::BrickLists& lists)
    : size(tank.size),
      bricks(lists.bricks),
      wide_ids(tank.spheres.size() > shared::kMostShortIds),
      is_opaque(std::ranges::all_of(tank.colors, [](spheres::Color color) { return color >> 24 == 255; })),
      ids(voxel_image(context, glm::uvec3(1), VK_FORMAT_R32G32_UINT)),
      colors(voxel_image(context, glm::uvec3(1), VK_FORMAT_R32_UINT)) {
  upload_list(context, stream, spheres, tank.spheres);
  upload_list(context, stream, sphere_colors, tank.colors);
  upload_list(context, stream, brick_ranges, lists.ranges);
  upload_list(context, stream, brick_spheres, lists.spheres);
}

void TankVolume::add_ids(gpu::Context& context) {
  if (has_ids) return;
  ids = gpu::Image();
  ids =
      whole_image(context, glm::uvec3(size), wide_ids ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32G32_UINT);
  has_ids = true;
}

void TankVolume::add_colors(gpu::Context& context) {
  if (is_painted) return;
  colors = gpu::Image();
  colors = whole_image(context, glm::uvec3(size), VK_FORMAT_R32_UINT);
  is_painted = true;
}

SphereVoxelsPass::SphereVoxelsPass(gpu::Context& context)
    : narrow_(context, shaders::sphere_voxels_comp, {0u}),
      wide_(context, shaders::sphere_voxels_comp, {1u}),
      unused_narrow_(voxel_image(context, glm::uvec3(1), VK_FORMAT_R32G32_UINT)),
      unused_wide_(voxel_image(context, glm::uvec3(1), VK_FORMAT_R32G32B32A32_UINT)) {}

void SphereVoxelsPass::record(gpu::Recorder& recorder, const TankVolume& volume) const {
  const bool wide = volume.has_ids && volume.wide_ids;
  const gpu::ComputePipeline& pipeline = wide ? wide_ : narrow_;
  recorder.bind(
      pipeline,
      {{shared::kBindSpheres, gpu::read(volume.spheres)},
       {shared::kBindSphereColors, gpu::read(volume.sphere_colors)},
       {shared::kBindSphereBricks, gpu::read(volume.brick_ranges)},
       {shared::kBindSphereList, gpu::read(volume.brick_spheres)},
       {shared::kBindVoxelColors, gpu::stored(volume.colors)},
       {shared::kBindVoxelIds, gpu::stored(wide ? unused_narrow_ : volume.ids)},
       {shared::kBindWideVoxelIds, gpu::stored(wide ? volume.ids : unused_wide_)}},
      shared::SphereVoxelsParams{volume.size, volume.is_painted ? 1u : 0u, volume.has_ids ? 1u : 0u});
  // A workgroup per brick.
  recorder.dispatch_threads(pipeline, static_cast<std::uint32_t>(volume.bricks.x) * pipeline.group()[0],
                            static_cast<std::uint32_t>(volume.bricks.y) * pipeline.group()[1],
                            static_cast<std::uint32_t>(volume.bricks.z) * pipeline.group()[2]);
}

}  // namespace brume::passes
