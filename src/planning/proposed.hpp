// What a cache knows, and what it will know once the frame that is being planned is recorded.
#pragma once

#include <utility>

namespace brume::planning {

/// A plan writes its proposal; only `commit` makes it the state that later plans follow from. A plan whose
/// frame was never recorded therefore leaves nothing behind.
template <typename State>
class Proposed {
 public:
  /// The state of the last frame that was committed.
  const State& now() const { return now_; }
  /// The state of the last plan, whatever became of it.
  const State& latest() const { return is_proposed_ ? next_ : now_; }
  /// A copy of now(), to be changed by the plan. An earlier proposal is dropped. Lists keep their memory.
  State& propose() {
    next_ = now_;
    is_proposed_ = true;
    return next_;
  }
  /// The frame was recorded.
  void commit() {
    if (is_proposed_) std::swap(now_, next_);
    is_proposed_ = false;
  }
  /// Changes the state at once: what the device holds changed outside of a frame.
  State& reset() {
    is_proposed_ = false;
    return now_;
  }

 private:
  State now_, next_;
  bool is_proposed_ = false;
};

}  // namespace brume::planning
