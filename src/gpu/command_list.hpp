// Commands that are recorded all at once.
#pragma once

#include <algorithm>
#include <new>
#include <span>
#include <type_traits>

#include "core/frame_memory.hpp"
#include "gpu/functions.hpp"

namespace brume::gpu {

/// Collects commands in memory of a frame. All that can fail, such as descriptors and staging memory, is done
/// while they are collected; to record them cannot fail.
class CommandList {
 public:
  /// `memory` outlives the list, and is not reset before.
  explicit CommandList(FrameMemory& memory) : memory_(memory) {}
  CommandList(const CommandList&) = delete;
  CommandList& operator=(const CommandList&) = delete;

  /// Adds `command(vk, commands)`, which is called by `record`. What it points to is `kept`, or lives as long
  /// as the list.
  template <typename Command>
  void add(const Command& command) {
    static_assert(std::is_trivially_copyable_v<Command> && std::is_trivially_destructible_v<Command>);
    void* const own = memory_.allocate(sizeof command, alignof(Command));
    auto* const node = static_cast<Node*>(memory_.allocate(sizeof(Node), alignof(Node)));
    new (own) Command(command);
    new (node) Node{[](const void* command_at, const Functions& vk, VkCommandBuffer commands) {
                      (*static_cast<const Command*>(command_at))(vk, commands);
                    },
                    own, nullptr};
    (last_ ? last_->next : first_) = node;
    last_ = node;
  }
  /// Zeros, to be set, for commands that point to them.
  template <typename T>
  std::span<T> room(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count == 0) return {};
    auto* const own = static_cast<T*>(memory_.allocate(count * sizeof(T), alignof(T)));
    std::uninitialized_value_construct_n(own, count);
    return {own, count};
  }
  /// A copy of values, for commands that point to them.
  template <typename T>
  std::span<const T> kept(std::span<const T> values) {
    const std::span<T> own = room<T>(values.size());
    std::ranges::copy(values, own.begin());
    return own;
  }
  /// Where the list ends at present.
  class End;
  End end() const;
  /// Removes what was added since.
  void cut(const End& end);
  void record(const Functions& vk, VkCommandBuffer commands) const {
    for (const Node* node = first_; node; node = node->next) node->call(node->command, vk, commands);
  }

 private:
  struct Node {
    void (*call)(const void* command, const Functions& vk, VkCommandBuffer commands);
    const void* command;
    Node* next;
  };
  FrameMemory& memory_;
  Node *first_ = nullptr, *last_ = nullptr;
};

class CommandList::End {
  friend class CommandList;
  explicit End(Node* last) : last_(last) {}
  Node* last_;
};

inline CommandList::End CommandList::end() const {
  return End(last_);
}

inline void CommandList::cut(const End& end) {
  last_ = end.last_;
  (last_ ? last_->next : first_) = nullptr;
}

}  // namespace brume::gpu
