// How much smoke a renderer holds where device memory is short.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "gpu/memory.hpp"

namespace brume::render {

/// Follows the limit of the memory and what was refused: smoke that has less room becomes coarser instead of
/// invisible (planning::ResidentSmoke). Room that was not wanted for long is given back; what is reserved is
/// never given back.
class SmokeBudget {
 public:
  /// `reserved`: bricks that always have room, > 0: as many as some volume::grown_atlas holds.
  explicit SmokeBudget(std::uint32_t reserved);

  /// Before a frame is planned. `room`: bricks of the atlas at present; `wanted`: how many of them the frame
  /// before had. Returns whether what the renderer holds must shrink to atlas_bricks().
  bool begin_frame(const gpu::Memory& memory, std::uint32_t room, std::uint32_t wanted);
  /// The frame was refused memory: the next try has no more bricks than there is room for, then half as many
  /// each time. False where there is nothing left to give up.
  bool reduce(std::uint32_t room);

  std::uint32_t most_bricks() const { return most_; }
  bool is_unlimited() const;
  /// Whether a frame takes no more than what is reserved, which no limit refuses.
  bool is_reserve() const { return most_ <= reserved_; }
  /// Bricks of the atlas that a frame begins with, after begin_frame and reduce.
  glm::ivec3 atlas_bricks() const { return atlas_; }

 private:
  bool has_spare_room(std::uint32_t room, std::uint32_t wanted);

  std::uint32_t reserved_, most_;
  glm::ivec3 atlas_{0};
  std::uint32_t frames_ = 0;  // since memory was refused
  VkDeviceSize limit_ = gpu::Memory::kNoLimit;
  std::uint32_t wanted_ = 0, wanted_frames_ = 0;  // the most of so many frames
};

}  // namespace brume::render
