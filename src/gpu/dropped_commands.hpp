// Commands that nothing executes, for what is made for the sake of its pipelines.
#pragma once

#include "gpu/recorder.hpp"

namespace brume::gpu {

class DroppedCommands : public CommandStream {
 public:
  /// `context` must outlive it.
  explicit DroppedCommands(Context& context) : context_(context), slot_(context, false) {}
  void run(const std::function<void(Recorder&)>& record) override {
    Recorder recorder(context_, slot_);
    record(recorder);
  }

 private:
  Context& context_;
  FrameSlot slot_;
};

}  // namespace brume::gpu
