// The parts of Hostile that depend on types.
#pragma once

#include <algorithm>

#include "tests/api/hostile.hpp"

namespace brume::api {

constexpr std::size_t kPoolSize = 6;

template <typename T>
T* Hostile::handle(const Pool<T>& pool) {
  if (!pool.empty() && !chance(0.06)) return pool[below(static_cast<std::uint32_t>(pool.size()))];
  return wrong_handle<T>();
}

/// Mostly of another kind.
template <typename T>
T* Hostile::wrong_handle() {
  const auto other = [](const auto& list) {
    return list.empty() ? nullptr : reinterpret_cast<T*>(static_cast<void*>(list.front()));
  };
  switch (below(13)) {
    case 0:
      return other(contexts_);
    case 1:
      return other(levels_);
    case 2:
      return other(masks_);
    case 3:
      return other(worlds_);
    case 4:
      return other(states_);
    case 5:
      return other(senders_);
    case 6:
      return other(receivers_);
    case 7:
      return other(fields_);
    case 8:
      return reinterpret_cast<T*>(garbage_.data() + 64 * below(32));
    case 9:
      return reinterpret_cast<T*>(garbage_.data() + below(2000));
    case 10:
      return other(textures_);
    default:
      return nullptr;
  }
}

/// With as many bytes behind it as a struct of a later version may have: zeros or not.
template <typename Params>
const Params* Hostile::spoiled(Params& params) {
  if (chance(0.03)) return nullptr;
  if (chance(0.03)) params.struct_size = number(512);
  if (chance(0.02)) params.struct_size = sizeof(Params) + 8 * below(20);
  if (chance(0.02)) params.next = garbage_.data();
  struct_.fill(chance(0.5) ? 0 : 1);
  return new (struct_.data()) Params(params);
}

template <typename T>
Output<T> Hostile::output() {
  Output<T> out;
  out.given = !chance(0.03);
  return out;
}

template <typename T>
void Hostile::keep(const char* function, brume_result result, const Output<T*>& out, Pool<T>& pool,
                   brume_result (*destroy)(T*) BRUME_NOEXCEPT) {
  if (!checked(function, result, out.untouched())) return;
  ASSERT_NE(out.value(), nullptr);
  pool.push_back(out.value());
  if (pool.size() <= kPoolSize) return;
  const std::uint32_t oldest = below(2);
  EXPECT_EQ(destroy(pool[oldest]), BRUME_OK);
  pool.erase(pool.begin() + oldest);
}

template <typename T>
void Hostile::end(const char* function, Pool<T>& pool, brume_result (*destroy)(T*) BRUME_NOEXCEPT) {
  T* one = chance(0.04) ? handle(pool) : wrong_handle<T>();
  const auto found = std::find(pool.begin(), pool.end(), one);
  const brume_result result = destroy(one);
  if (checked(function, result, true) && found != pool.end()) pool.erase(found);
}

template <typename Number, typename T>
void Hostile::read(const char* function, const Pool<T>& pool,
                   brume_result (*call)(const T*, Number*) BRUME_NOEXCEPT) {
  auto out = output<Number>();
  const brume_result result = call(handle(pool), out.pointer());
  checked(function, result, out.untouched());
}

/// `call(buffer, capacity, size)`.
template <typename Call>
void Hostile::read_bytes(const char* function, Call call) {
  static constexpr std::array<std::size_t, 6> kSizes{0, 1, 9, 100, 1000, 16384};
  const std::size_t capacity = kSizes[below(kSizes.size())];
  std::vector<std::uint8_t> buffer(capacity + 1, Output<int>::kPattern);
  const bool null = chance(0.2);
  auto size = output<std::size_t>();
  const brume_result result = call(null ? nullptr : buffer.data(), capacity, size.pointer());
  EXPECT_EQ(buffer.back(), Output<int>::kPattern);
  if (result == BRUME_ERROR_BUFFER) {
    EXPECT_GT(size.value(), capacity);
    EXPECT_EQ(buffer.front(), Output<int>::kPattern);
  }
  if (!checked(function, result, size.untouched() || result == BRUME_ERROR_BUFFER)) return;
  if (null) return;
  buffer.resize(size.value());
  packets_.push_back(std::move(buffer));
  if (packets_.size() > 40) packets_.erase(packets_.begin() + below(8));
}

template <typename Element, typename T>
void Hostile::read_list(const char* function, const Pool<T>& pool,
                        brume_result (*call)(const T*, Element*, std::size_t, std::size_t*) BRUME_NOEXCEPT) {
  std::vector<Element> list(below(12) + 1);
  std::memset(static_cast<void*>(list.data()), Output<int>::kPattern, list.size() * sizeof(Element));
  const Element last = list.back();
  auto size = output<std::size_t>();
  const brume_result result =
      call(handle(pool), chance(0.2) ? nullptr : list.data(), list.size() - 1, size.pointer());
  EXPECT_EQ(std::memcmp(&list.back(), &last, sizeof last), 0);
  checked(function, result, size.untouched() || result == BRUME_ERROR_BUFFER);
}

/// `call(segments, count, out)`.
template <typename Out, typename Call>
void Hostile::query(const char* function, Call call) {
  const std::vector<brume_segment> lines = segments();
  std::vector<Out> out(lines.size() + 1);
  const std::size_t bytes = out.size() * sizeof(Out);
  std::memset(out.data(), Output<int>::kPattern, bytes);
  const std::vector<Out> before = out;
  const std::size_t number = count(lines.size());
  const brume_segment* first = chance(0.03) ? nullptr : lines.data();
  const brume_result result = call(first, number, chance(0.03) ? nullptr : out.data());
  EXPECT_EQ(std::memcmp(&out.back(), &before.back(), sizeof(Out)), 0);
  checked(function, result, std::memcmp(out.data(), before.data(), bytes) == 0);
}

/// `call(low, high, out, count)`.
template <typename Call>
void Hostile::read_box(const char* function, Call call) {
  const brume_voxel low = voxel(6);
  const auto above = [](std::int32_t at, std::uint32_t by) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(at) + by);
  };
  brume_voxel high = low;
  if (!chance(0.1)) high = {above(low.x, 1 + below(3)), above(low.y, 2), above(low.z, 1)};
  std::array<std::uint8_t, 32> out;
  out.fill(Output<int>::kPattern);
  const std::int64_t width = std::int64_t{high.x} - low.x;
  const std::size_t voxels = chance(0.05) ? count(7) : static_cast<std::size_t>(width * 2);
  const brume_result result = call(low, high, chance(0.03) ? nullptr : out.data(), voxels);
  EXPECT_EQ(out.back(), Output<int>::kPattern);
  checked(function, result, out.front() == Output<int>::kPattern);
}

/// Defaults for structs of any size: what is behind them stays.
template <typename Params>
void Hostile::write_defaults(const char* function,
                             brume_result (*call)(Params*, std::uint32_t) BRUME_NOEXCEPT) {
  alignas(Params) std::array<unsigned char, 2048> bytes;
  bytes.fill(Output<int>::kPattern);
  const std::uint32_t size = chance(0.8) ? sizeof(Params) : number(500);
  auto* const params = chance(0.03) ? nullptr : reinterpret_cast<Params*>(bytes.data());
  if (size >= bytes.size() && size <= 4096) return;  // it would be written
  const bool written = checked(function, call(params, size), bytes[0] == Output<int>::kPattern);
  EXPECT_EQ(bytes[written ? size : 0], Output<int>::kPattern);
}

}  // namespace brume::api
