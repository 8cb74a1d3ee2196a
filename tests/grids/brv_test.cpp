#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <random>

#include "core/file.hpp"
#include "core/tasks.hpp"
#include "fuzz/brv_checks.hpp"
#include "grids/brv_file.hpp"
#include "tests/grids/sample_grids.hpp"

namespace brume::grids {
namespace {

using Bytes = std::vector<std::byte>;

GridFile file_of_all_types() {
  GridFile file;
  for (const ValueType type : kAllTypes) file.grids.push_back(random_grid(type, 1));
  file.grids.push_back(smoke_grid("density", 11));
  file.metadata = sample_metadata();
  return file;
}

Bytes encoded(const GridFile& file, const BrvOptions& options = {}) {
  return encode_brv(file, options).value_or_throw();
}

std::string error_of(std::span<const std::byte> bytes, const GridLimits& limits = {}) {
  const auto file = decode_brv(bytes, limits);
  return file ? "" : file.failure().message;
}

TEST(Brv, KeepsGridsOfEveryType) {
  const GridFile file = file_of_all_types();
  for (const BrvOptions& options :
       {BrvOptions{}, BrvOptions{0, 16}, BrvOptions{1, 1}, BrvOptions{19, 4096}}) {
    const Bytes bytes = encoded(file, options);
    expect_same(decode_brv(bytes).value_or_throw(), file);
  }
}

TEST(Brv, KeepsAFileWithoutGridsAndAGridWithoutVoxels) {
  expect_same(decode_brv(encoded({})).value_or_throw(), {});
  const GridFile empty{{Grid{}}, sample_metadata()};
  expect_same(decode_brv(encoded(empty)).value_or_throw(), empty);
}

TEST(Brv, GivesTheSameBytesOnAnyNumberOfThreads) {
  const GridFile file = file_of_all_types();
  set_thread_count(1);
  const Bytes one = encoded(file);
  set_thread_count(3);
  EXPECT_TRUE(one == encoded(file));
  set_thread_count(0);
}

TEST(Brv, CompressesSmoke) {
  const GridFile file{{smoke_grid("density", 30)}, {}};
  EXPECT_LT(encoded(file).size() * 4, memory_of(file.grids[0]));
}

TEST(Brv, ReadsChunksInAnyOrder) {
  const GridFile file{{smoke_grid("density", 30), random_grid(ValueType::vec3d, 3)}, {}};
  const Bytes bytes = encoded(file, {.bricks_per_chunk = 7});
  const BrvDirectory directory = open_brv(bytes).value_or_throw();
  ASSERT_EQ(directory.grids.size(), 2u);
  for (std::size_t g = 2; g-- > 0;) {
    const BrvGrid& of = directory.grids[g];
    const Grid& grid = file.grids[g];
    ASSERT_EQ(of.chunks.size(), (grid.bricks.size() + 6) / 7);
    for (std::size_t i = of.chunks.size(); i-- > 0;) {
      std::vector<Brick> bricks(of.brick_count(i));
      Bytes values(bricks.size() * kBrickVoxels * bytes_of(grid.type));
      ASSERT_TRUE(read_brv_chunk(bytes, of, i, bricks, values));
      for (std::size_t b = 0; b < bricks.size(); ++b)
        EXPECT_EQ(bricks[b].active, grid.bricks[of.first_brick(i) + b].active);
      const auto expected = grid.values_of(of.first_brick(i));
      EXPECT_EQ(std::memcmp(values.data(), expected.data(), values.size()), 0);
    }
  }
}

TEST(Brv, RejectsEveryTruncationAndEveryChangedByte) {
  const GridFile file{{random_grid(ValueType::int32, 5, 2)}, {}};
  const Bytes bytes = encoded(file);
  for (std::size_t length = 0; length < bytes.size(); ++length)
    ASSERT_NE(error_of(std::span(bytes).first(length)), "") << length;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes changed = bytes;
    changed[i] ^= std::byte{0x10};
    ASSERT_NE(error_of(changed), "") << i;
  }
  Bytes longer = bytes;
  longer.push_back({});
  EXPECT_NE(error_of(longer), "");
}

TEST(Brv, NamesOtherVersions) {
  Bytes bytes = encoded({});
  bytes[8] = std::byte{9};
  EXPECT_EQ(error_of(bytes), "a .brv file of version 9, not 1");
  EXPECT_EQ(error_of(Bytes(100)), "not a .brv file");
}

TEST(Brv, EnforcesLimits) {
  const GridFile file{{smoke_grid("density", 20)}, {}};
  const Bytes bytes = encoded(file);
  const std::uint64_t memory = memory_of(file.grids[0]), active = count_active(file.grids[0]);
  EXPECT_EQ(error_of(bytes, {.bytes = memory, .active_voxels = active}), "");
  const auto code = [&](const GridLimits& limits) { return decode_brv(bytes, limits).failure().code; };
  EXPECT_EQ(code({.bytes = memory - 1}), ErrorCode::resource_limit);
  EXPECT_EQ(code({.active_voxels = active - 1}), ErrorCode::resource_limit);
  const auto huge = decode_brv(encoded({{huge_tile()}, {}}));
  ASSERT_FALSE(huge);
  EXPECT_EQ(huge.failure().code, ErrorCode::resource_limit);
  EXPECT_NE(huge.failure().message.find("68719476736 active voxels"), std::string::npos);
}

// What check_grid finds in a grid, or in a forged file that holds it.
std::string fault_of(const Grid& grid) {
  const auto written = encode_brv({{grid}, {}});
  EXPECT_FALSE(written);
  BrvDirectory directory;
  BrvGrid& of = directory.grids.emplace_back();
  of.grid = grid;
  of.bricks_per_chunk = kMaxBricksPerChunk;
  if (!grid.bricks.empty()) of.chunks.emplace_back();
  EXPECT_NE(error_of(forge_brv(encode_brv_directory(directory), {})), "");
  return written ? "" : written.failure().message;
}

TEST(Brv, RefusesGridsThatAreNone) {
  const Grid valid = random_grid(ValueType::boolean, 4);
  const auto with = [&](const auto& change) {
    Grid grid = valid;
    change(grid);
    return fault_of(grid);
  };
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(with([](Grid& g) { std::swap(g.bricks[0], g.bricks[1]); }), "bricks are not in order");
  has(with([](Grid& g) { g.bricks[1] = g.bricks[0]; }), "bricks are not in order");
  has(with([](Grid& g) { std::swap(g.tiles[0], g.tiles[1]); }), "tiles are not in order");
  has(with([](Grid& g) { g.tiles = {{g.bricks[2].origin, 8, true, {}}}; }), "overlaps");
  has(with([](Grid& g) { g.tiles = {{g.bricks[2].origin & ~4095, 4096, true, {}}}; }), "overlaps");
  has(with([](Grid& g) { g.tiles[0].value[0] = std::byte{2}; }), "neither 0 nor 1");
  has(with([](Grid& g) { g.background[0] = std::byte{2}; }), "neither 0 nor 1");
  has(with([](Grid& g) { g.world_from_index[0] = glm::dvec4(0); }), "transform");
  has(with([](Grid& g) { g.world_from_index[1].x = std::numeric_limits<double>::quiet_NaN(); }), "transform");
  has(with([](Grid& g) { g.world_from_index[0].w = 0.5; }), "transform");
  // A tile inside of another.
  has(with([](Grid& g) {
        g.bricks.clear();
        g.values.clear();
        g.tiles = {{glm::ivec3(-4096), 4096, true, {}}, {glm::ivec3(-128), 128, true, {}}};
      }),
      "overlaps");
}

TEST(Brv, RefusesValuesThatAreNotAsManyAsVoxels) {
  Grid grid = random_grid(ValueType::float32, 4);
  grid.values.pop_back();
  EXPECT_FALSE(encode_brv({{grid}, {}}));
}

// Any byte of the directory may be anything: what is accepted is valid, and is written and read again.
TEST(Brv, SurvivesForgedDirectories) {
  std::mt19937 random(7);
  const Bytes whole =
      encoded({{random_grid(ValueType::vec3f, 2, 3)}, sample_metadata()}, {.compression_level = 0});
  const BrvDirectory directory = open_brv(whole).value_or_throw();
  const Bytes chunks(whole.begin() + 16, whole.begin() + 16 + directory.grids[0].chunks[0].stored_bytes);
  const Bytes bytes = encode_brv_directory(directory);
  for (int round = 0; round < 3000; ++round) {
    Bytes changed = bytes;
    for (std::uint32_t i = 0; i <= random() % 3; ++i)
      changed[random() % changed.size()] = static_cast<std::byte>(random() % 4 == 0 ? 0xff : random() % 256);
    check_brv(forge_brv(changed, chunks));
  }
}

TEST(Brv, SurvivesTheCorpusOfItsFuzzer) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(BRUME_SOURCE_DIR "/fuzz/corpus/brv")) {
    check_brv_input(read_file(entry.path()).value_or_throw());
    ++count;
  }
  EXPECT_GT(count, 5);
}

}  // namespace
}  // namespace brume::grids
