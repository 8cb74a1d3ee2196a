#include "gpu/host_recording.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace brume::gpu {

/// A slot that the device is done with, for commands of the frame.
HostRecording::Slot& HostRecording::take_slot(bool is_frame) {
  const auto is_free = [&](const Slot& slot) { return slot.frame <= completed_; };
  const auto oldest = std::ranges::min_element(slots_, {}, &Slot::frame);
  Slot& slot =
      oldest != slots_.end() && is_free(*oldest) ? *oldest : slots_.emplace_back(context_, is_timed_);
  slot.frame = frame_;
  slot.is_frame = is_frame;
  return slot;
}

/// Keeps the times of the newest completed frame before its slot is used again.
void HostRecording::read_timings() {
  const Slot* newest = nullptr;
  for (const Slot& slot : slots_)
    if (slot.is_frame && slot.frame <= completed_ && (!newest || slot.frame > newest->frame)) newest = &slot;
  if (newest) newest->resources.timings().read_available(timings_);
}

void HostRecording::begin(VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
  BRUME_ASSERT(!commands_, "a frame within another one");
  context_.begin_frame(frame, completed);
  commands_ = commands;
  frame_ = frame;
  completed_ = completed;
  if (preparations_) preparations_->slot->frame = frame;
  if (is_timed_) read_timings();
}

Recorder& HostRecording::recorder() {
  BRUME_ASSERT(commands_, "commands outside of a frame");
  if (!own_) own_.emplace(context_, take_slot(true));
  return own_->recorder;
}

void HostRecording::run(const std::function<void(Recorder&)>& record) {
  BRUME_ASSERT(commands_ && !own_, "preparations outside of a frame, or behind its commands");
  if (!preparations_) preparations_.emplace(context_, take_slot(false));
  preparations_->recorder.collect(record);
}

void HostRecording::end() {
  for (std::optional<Part>* part : {&preparations_, &own_}) {
    if (!*part) continue;
    (*part)->recorder.record(commands_);
    (*part)->recorder.keep();
    part->reset();
  }
  commands_ = VK_NULL_HANDLE;
}

void HostRecording::discard() noexcept {
  own_.reset();
  if (preparations_) context_.defer_frame();
  commands_ = VK_NULL_HANDLE;
}

}  // namespace brume::gpu
