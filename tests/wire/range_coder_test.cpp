#include "wire/range_coder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "wire/block_coding.hpp"
#include "wire/bytes.hpp"

namespace brume::wire {
namespace {

struct Item {
  int kind;
  std::uint64_t value;
};

// Decisions, plain bits and numbers in any order and of any length.
TEST(RangeCoder, RoundTrips) {
  std::mt19937_64 random(1);
  for (int length = 0; length < 400; ++length) {
    std::vector<Item> items;
    for (int i = 0; i < length; ++i) {
      const int bits = static_cast<int>(random() % 65);
      const std::uint64_t value = bits == 0 ? 0 : random() >> (64 - bits);
      const int kind = static_cast<int>(random() % 3);
      items.push_back({kind, kind == 0 ? random() % 16 == 0 : value});
    }
    Encoder encoder;
    BitModel bit;
    auto number = std::make_unique<NumberModel>();
    for (const Item& item : items) {
      if (item.kind == 0) {
        EXPECT_EQ(encoder.bit(bit, item.value != 0), item.value != 0);
      }
      if (item.kind == 1) {
        EXPECT_EQ(encoder.direct(item.value, 64), item.value);
      }
      if (item.kind == 2) {
        EXPECT_EQ(encoder.number(*number, item.value), item.value);
      }
    }
    const auto bytes = encoder.finish();
    Decoder decoder(bytes);
    bit = {};
    number = std::make_unique<NumberModel>();
    for (const Item& item : items) {
      if (item.kind == 0) {
        ASSERT_EQ(decoder.bit(bit), item.value != 0);
      }
      if (item.kind == 1) {
        ASSERT_EQ(decoder.direct(0, 64), item.value);
      }
      if (item.kind == 2) {
        ASSERT_EQ(decoder.number(*number), item.value);
      }
    }
    EXPECT_TRUE(decoder.at_end()) << length;
  }
}

// Carries: the longest runs of 0xFF come from decisions that are always the less likely one.
TEST(RangeCoder, PropagatesCarriesThroughLongRuns) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::vector<bool> bits;
    for (int i = 0; i < 3000; ++i) bits.push_back(random() % (1 + seed) != 0);
    Encoder encoder;
    BitModel model;
    for (const bool b : bits) encoder.bit(model, b);
    const auto bytes = encoder.finish();
    Decoder decoder(bytes);
    model = {};
    for (const bool b : bits) ASSERT_EQ(decoder.bit(model), b);
    EXPECT_TRUE(decoder.at_end());
  }
}

// The cost is within 3 % of the entropy plus the cost of adaptation: about half of log2(n) bits for one model
// (Krichevsky and Trofimov 1981), more with short memory.
TEST(RangeCoder, CostIsCloseToTheEntropy) {
  for (const double share : {0.5, 0.1, 0.02}) {
    std::mt19937 random(7);
    std::bernoulli_distribution next(share);
    constexpr int kCount = 100'000;
    Encoder encoder;
    BitModel model;
    for (int i = 0; i < kCount; ++i) encoder.bit(model, next(random));
    const double entropy = -share * std::log2(share) - (1 - share) * std::log2(1 - share);
    // A model that remembers m decisions errs by about 1 / (2 ln 2 m) bits each.
    const double error = 1 / (2 * std::log(2.0) * 60);
    EXPECT_LE(static_cast<double>(encoder.finish().size()) * 8, kCount * (entropy * 1.03 + error) + 64)
        << share;
  }
}

TEST(RangeCoder, EmptyInputCostsNothing) {
  EXPECT_TRUE(Encoder().finish().empty());
  EXPECT_TRUE(Decoder({}).at_end());
}

// Reads past the end return 0 and set the error flag, and loops terminate.
TEST(RangeCoder, DetectsTheEnd) {
  std::mt19937 random(3);
  Encoder encoder;
  for (int i = 0; i < 50; ++i) encoder.direct(random(), 32);
  auto bytes = encoder.finish();
  for (std::size_t length = 0; length + 4 < bytes.size(); ++length) {
    Decoder decoder(std::span<const std::byte>(bytes).first(length));
    for (int i = 0; i < 50; ++i) decoder.direct(0, 32);
    EXPECT_FALSE(decoder.ok()) << length;
    BitModel model;
    NumberModel number;
    EXPECT_FALSE(decoder.bit(model));
    EXPECT_EQ(decoder.direct(0, 9), 0u);
    EXPECT_EQ(decoder.number(number), 0u);
  }
  // As many zeros as may be missing at the end, and one byte more.
  bytes.insert(bytes.end(), 5, std::byte{0});
  Decoder decoder(bytes);
  for (int i = 0; i < 50; ++i) decoder.direct(0, 32);
  EXPECT_FALSE(decoder.at_end());
}

TEST(Fold, IsABijection) {
  for (const std::int64_t value :
       {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1}, std::int64_t{123456}, std::int64_t{-123456},
        std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()})
    EXPECT_EQ(unfolded(folded(value)), value);
  EXPECT_EQ(folded(0), 0u);
  EXPECT_EQ(folded(-1), 1u);
  EXPECT_EQ(folded(1), 2u);
}

TEST(Bytes, RoundTrip) {
  ByteWriter out;
  const std::vector<std::uint64_t> values{0, 1, 127, 128, 300, 16383, 16384, ~std::uint64_t{0}};
  for (const std::uint64_t value : values) out.varint(value);
  out.number(std::uint32_t{0x12345678});
  out.section(std::vector<std::byte>(200, std::byte{7}));
  ByteReader in(out.bytes());
  for (const std::uint64_t value : values) EXPECT_EQ(in.varint(~std::uint64_t{0}), value);
  EXPECT_EQ(in.number<std::uint32_t>(), 0x12345678u);
  EXPECT_EQ(in.section().size(), 200u);
  EXPECT_TRUE(in.ok());
  EXPECT_TRUE(in.remaining().empty());
}

TEST(Bytes, RejectReadsPastTheEnd) {
  const auto varint_of = [](std::vector<std::byte> bytes, std::uint64_t max) {
    ByteReader in(bytes);
    in.varint(max);
    return in.ok();
  };
  EXPECT_TRUE(varint_of({std::byte{5}}, 5));
  EXPECT_FALSE(varint_of({std::byte{6}}, 5));
  EXPECT_FALSE(varint_of({}, 5));
  EXPECT_FALSE(varint_of({std::byte{0x80}}, 5));
  EXPECT_FALSE(varint_of({std::byte{0x85}, std::byte{0}}, 5)) << "one number, one code";
  EXPECT_FALSE(varint_of(std::vector<std::byte>(11, std::byte{0xff}), ~std::uint64_t{0}));
  std::vector<std::byte> high(9, std::byte{0x80});
  high.push_back(std::byte{2});
  EXPECT_FALSE(varint_of(high, ~std::uint64_t{0})) << "65 bits";
  // A section longer than the rest; nothing is read from then on.
  const std::vector<std::byte> bytes{std::byte{3}, std::byte{1}, std::byte{2}};
  ByteReader in(bytes);
  EXPECT_TRUE(in.section().empty());
  EXPECT_FALSE(in.ok());
  EXPECT_EQ(in.number<std::uint8_t>(), 0);
}

}  // namespace
}  // namespace brume::wire
