// An adaptive binary range coder: yes-or-no decisions in, about as many bits out as they were surprising.
//
// Source: Martin 1979, "Range encoding: an algorithm for removing redundancy from a digitised message", in
// the binary archive with carry propagation that LZMA made known (Pavlov, "LZMA specification", 2015). Integers
// only: the same decisions give the same bytes on every machine.
//
// Encoder and decoder have the same members, so that one function describes a format for both ways:
//
//   value = coder.number(model, value);    an encoder hands back what it was given, a decoder what it reads
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace brume::wire {

/// What a decision has been so far: it learns fast at first, then slower.
class BitModel {
 public:
  /// Probability of a 0, of 65536.
  std::uint32_t zero() const { return static_cast<std::uint32_t>(32768 + above_half_); }
  void learn(bool bit);

 private:
  // All bits 0 at first, so that thousands of models are made by one memset.
  std::int16_t above_half_ = 0;
  std::uint16_t seen_ = 0;
};

/// A number: how many bits it has by a tree of decisions, the second highest bit by a decision, the rest as
/// they are (an Exp-Golomb code that adapts). Small and repeated numbers are cheap.
struct NumberModel {
  std::array<BitModel, 128> length;
  std::array<BitModel, 65> second;
};

class Encoder {
 public:
  static constexpr bool kReads = false;

  bool bit(BitModel& model, bool bit);
  /// The lowest `count` bits of a number, as they are.
  std::uint64_t direct(std::uint64_t bits, int count);
  std::uint64_t number(NumberModel& model, std::uint64_t number);

  static constexpr bool ok() { return true; }

  /// The bytes; the encoder is used up.
  std::vector<std::byte> finish();

 private:
  void narrow(std::uint32_t below, std::uint32_t width);
  void push_byte();

  std::vector<std::byte> bytes_;
  std::uint64_t low_ = 0;  // 33 bits: the highest is a carry into bytes that wait
  std::uint32_t range_ = ~std::uint32_t{0};
  std::uint8_t waiting_ = 0;        // the last byte that a carry may still change,
  std::uint64_t waiting_ones_ = 0;  // and how many 0xFF follow it
  bool first_ = true;               // the first byte is always 0 and is left out
};

/// Reads what an encoder wrote, or anything: past the end of the bytes all is 0 and ok() is false.
class Decoder {
 public:
  static constexpr bool kReads = true;

  explicit Decoder(std::span<const std::byte> bytes);

  bool bit(BitModel& model, bool ignored = false);
  std::uint64_t direct(std::uint64_t ignored, int count);
  std::uint64_t number(NumberModel& model, std::uint64_t ignored = 0);

  /// False once more was read than was there, or fail() was called. From then on all that is read is 0.
  bool ok() const { return ok_; }
  void fail() { ok_ = false; }
  /// True when all bytes were read, none more.
  bool at_end() const { return ok_ && position_ == bytes_.size(); }

 private:
  std::uint8_t next_byte();
  void widen();

  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
  int beyond_ = 0;  // zeros that the encoder left out at the end
  std::uint32_t range_ = ~std::uint32_t{0};
  std::uint32_t code_ = 0;
  bool ok_ = true;
};

}  // namespace brume::wire
