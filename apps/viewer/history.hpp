// Undo and redo: the states that an editor went through.
#pragma once

#include <cstddef>
#include <deque>
#include <utility>

namespace brume::viewer {

/// A line of states. One of them is the present; those before it can be undone, those after it redone.
template <typename State>
class History {
 public:
  static constexpr std::size_t kMost = 200;  ///< States; the oldest ones are dropped.

  explicit History(State first) { states_.push_back(std::move(first)); }

  const State& present() const { return states_[at_]; }
  /// A new present after the old one; what could be redone is dropped.
  void add(State state) {
    states_.resize(at_ + 1, states_.front());
    states_.push_back(std::move(state));
    if (states_.size() > kMost) states_.pop_front();
    at_ = states_.size() - 1;
  }
  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < states_.size(); }
  /// The state before the present, which it becomes. Only if can_undo().
  const State& undo() { return states_[--at_]; }
  /// The state after the present, which it becomes. Only if can_redo().
  const State& redo() { return states_[++at_]; }

 private:
  std::deque<State> states_;
  std::size_t at_ = 0;
};

}  // namespace brume::viewer
