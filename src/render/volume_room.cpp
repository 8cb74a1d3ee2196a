#include "render/volume_room.hpp"

#include <algorithm>

#include "passes/brick_atlas.hpp"

namespace brume::render {

volumes::VolumeRoom volume_room(const gpu::Context& context, std::uint64_t memory_bytes) {
  constexpr std::uint64_t kBrickBytes = sizeof(std::uint16_t) * shared::kTexelsPerBrick;
  constexpr std::uint64_t kLeastBricks = 64, kLeastPages = 1u << 14;
  const int edge = static_cast<int>(context.limits().maxImageDimension3D) / shared::kBrickTexels;
  std::uint64_t bytes = std::min(context.info().memory_bytes / 4 * 3, context.max_allocation_bytes());
  if (memory_bytes > 0) bytes = std::min(bytes, memory_bytes);
  const std::uint64_t buffer_bytes = context.limits().maxStorageBufferRange;

  volumes::VolumeRoom room;
  room.bricks = std::min({bytes / kBrickBytes, passes::most_slots(edge), buffer_bytes / sizeof(glm::ivec3)});
  // Each volume's part of the atlas is rounded up by an eighth, for a small one by more; a layer may be
  // incomplete.
  room.bricks = room.bricks / 7 * 6;
  room.bricks -= std::min<std::uint64_t>(room.bricks / 4, 2 * shared::kMaxVolumes * passes::kVolumeSlotStep);
  room.bricks = std::max(room.bricks, kLeastBricks);
  room.pages = std::max(std::min(buffer_bytes, bytes) / sizeof(std::uint32_t), kLeastPages);
  room.pages -= room.pages / 8;
  return room;
}

}  // namespace brume::render
