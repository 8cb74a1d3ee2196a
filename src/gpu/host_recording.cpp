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
  view_ = views_.begin();
  if (view_->preparations) view_->preparations->slot->frame = frame;
  if (is_timed_) read_timings();
}

Recorder& HostRecording::recorder() {
  BRUME_ASSERT(commands_, "commands outside of a frame");
  if (!view_->own) view_->own.emplace(context_, take_slot(true));
  return view_->own->recorder;
}

void HostRecording::run(const std::function<void(Recorder&)>& record) {
  BRUME_ASSERT(commands_ && !view_->own, "preparations outside of a frame, or behind its commands");
  if (!view_->preparations) view_->preparations.emplace(context_, take_slot(false));
  view_->preparations->recorder.collect(record);
}

void HostRecording::begin_view() {
  BRUME_ASSERT(commands_, "a view outside of a frame");
  if (std::next(view_) == views_.end()) views_.emplace_back();
  ++view_;
}

void HostRecording::end() {
  for (View& view : views_)
    for (std::optional<Part>* part : {&view.preparations, &view.own}) {
      if (!*part) continue;
      (*part)->recorder.record(commands_);
      (*part)->recorder.keep();
      part->reset();
    }
  view_ = views_.begin();
  commands_ = VK_NULL_HANDLE;
}

void HostRecording::discard() noexcept {
  for (View& view : views_) {
    view.own.reset();
    if (has_several_views()) view.preparations.reset();
  }
  view_ = views_.begin();
  if (view_->preparations) context_.defer_frame();
  commands_ = VK_NULL_HANDLE;
}

}  // namespace brume::gpu
