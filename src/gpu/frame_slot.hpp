// What a recording needs on the device until its commands are done.
#pragma once

#include <deque>
#include <vector>

#include "core/frame_memory.hpp"
#include "gpu/resources.hpp"
#include "gpu/timings.hpp"

namespace brume::gpu {

/// What one frame in flight needs besides its command buffer: descriptors, staging memory, timestamps.
/// Reused when the device is done with the frame.
class FrameSlot {
 public:
  FrameSlot(Context& context, bool timed);
  ~FrameSlot();
  FrameSlot(const FrameSlot&) = delete;
  FrameSlot& operator=(const FrameSlot&) = delete;
  const Timings& timings() const { return timings_; }

 private:
  friend class Recorder;
  VkDescriptorPool add_descriptors();

  Context& context_;
  // Filled in order, as staging is.
  std::vector<VkDescriptorPool> descriptors_;
  std::size_t descriptors_index_ = 0;
  std::deque<Buffer> staging_;  // Filled in order; a new one is added when all are full.
  std::size_t staging_index_ = 0;
  std::uint32_t spare_frames_ = 0;  // in a row that left the last staging buffer empty
  VkDeviceSize staging_used_ = 0;
  Timings timings_;
  FrameMemory memory_;  // for lists of one recording
};

}  // namespace brume::gpu
