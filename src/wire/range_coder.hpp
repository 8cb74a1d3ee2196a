// An adaptive binary range coder: codes yes-or-no decisions in about as many bits as their information
// content.
//
// Source: Martin 1979, "Range encoding: an algorithm for removing redundancy from a digitised message", in
// the binary form with carry propagation known from LZMA (Pavlov, "LZMA specification", 2015). Integers only:
// the same decisions give the same bytes on every machine.
//
// Encoder and decoder have the same members, so that one function describes a format in both directions:
//
//   value = coder.number(model, value);    an encoder returns its argument, a decoder the value it reads
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace brume::wire {

/// Adaptive probability of a decision; adapts fast at first, then more slowly.
class BitModel {
 public:
  /// Probability of a 0, of 65536.
  std::uint32_t zero() const { return static_cast<std::uint32_t>(32768 + above_half_); }
  void learn(bool bit);

 private:
  // Zero-initialized, so that thousands of models are initialized by one memset.
  std::int16_t above_half_ = 0;
  std::uint16_t seen_ = 0;
};

/// A number: its bit count by a tree of decisions, its second highest bit by a decision, the lower bits
/// verbatim (an adaptive Exp-Golomb code). Small and repeated numbers are cheap.
struct NumberModel {
  std::array<BitModel, 128> length;
  std::array<BitModel, 65> second;
};

class Encoder {
 public:
  static constexpr bool kReads = false;

  bool bit(BitModel& model, bool bit);
  /// The lowest `count` bits of a number, verbatim.
  std::uint64_t direct(std::uint64_t bits, int count);
  std::uint64_t number(NumberModel& model, std::uint64_t number);

  static constexpr bool ok() { return true; }

  /// The bytes. The encoder must not be used afterwards.
  std::vector<std::byte> finish();

 private:
  void narrow(std::uint32_t below, std::uint32_t width);
  void push_byte();

  std::vector<std::byte> bytes_;
  std::uint64_t low_ = 0;  // 33 bits: the highest is a carry into the pending bytes
  std::uint32_t range_ = ~std::uint32_t{0};
  std::uint8_t pending_ = 0;        // the last byte that a carry may still change
  std::uint64_t pending_ones_ = 0;  // number of 0xFF bytes after it
  bool first_ = true;               // the first byte is always 0 and is omitted
};

/// Reads the output of an encoder, or any bytes: past their end everything is 0 and ok() is false.
class Decoder {
 public:
  static constexpr bool kReads = true;

  explicit Decoder(std::span<const std::byte> bytes);

  bool bit(BitModel& model, bool ignored = false);
  std::uint64_t direct(std::uint64_t ignored, int count);
  std::uint64_t number(NumberModel& model, std::uint64_t ignored = 0);

  /// False after reading past the end or calling fail(). From then on every read returns 0.
  bool ok() const { return ok_; }
  void fail() { ok_ = false; }
  /// True when exactly all bytes were read.
  bool at_end() const { return ok_ && position_ == bytes_.size(); }

 private:
  std::uint8_t next_byte();
  void widen();

  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
  int beyond_ = 0;  // trailing zeros that the encoder omitted
  std::uint32_t range_ = ~std::uint32_t{0};
  std::uint32_t code_ = 0;
  bool ok_ = true;
};

}  // namespace brume::wire
