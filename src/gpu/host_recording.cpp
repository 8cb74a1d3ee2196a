#include "gpu/host_recording.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace brume::gpu {

/// Reads the times of the newest completed frame before its slot is used again.
HostRecording::Slot& HostRecording::free_slot(std::uint64_t completed) {
  Slot *free = nullptr, *newest = nullptr;
  for (Slot& slot : slots_) {
    if (slot.frame > completed) continue;
    if (!free || slot.frame < free->frame) free = &slot;
    if (!newest || slot.frame > newest->frame) newest = &slot;
  }
  if (newest && newest->frame > 0) newest->resources.timings().read_available(timings_);
  return free ? *free : slots_.emplace_back(context_);
}

void HostRecording::begin(VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
  BRUME_ASSERT(!recorder_, "a frame within another one");
  context_.begin_frame(frame, completed);
  Slot& slot = free_slot(completed);
  recorder_.emplace(context_, slot.resources);
  commands_ = commands;
  slot.frame = frame;
}

void HostRecording::end() {
  recorder_->record(commands_);
  recorder_.reset();
}

void HostRecording::run(const std::function<void(Recorder&)>& record) {
  BRUME_ASSERT(recorder_, "commands outside of a frame");
  record(*recorder_);
}

}  // namespace brume::gpu
