// Checked byte streams: little-endian numbers and varints (7 bits per byte, lowest first; the top bit: more).
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace brume::wire {

class ByteWriter {
 public:
  template <std::unsigned_integral T>
  void number(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes_.push_back(static_cast<std::byte>(std::uint64_t{value} >> (8 * i)));
  }
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<std::byte>(value | 0x80));
    bytes_.push_back(static_cast<std::byte>(value));
  }
  void raw(std::span<const std::byte> bytes);
  /// The number of bytes as a varint, then the bytes.
  void section(std::span<const std::byte> bytes) {
    varint(bytes.size());
    raw(bytes);
  }

  std::span<const std::byte> bytes() const { return bytes_; }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

/// Reads untrusted bytes. Reading past their end gives 0 or nothing and makes ok() false for good. Never
/// allocates.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <std::unsigned_integral T>
  T number() {
    const std::span<const std::byte> bytes = raw(sizeof(T));
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      value |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
    return static_cast<T>(value);
  }
  /// A number of at most `max`. Overlong codes fail too, so that each number has one code only.
  std::uint64_t varint(std::uint64_t max) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto byte = number<std::uint8_t>();
      const std::uint64_t bits = byte & 0x7fu;
      if (shift == 63 && bits > 1) break;
      value |= bits << shift;
      if (byte & 0x80u) continue;
      if (value > max || (byte == 0 && shift > 0)) break;
      return ok_ ? value : 0;
    }
    ok_ = false;
    return 0;
  }
  std::span<const std::byte> raw(std::uint64_t count) {
    if (count > bytes_.size()) ok_ = false;
    if (!ok_) return {};
    const auto taken = bytes_.first(static_cast<std::size_t>(count));
    bytes_ = bytes_.subspan(taken.size());
    return taken;
  }
  std::span<const std::byte> section() { return raw(varint(~std::uint64_t{0})); }

  std::span<const std::byte> remaining() const { return bytes_; }
  bool ok() const { return ok_; }

 private:
  std::span<const std::byte> bytes_;
  bool ok_ = true;
};

}  // namespace brume::wire
