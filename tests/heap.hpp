// The heap of a test program: replaces operator new, in the libraries too. For one source of a program.
#pragma once

#include <cstdlib>
#include <new>

namespace brume {

/// Allocations on the heap of this thread, while they are counted.
struct Heap {
  static inline thread_local bool counts = false;
  static inline thread_local int allocations = 0, fails_at = 0;  // 0: none
};

inline void* allocate_or_null(std::size_t size, std::size_t alignment) {
  if (Heap::counts && ++Heap::allocations == Heap::fails_at) return nullptr;
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}
inline void* allocate(std::size_t size, std::size_t alignment) {
  if (void* const memory = allocate_or_null(size, alignment)) return memory;
  throw std::bad_alloc();
}

}  // namespace brume

// All of them, so that none is left to a sanitizer, whose memory `free` does not take.
void* operator new(std::size_t size) {
  return brume::allocate(size, 16);
}
void* operator new[](std::size_t size) {
  return brume::allocate(size, 16);
}
void* operator new(std::size_t size, std::align_val_t a) {
  return brume::allocate(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return brume::allocate(size, static_cast<std::size_t>(a));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return brume::allocate_or_null(size, 16);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return brume::allocate_or_null(size, 16);
}
void* operator new(std::size_t size, std::align_val_t a, const std::nothrow_t&) noexcept {
  return brume::allocate_or_null(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a, const std::nothrow_t&) noexcept {
  return brume::allocate_or_null(size, static_cast<std::size_t>(a));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
  std::free(memory);
}
