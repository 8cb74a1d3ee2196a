#include "spheres/file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <vector>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "fuzz/spheres_checks.hpp"
#include "spheres/pack.hpp"
#include "tests/sanitized.hpp"
#include "tests/work_folder.hpp"

namespace brume::spheres {
namespace {

using Bytes = std::vector<std::byte>;

Tank small_tank(std::uint32_t count = 9) {
  PackOptions options;
  options.size = {33, 17, 5};
  options.voxel = 0.01f;
  options.count = count;
  options.radius = {0.3f, 2};
  options.opacity = 0.5f;
  options.palette = {0x336699, 0xffcc00};
  return pack(options).value_or_throw();
}

/// The bytes of a tank whose header is changed, with a right checksum.
template <typename T>
Bytes with(std::size_t offset, T value) {
  Bytes bytes = tank_bytes(small_tank());
  std::memcpy(bytes.data() + offset, &value, sizeof value);
  const std::uint64_t checksum = hash_bytes(std::span(bytes).first(bytes.size() - 8));
  std::memcpy(bytes.data() + bytes.size() - 8, &checksum, sizeof checksum);
  return bytes;
}

std::string refusal(const Bytes& bytes, ErrorCode code = ErrorCode::bad_input) {
  const auto tank = parse_tank(bytes, "a.spheres");
  if (tank) return "accepted";
  EXPECT_EQ(tank.failure().code, code);
  return tank.failure().message;
}

TEST(TankFile, HoldsTheTank) {
  for (const std::uint32_t count : {0u, 1u, 9u}) {
    const Tank tank = small_tank(count);
    ASSERT_EQ(tank.spheres.size(), count);
    const Bytes bytes = tank_bytes(tank);
    EXPECT_EQ(bytes.size(), 40 + 20 * count) << "docs/reference/formats.md";
    const Tank again = parse_tank(bytes, "a.spheres").value_or_throw();
    EXPECT_EQ(again.size, tank.size);
    EXPECT_EQ(again.voxel, tank.voxel);
    EXPECT_EQ(again.spheres, tank.spheres);
    EXPECT_EQ(again.colors, tank.colors);
    EXPECT_EQ(tank_bytes(again), bytes);
  }
}

TEST(TankFile, IsSavedAndLoaded) {
  const cli::WorkFolder folder;
  const auto path = folder.path() / "a.spheres";
  const Tank tank = small_tank();
  ASSERT_TRUE(save_tank(path, tank));
  EXPECT_EQ(load_tank(path).value_or_throw().spheres, tank.spheres);
  ASSERT_TRUE(write_file_atomic(path, std::string("no spheres")));
  EXPECT_EQ(load_tank(path).failure().message, path.string() + ": not a .spheres file");
  EXPECT_EQ(load_tank(folder.path() / "b.spheres").failure().code, ErrorCode::bad_input);
  EXPECT_TRUE(is_tank_file("a.SPHERES"));
  EXPECT_FALSE(is_tank_file("spheres"));
}

TEST(TankFile, IsRefusedWhereverItIsCut) {
  const Bytes bytes = tank_bytes(small_tank());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::string why = refusal({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)});
    EXPECT_NE(why.find(length < 8 ? "not a .spheres file" : "truncated"), std::string::npos) << length << why;
  }
  Bytes longer = bytes;
  longer.push_back({});
  EXPECT_EQ(refusal(longer), "a.spheres: the file is too long: 221 bytes of 220");
}

TEST(TankFile, IsRefusedWithAnyBitFlipped) {
  Bytes bytes = tank_bytes(small_tank());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto mask = static_cast<std::byte>(1u << bit % 8);
    bytes[bit / 8] ^= mask;
    EXPECT_FALSE(check_tank_bytes(bytes)) << bit;
    bytes[bit / 8] ^= mask;
  }
}

TEST(TankFile, IsRefusedWithAReason) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal(with(8, 2u)), "a.spheres: a .spheres file of version 2, not 1");
  EXPECT_EQ(refusal(with(12, 1000000000u), ErrorCode::resource_limit),
            "a.spheres: has 1000000000 spheres; at most 8388608 are possible");
  EXPECT_EQ(refusal(with(12, 8388608u)), "a.spheres: the file is truncated: 220 bytes of 167772200");
  EXPECT_EQ(refusal(with(16, 0u)), "a.spheres: the file is damaged: its tank has no voxels");
  EXPECT_EQ(refusal(with(16, 5000u), ErrorCode::resource_limit),
            "a.spheres: has 5000 voxels along an axis; at most 2048 are possible");
  EXPECT_EQ(refusal(with(16, glm::uvec3(2048)), ErrorCode::resource_limit),
            "a.spheres: has 8589934592 voxels; at most 268435456 are possible");
  for (const float voxel : {0.0f, -1.0f, nan, std::numeric_limits<float>::infinity()})
    EXPECT_EQ(refusal(with(28, voxel)),
              "a.spheres: the file is damaged: the edge of a voxel is not a number above 0");
  for (const std::size_t offset : {32u, 36u, 40u, 44u})
    for (const float number : {nan, -1.0f, 1e30f})
      EXPECT_EQ(refusal(with(offset, number)),
                "a.spheres: the file is damaged: sphere 1 is not inside of the tank");
}

TEST(TankFile, SurvivesTheCorpusOfItsFuzzer) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(BRUME_SOURCE_DIR "/fuzz/corpus/spheres")) {
    EXPECT_TRUE(check_tank_input(read_file(entry.path()).value_or_throw())) << entry.path();
    ++files;
  }
  EXPECT_GT(files, 0);
}

/// A few changes, most of them of whole numbers, where the structure is.
void mutate_tank(Bytes& bytes, std::mt19937& random) {
  const auto at = [&](std::size_t length) {
    const std::size_t places = bytes.size() - length + 1;
    return random() % (random() % 2 == 0 ? std::min<std::size_t>(places, 64) : places);
  };
  for (std::uint32_t i = 0; i <= random() % 4; ++i) {
    switch (random() % 6) {
      case 0:
        bytes[at(1)] ^= static_cast<std::byte>(1u << random() % 8);
        break;
      case 1:
        bytes[at(1)] = static_cast<std::byte>(random());
        break;
      case 2: {
        const auto any = static_cast<std::uint32_t>(random());
        const std::uint32_t values[] = {0,          1,          UINT32_MAX, 0x7f800000,
                                        0x7fc00000, 0x80000000, 0x3f800000, any};
        std::memcpy(&bytes[4 * (at(4) / 4)], &values[random() % 8], 4);
        break;
      }
      case 3: {
        const float number = std::ldexp(1.0f, static_cast<int>(random() % 24) - 12);
        std::memcpy(&bytes[4 * (at(4) / 4)], &number, 4);
        break;
      }
      case 4:
        bytes.resize(std::max<std::size_t>(16, random() % (bytes.size() + 40)));
        break;
      default: {
        const std::size_t length = 1 + random() % 20, place = at(1);
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(place), length,
                     static_cast<std::byte>(random()));
      }
    }
  }
}

// BRUME_SPHERES_MUTATIONS sets how many.
TEST(TankFile, MutationsAreReadOrRefused) {
  const char* chosen = std::getenv("BRUME_SPHERES_MUTATIONS");
  const std::uint64_t count = chosen ? std::strtoull(chosen, nullptr, 10) : (kSanitized ? 20'000 : 200'000);
  const Bytes bases[] = {tank_bytes(small_tank(0)), tank_bytes(small_tank(1)), tank_bytes(small_tank(4))};
  std::uint64_t accepted = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::mt19937 random(static_cast<std::uint32_t>(i));
    Bytes bytes = bases[random() % std::size(bases)];
    mutate_tank(bytes, random);
    accepted += check_tank_input(bytes);
  }
  std::printf("%llu of %llu mutations are read\n", static_cast<unsigned long long>(accepted),
              static_cast<unsigned long long>(count));
  // Not all are refused at once: the reader is reached.
  EXPECT_GT(accepted, count / 50);
  EXPECT_LT(accepted, count);
}

}  // namespace
}  // namespace brume::spheres
