#include "wire/range_coder.hpp"

#include <algorithm>
#include <utility>

namespace brume::wire {
namespace {

constexpr std::uint32_t kTop = 1u << 24;  // Below this the range takes in another byte.
constexpr int kMaxOmitted = 4;            // Trailing zeros that are not written.

// After n decisions a model moves by 1 / (n + 1.5) towards the next one (the estimator of Krichevsky and
// Trofimov 1981), n at most kMemory: older decisions fade. In 1/65536.
constexpr std::uint16_t kMemory = 60;
constexpr auto kSteps = [] {
  std::array<std::uint32_t, kMemory + 1> steps{};
  for (std::uint32_t n = 0; n <= kMemory; ++n) steps[n] = 2 * 65536 / (2 * n + 3);
  return steps;
}();

// Probabilities stay away from 0 and 1 so that every decision costs bits: a packet's bytes bound its content.
constexpr std::uint32_t kSurest = 128;

std::uint32_t width_of_zero(std::uint32_t range, const BitModel& model) {
  return (range >> 16) * model.zero();
}

// Shared by both coders, which differ in bit() and direct().
template <typename Coder>
std::uint64_t code_number(Coder& coder, NumberModel& model, std::uint64_t number) {
  const auto length = static_cast<std::uint32_t>(std::bit_width(number));
  std::uint32_t node = 1;
  for (int i = 6; i >= 0; --i) node = 2 * node + coder.bit(model.length[node], length >> i & 1);
  const auto bits = static_cast<int>(node - 128);
  if constexpr (Coder::kReads) {
    if (bits > 64) coder.fail();
    if (!coder.ok()) return 0;
  }
  if (bits < 2) return static_cast<std::uint64_t>(bits);
  const bool second = coder.bit(model.second[static_cast<unsigned>(bits)], number >> (bits - 2) & 1);
  const std::uint64_t low_bits = coder.direct(number, bits - 2);
  return (std::uint64_t{2} + second) << (bits - 2) | low_bits;
}

}  // namespace

void BitModel::learn(bool bit) {
  const std::uint32_t step = kSteps[seen_], before = zero();
  const std::uint32_t after = bit ? before - (before * step >> 16) : before + ((65536 - before) * step >> 16);
  above_half_ = static_cast<std::int16_t>(
      static_cast<std::int32_t>(std::clamp(after, kSurest, 65536 - kSurest)) - 32768);
  if (seen_ < kMemory) ++seen_;
}

void Encoder::push_byte() {
  // Pending bytes are final once no carry can occur any more, or when it has occurred.
  if (low_ < 0xFF000000u || low_ >> 32 != 0) {
    const auto carry = static_cast<std::uint8_t>(low_ >> 32);
    if (!first_) bytes_.push_back(static_cast<std::byte>(pending_ + carry));
    first_ = false;
    for (; pending_ones_ > 0; --pending_ones_) bytes_.push_back(static_cast<std::byte>(0xFF + carry));
    pending_ = static_cast<std::uint8_t>(low_ >> 24);
  } else {
    ++pending_ones_;
  }
  low_ = (low_ & 0x00FFFFFFu) << 8;
}

void Encoder::narrow(std::uint32_t below, std::uint32_t width) {
  low_ += below;
  range_ = width;
  while (range_ < kTop) {
    range_ <<= 8;
    push_byte();
  }
}

bool Encoder::bit(BitModel& model, bool bit) {
  const std::uint32_t zero = width_of_zero(range_, model);
  if (bit)
    narrow(zero, range_ - zero);
  else
    narrow(0, zero);
  model.learn(bit);
  return bit;
}

std::uint64_t Encoder::direct(std::uint64_t bits, int count) {
  std::uint64_t coded = 0;
  for (int i = count - 1; i >= 0; --i) {
    const bool bit = bits >> i & 1;
    const std::uint32_t half = range_ >> 1;
    narrow(bit ? half : 0, bit ? range_ - half : half);
    coded = coded << 1 | bit;
  }
  return coded;
}

std::uint64_t Encoder::number(NumberModel& model, std::uint64_t number) {
  return code_number(*this, model, number);
}

std::vector<std::byte> Encoder::finish() {
  // Choose, among all values that decode correctly, the one with the most trailing zeros.
  const std::uint64_t last = low_ + range_ - 1;
  for (int zeros = 32; zeros >= 0; zeros -= 8) {
    const std::uint64_t value = last >> zeros << zeros;
    if (value < low_) continue;
    low_ = value;
    break;
  }
  for (int i = 0; i < 5; ++i) push_byte();
  for (int i = 0; i < kMaxOmitted && !bytes_.empty() && bytes_.back() == std::byte{0}; ++i) bytes_.pop_back();
  return std::move(bytes_);
}

Decoder::Decoder(std::span<const std::byte> bytes) : bytes_(bytes) {
  for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next_byte();
}

std::uint8_t Decoder::next_byte() {
  if (position_ < bytes_.size()) return static_cast<std::uint8_t>(bytes_[position_++]);
  if (++beyond_ > kMaxOmitted) ok_ = false;
  return 0;
}

void Decoder::widen() {
  while (range_ < kTop) {
    range_ <<= 8;
    code_ = code_ << 8 | next_byte();
  }
}

bool Decoder::bit(BitModel& model, bool) {
  if (!ok_) return false;
  const std::uint32_t zero = width_of_zero(range_, model);
  const bool bit = code_ >= zero;
  if (bit) {
    code_ -= zero;
    range_ -= zero;
  } else {
    range_ = zero;
  }
  widen();
  model.learn(bit);
  return ok_ && bit;
}

std::uint64_t Decoder::direct(std::uint64_t, int count) {
  std::uint64_t bits = 0;
  for (int i = 0; i < count && ok_; ++i) {
    const std::uint32_t half = range_ >> 1;
    const bool bit = code_ >= half;
    if (bit) code_ -= half;
    range_ = bit ? range_ - half : half;
    widen();
    bits = bits << 1 | bit;
  }
  return ok_ ? bits : 0;
}

std::uint64_t Decoder::number(NumberModel& model, std::uint64_t) {
  return code_number(*this, model, 0);
}

}  // namespace brume::wire
