// What C++20 has and the C++ library of Emscripten 3.1.6 (libc++ 13, in Debian 12) lacks: each source of the
// simulation is compiled with it (examples/web/CMakeLists.txt). A later library has all of it, and then this
// is empty.
#pragma once

#include <version>
#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 15000

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <functional>
#include <iterator>
#include <memory>
#include <thread>
#include <type_traits>
#include <utility>

// NOLINTBEGIN(cert-dcl58-cpp): these names are the standard's.
namespace std {

template <typename To, typename From>
To bit_cast(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> && is_trivially_copyable_v<From>);
  To to;
  memcpy(&to, &from, sizeof to);
  return to;
}

/// A thread that is joined before it ends; without stop tokens.
class jthread : public thread {
 public:
  using thread::thread;
  jthread(jthread&&) noexcept = default;
  jthread& operator=(jthread&&) = delete;
  ~jthread() {
    if (joinable()) join();
  }
};

/// Nine digits, which give the same float again, but are not the fewest.
inline to_chars_result to_chars(char* first, char* last, float value) {
  char digits[32];
  const auto length = snprintf(digits, sizeof digits, "%.9g", static_cast<double>(value));
  if (length > last - first) return {last, errc::value_too_large};
  return {copy(digits, digits + length, first), errc{}};
}

template <typename Array>
unique_ptr<Array> make_unique_for_overwrite(size_t count) {
  return unique_ptr<Array>(new remove_extent_t<Array>[count]);
}

template <typename T>
class atomic_ref {
 public:
  explicit atomic_ref(T& value) : value_(&value) {}
  T load(memory_order = memory_order_seq_cst) const { return __atomic_load_n(value_, __ATOMIC_SEQ_CST); }
  void store(T value, memory_order = memory_order_seq_cst) const {
    __atomic_store_n(value_, value, __ATOMIC_SEQ_CST);
  }
  T fetch_and(T other, memory_order = memory_order_seq_cst) const {
    return __atomic_fetch_and(value_, other, __ATOMIC_SEQ_CST);
  }

 private:
  T* value_;
};

namespace ranges {

struct Itself {
  template <typename T>
  T&& operator()(T&& value) const {
    return std::forward<T>(value);
  }
};

template <typename Range, typename Test>
bool any_of(Range&& range, Test test) {
  return std::any_of(std::begin(range), std::end(range), test);
}

template <typename Range, typename Test>
bool none_of(Range&& range, Test test) {
  return std::none_of(std::begin(range), std::end(range), test);
}

template <typename Range, typename Test>
auto count_if(Range&& range, Test test) {
  return std::count_if(std::begin(range), std::end(range), test);
}

template <typename Range, typename Test>
auto find_if(Range&& range, Test test) {
  return std::find_if(std::begin(range), std::end(range), test);
}

template <typename Range, typename Value>
auto find(Range&& range, const Value& value) {
  return std::find(std::begin(range), std::end(range), value);
}

template <typename Range, typename Other>
bool equal(Range&& range, Other&& other) {
  return std::equal(std::begin(range), std::end(range), std::begin(other), std::end(other));
}

template <typename Range, typename Out>
void copy(Range&& range, Out out) {
  std::copy(std::begin(range), std::end(range), out);
}

template <typename Iterator, typename Value, typename Less = std::less<>, typename Key = Itself>
Iterator lower_bound(Iterator first, Iterator last, const Value& value, Less is_less, Key key) {
  return std::lower_bound(first, last, value, [&](const auto& item, const Value& wanted) {
    return is_less(std::invoke(key, item), wanted);
  });
}

template <typename Range, typename Value, typename Less = std::less<>, typename Key = Itself>
auto lower_bound(Range&& range, const Value& value, Less is_less, Key key) {
  return ranges::lower_bound(std::begin(range), std::end(range), value, is_less, key);
}

template <typename Range, typename Value, typename Less = std::less<>, typename Key = Itself>
bool binary_search(Range&& range, const Value& value, Less is_less, Key key) {
  const auto at = ranges::lower_bound(range, value, is_less, key);
  return at != std::end(range) && !is_less(value, std::invoke(key, *at));
}

}  // namespace ranges
}  // namespace std
// NOLINTEND(cert-dcl58-cpp)

#endif
