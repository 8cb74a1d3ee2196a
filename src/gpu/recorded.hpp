// What the device holds, as far as the commands that make it so will be executed.
#pragma once

#include <utility>

#include "gpu/context.hpp"

namespace brume::gpu {

/// A value that commands of a recording change. Where that recording is dropped, the value is again the one
/// that it was before: nobody has to roll it back.
template <typename T>
class Recorded {
 public:
  Recorded() = default;
  explicit Recorded(T value) : now_(std::move(value)) {}

  /// Whether the recording that changed it last was dropped.
  bool is_dropped(const Context& context) const { return context.is_dropped(recording_); }
  const T& get(const Context& context) const { return is_dropped(context) ? before_ : now_; }
  /// To be changed by commands of a recording, the only one at a time.
  T& change(const Context& context, RecordingId recording) {
    if (recording_ == recording) return now_;
    settle(context);
    before_ = now_;
    recording_ = recording;
    return now_;
  }
  /// To be changed outside of recordings, at once.
  T& change(const Context& context) {
    settle(context);
    recording_ = RecordingId{};
    return now_;
  }

 private:
  void settle(const Context& context) {
    if (is_dropped(context)) now_ = before_;
  }

  T now_{}, before_{};
  RecordingId recording_{};
};

}  // namespace brume::gpu
