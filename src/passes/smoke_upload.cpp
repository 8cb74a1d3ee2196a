#include "passes/smoke_upload.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/error.hpp"

namespace brume::passes {
namespace {

constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

/// Makes the buffer at least this large, in powers of two so that growth is rare.
void grow(gpu::Context& context, gpu::Buffer& buffer, std::size_t bytes) {
  if (buffer && buffer.size() >= bytes) return;
  if (bytes > context.limits().maxStorageBufferRange) {
    throw Error(ErrorCode::resource_limit, "the smoke needs a buffer of " + std::to_string(bytes) +
                                               " bytes, the device takes " +
                                               std::to_string(context.limits().maxStorageBufferRange) +
                                               "; use larger voxels or less smoke");
  }
  const std::size_t size = std::min<std::size_t>(std::bit_ceil(std::max<std::size_t>(bytes, 256)),
                                                 context.limits().maxStorageBufferRange);
  buffer = gpu::Buffer(context, size, kUsage);
}

gpu::Image make_atlas(gpu::Context& context, glm::ivec3 bricks, VkFormat format, VkImageUsageFlags usage) {
  const glm::uvec3 texels = glm::uvec3(bricks) * static_cast<std::uint32_t>(shared::kBrickTexels);
  const std::uint32_t limit = context.limits().maxImageDimension3D;
  if (texels.x > limit || texels.y > limit || texels.z > limit) {
    throw Error(ErrorCode::resource_limit,
                "the smoke needs more bricks than the device's 3D textures hold; use "
                "larger voxels or less smoke");
  }
  gpu::ImageInfo info;
  info.format = format;
  info.size = texels;
  info.three_dimensional = true;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | usage;
  return gpu::Image(context, info);
}

glm::ivec3 slot_position(glm::ivec3 atlas, std::uint32_t slot) {
  const auto s = static_cast<std::int32_t>(slot);
  return {s % atlas.x, s / atlas.x % atlas.y, s / (atlas.x * atlas.y)};
}

std::vector<glm::ivec3> bricks_of_slots(const sim::SmokeVolume& volume) {
  std::vector<glm::ivec3> bricks(volume.slot_count());
  const auto pages = volume.page_table();
  const glm::ivec3 size = volume.frame().window_size;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    if (pages[i] == 0) continue;
    const auto at = static_cast<std::int32_t>(i);
    bricks[pages[i] - 1] =
        volume.frame().window_origin + glm::ivec3(at % size.x, at / size.x % size.y, at / (size.x * size.y));
  }
  return bricks;
}

}  // namespace

SmokeUpload::SmokeUpload(gpu::Context& context) : context_(context) {
  for (gpu::Buffer* buffer : {&resources_.pages, &resources_.cells, &resources_.boundary, &resources_.corners,
                              &resources_.slot_bricks}) {
    grow(context, *buffer, 1);
  }
  resources_.density =
      make_atlas(context, glm::ivec3(1), VK_FORMAT_R8G8_UNORM, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  resources_.inscatter = make_atlas(context, glm::ivec3(1), VK_FORMAT_R16G16B16A16_SFLOAT,
                                    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
}

void SmokeUpload::reserve(const sim::SmokeVolume& volume) {
  if (volume.structure_generation() == uploaded_generation_ || volume.slot_count() == 0) return;
  const std::size_t slots = volume.slot_count();
  grow(context_, resources_.pages, volume.page_table().size_bytes());
  grow(context_, resources_.cells, slots * shared::kCellsPerBrick * sizeof(std::uint32_t));
  grow(context_, resources_.boundary, volume.boundary_cells().size_bytes());
  grow(context_, resources_.corners, volume.corner_sets().size_bytes());
  grow(context_, resources_.slot_bricks, slots * sizeof(glm::ivec3));
  const glm::ivec3 bricks = volume.frame().atlas_bricks;
  if (resources_.density.info().size == glm::uvec3(bricks) * static_cast<std::uint32_t>(shared::kBrickTexels))
    return;
  resources_.density = make_atlas(context_, bricks, VK_FORMAT_R8G8_UNORM, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  resources_.inscatter = make_atlas(context_, bricks, VK_FORMAT_R16G16B16A16_SFLOAT,
                                    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
}

void SmokeUpload::record_structure(gpu::Recorder& recorder, const sim::SmokeVolume& volume) {
  std::vector<std::uint32_t> cells;
  cells.reserve(static_cast<std::size_t>(volume.slot_count()) * shared::kCellsPerBrick);
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
    const auto of_slot = volume.cells(slot);
    cells.insert(cells.end(), of_slot.begin(), of_slot.end());
  }
  const std::vector<glm::ivec3> slot_bricks = bricks_of_slots(volume);
  recorder.upload(resources_.pages, 0, std::as_bytes(volume.page_table()));
  recorder.upload(resources_.cells, 0, std::as_bytes(std::span(cells)));
  recorder.upload(resources_.boundary, 0, std::as_bytes(volume.boundary_cells()));
  recorder.upload(resources_.slot_bricks, 0, std::as_bytes(std::span(slot_bricks)));
}

bool SmokeUpload::record(gpu::Recorder& recorder, const sim::SmokeVolume& volume) {
  const bool had_smoke = resources_.slot_count > 0;
  resources_.slot_count = volume.slot_count();
  if (volume.slot_count() == 0) return had_smoke;
  if (volume.revision() == uploaded_revision_) return false;
  const bool new_structure = volume.structure_generation() != uploaded_generation_;
  // What is dirty is only that since the revision before: whoever missed one takes everything.
  const bool all = new_structure || volume.revision() != uploaded_revision_ + 1;
  if (new_structure) record_structure(recorder, volume);
  uploaded_generation_ = volume.structure_generation();
  uploaded_revision_ = volume.revision();

  const bool corners = all || volume.corner_sets_dirty();
  if (corners) recorder.upload(resources_.corners, 0, std::as_bytes(volume.corner_sets()));
  std::vector<std::uint32_t> slots(volume.dirty_slots().begin(), volume.dirty_slots().end());
  if (all) {
    slots.resize(volume.slot_count());
    std::iota(slots.begin(), slots.end(), 0u);
  }
  std::vector<gpu::Recorder::Region> regions;
  regions.reserve(slots.size());
  for (const std::uint32_t slot : slots) {
    regions.push_back({std::as_bytes(volume.texels(slot)),
                       slot_position(volume.frame().atlas_bricks, slot) * shared::kBrickTexels,
                       glm::uvec3(static_cast<std::uint32_t>(shared::kBrickTexels))});
  }
  recorder.upload(resources_.density, regions);
  return corners || !regions.empty();
}

}  // namespace brume::passes
