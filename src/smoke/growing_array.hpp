// An array that one thread lengthens while others read it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace brume::smoke {

/// Entries begin as zero bytes. One thread at a time may change it. Others may read an entry once they know,
/// by some synchronization, that it was written: they read it through a pointer taken after that, which stays
/// valid until forget_old.
template <typename T>
class GrowingArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  const T* data() const { return data_.load(std::memory_order_acquire); }
  T& operator[](std::size_t i) { return held_[i]; }
  std::size_t size() const { return size_; }
  std::span<const T> entries() const { return {data(), size_}; }

  /// At least `size` entries.
  void grow(std::size_t size) {
    if (size > capacity_) {
      const std::size_t capacity = std::max({size, 2 * capacity_, kFirstBytes / sizeof(T)});
      Entries longer(static_cast<T*>(std::calloc(capacity, sizeof(T))));
      if (!longer) throw std::bad_alloc();
      std::copy_n(held_.get(), size_, longer.get());
      old_.push_back(std::exchange(held_, std::move(longer)));
      capacity_ = capacity;
      data_.store(held_.get(), std::memory_order_release);
    }
    size_ = std::max(size_, size);
  }
  /// Frees what the array had before it was lengthened: nobody reads it any longer.
  void forget_old() { old_.clear(); }
  /// No entries. Nobody reads.
  void clear() {
    old_.clear();
    held_.reset();
    data_.store(nullptr, std::memory_order_release);
    size_ = capacity_ = 0;
  }
  std::uint64_t bytes() const { return size_ * sizeof(T); }

 private:
  /// Room from the start: pages that nobody writes cost nothing, while a copy of many is slow.
  static constexpr std::size_t kFirstBytes = std::size_t{16} << 20;
  struct Free {
    void operator()(T* entries) const { std::free(entries); }
  };
  using Entries = std::unique_ptr<T[], Free>;

  Entries held_;
  std::atomic<const T*> data_{nullptr};
  std::size_t size_ = 0, capacity_ = 0;
  std::vector<Entries> old_;
};

}  // namespace brume::smoke
