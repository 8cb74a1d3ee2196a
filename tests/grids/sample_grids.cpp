#include "tests/grids/sample_grids.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <set>
#include <tuple>

#include "grids/metadata.hpp"

namespace brume::grids {
namespace {

using glm::ivec3;
using Random = std::mt19937;

bool in_order(ivec3 a, ivec3 b) {
  return goes_before(a, b);
}

Value random_value(ValueType type, Random& random) {
  Value value{};
  for (std::size_t i = 0; i < bytes_of(type); ++i)
    value[i] = static_cast<std::byte>(type == ValueType::boolean ? random() % 2 : random() % 256);
  return value;
}

// Origins aligned to an edge, none twice, that no cube of `taken` holds.
std::vector<ivec3> random_origins(std::size_t count, int edge, Random& random) {
  std::set<std::tuple<int, int, int>> found;
  while (found.size() < count) {
    const auto coordinate = [&] {
      // Near the origin, on both sides, or anywhere.
      const bool near = random() % 3 != 0;
      const auto any = static_cast<std::int32_t>(random());
      return (near ? any % (4 * edge) : any) & ~(edge - 1);
    };
    found.emplace(coordinate(), coordinate(), coordinate());
  }
  std::vector<ivec3> origins;
  for (const auto& [z, y, x] : found) origins.emplace_back(x, y, z);
  return origins;
}

bool overlaps(const Grid& grid, ivec3 origin, int edge) {
  const auto meet = [&](ivec3 other, int other_edge) {
    const int rest = ~(std::max(edge, other_edge) - 1);
    return (origin & rest) == (other & rest);
  };
  return std::any_of(grid.tiles.begin(), grid.tiles.end(),
                     [&](const Tile& t) { return meet(t.origin, static_cast<int>(t.edge)); }) ||
         std::any_of(grid.bricks.begin(), grid.bricks.end(),
                     [&](const Brick& b) { return meet(b.origin, kBrickEdge); });
}

void add_tiles(Grid& grid, int edge, std::size_t count, Random& random) {
  for (const ivec3 origin : random_origins(count, edge, random)) {
    if (overlaps(grid, origin, edge)) continue;
    // 4096^3 active voxels are more than the limits allow.
    const bool active = edge < 4096 && random() % 2 == 0;
    const Tile tile{origin, static_cast<std::uint32_t>(edge), active, random_value(grid.type, random)};
    // A tile without active voxels or a value of its own is none.
    if (!active && tile.value == grid.background) continue;
    grid.tiles.push_back(tile);
  }
  std::sort(grid.tiles.begin(), grid.tiles.end(),
            [](const Tile& a, const Tile& b) { return in_order(a.origin, b.origin); });
}

std::vector<Metadata> without_derived(std::vector<Metadata> metadata) {
  std::erase_if(metadata, [](const Metadata& entry) { return entry.name.rfind("file_", 0) == 0; });
  std::sort(metadata.begin(), metadata.end(),
            [](const Metadata& a, const Metadata& b) { return a.name < b.name; });
  return metadata;
}

void expect_same(const std::vector<Metadata>& a, const std::vector<Metadata>& b) {
  const auto first = without_derived(a), second = without_derived(b);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].name, second[i].name);
    EXPECT_EQ(first[i].type, second[i].type) << first[i].name;
    EXPECT_EQ(to_text(first[i]), to_text(second[i])) << first[i].name;
    EXPECT_EQ(first[i].bytes, second[i].bytes) << first[i].name;
  }
}

template <typename T>
Metadata metadata(const std::string& name, const std::string& type, const std::vector<T>& values) {
  Metadata entry{name, type, {}};
  const auto bytes = std::as_bytes(std::span(values));
  entry.bytes.assign(bytes.begin(), bytes.end());
  return entry;
}

}  // namespace

Grid random_grid(ValueType type, std::uint32_t seed, std::size_t bricks) {
  Random random(seed);
  Grid grid;
  grid.name = std::string(name_of(type)) + " " + std::to_string(seed);
  grid.type = type;
  const bool is_real = type == ValueType::float32 || type == ValueType::float64;
  grid.grid_class = is_real ? GridClass::level_set : GridClass::unknown;
  grid.background = random_value(type, random);
  // Rotated, scaled, mirrored and sheared: no number is round.
  grid.world_from_index = {
      {0.1, 0.0173, -0.03, 0}, {-0.02, 1.0 / 3, 0.007, 0}, {0.013, 0, -0.2, 0}, {1e5 / 7, -3, 0.1, 1}};
  grid.metadata = sample_metadata();
  for (const ivec3 origin : random_origins(bricks, kBrickEdge, random)) {
    Brick brick{origin};
    for (std::uint64_t& word : brick.active) word = std::uint64_t{random()} << 32 | random();
    if (grid.bricks.size() == 3) brick.active = {};  // A leaf without active voxels is one, too.
    grid.bricks.push_back(brick);
    for (std::size_t i = 0; i < kBrickVoxels; ++i) {
      const Value value = random_value(type, random);
      grid.values.insert(grid.values.end(), value.begin(),
                         value.begin() + static_cast<std::ptrdiff_t>(bytes_of(type)));
    }
  }
  for (const int edge : {8, 128, 4096}) add_tiles(grid, edge, 3, random);
  return grid;
}

Grid smoke_grid(const std::string& name, int radius) {
  Grid grid;
  grid.name = name;
  grid.grid_class = GridClass::fog_volume;
  grid.saved_as_half = true;
  grid.world_from_index = glm::dmat4(0.125);
  grid.world_from_index[3] = {-1, 2, 0.5, 1};
  const int end = (radius / kBrickEdge + 1) * kBrickEdge;
  for (int z = -end; z < end; z += kBrickEdge)
    for (int y = -end; y < end; y += kBrickEdge)
      for (int x = -end; x < end; x += kBrickEdge) {
        Brick brick{{x, y, z}};
        std::array<float, kBrickVoxels> values{};
        for (int v = 0; v < static_cast<int>(kBrickVoxels); ++v) {
          const glm::vec3 at(ivec3(x, y, z) + ivec3(v % 8, v / 8 % 8, v / 64));
          const float depth = static_cast<float>(radius) - glm::length(at);
          if (depth <= 0) continue;
          // Sixteenths are exact in half precision.
          values[static_cast<std::size_t>(v)] = std::floor(depth * 16) / 16 + 1.0f / 16;
          brick.active[static_cast<std::size_t>(v / 64)] |= std::uint64_t{1} << (v % 64);
        }
        if (brick.active == decltype(brick.active){}) continue;
        grid.bricks.push_back(brick);
        const auto bytes = std::as_bytes(std::span(values));
        grid.values.insert(grid.values.end(), bytes.begin(), bytes.end());
      }
  return grid;
}

Grid octant(const Grid& grid) {
  Grid part = grid;
  part.bricks.clear();
  part.values.clear();
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    if (glm::any(glm::lessThan(grid.bricks[i].origin, glm::ivec3(0)))) continue;
    part.bricks.push_back(grid.bricks[i]);
    const auto values = grid.values_of(i);
    part.values.insert(part.values.end(), values.begin(), values.end());
  }
  return part;
}

Grid huge_tile() {
  Grid grid;
  grid.name = "density";
  grid.grid_class = GridClass::fog_volume;
  const float one = 1;
  Tile tile{ivec3(0), 4096, true, {}};
  std::memcpy(tile.value.data(), &one, sizeof one);
  grid.tiles.push_back(tile);
  return grid;
}

std::vector<Metadata> sample_metadata() {
  return {metadata<char>("creator", "string", {'m', 'e', '\0', '\xff'}),
          metadata<float>("factor", "float", {0.1f}),
          metadata<double>("time", "double", {1.0 / 3}),
          metadata<std::int32_t>("frame", "int32", {-7}),
          metadata<std::int64_t>("seed", "int64", {INT64_MIN}),
          metadata<std::int32_t>("size", "vec3i", {64, 64, 96}),
          metadata<char>("flag", "bool", {1}),
          metadata<char>("is_saved_as_half_float", "bool", {0}),
          metadata<char>("other", "of no type", {1, 2, 3})};
}

void expect_same(const Grid& a, const Grid& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(a.grid_class, b.grid_class);
  EXPECT_EQ(a.saved_as_half, b.saved_as_half);
  EXPECT_EQ(std::memcmp(&a.world_from_index, &b.world_from_index, sizeof a.world_from_index), 0);
  EXPECT_EQ(a.background, b.background);
  expect_same(a.metadata, b.metadata);
  ASSERT_EQ(a.bricks.size(), b.bricks.size());
  for (std::size_t i = 0; i < a.bricks.size(); ++i) {
    ASSERT_EQ(a.bricks[i].origin, b.bricks[i].origin) << i;
    ASSERT_EQ(a.bricks[i].active, b.bricks[i].active) << i;
  }
  EXPECT_TRUE(a.values == b.values);
  ASSERT_EQ(a.tiles.size(), b.tiles.size());
  for (std::size_t i = 0; i < a.tiles.size(); ++i) {
    ASSERT_EQ(a.tiles[i].origin, b.tiles[i].origin) << i;
    EXPECT_EQ(a.tiles[i].edge, b.tiles[i].edge) << i;
    EXPECT_EQ(a.tiles[i].active, b.tiles[i].active) << i;
    EXPECT_EQ(a.tiles[i].value, b.tiles[i].value) << i;
  }
}

void expect_same(const GridFile& a, const GridFile& b) {
  expect_same(a.metadata, b.metadata);
  ASSERT_EQ(a.grids.size(), b.grids.size());
  for (std::size_t i = 0; i < a.grids.size(); ++i) {
    SCOPED_TRACE(a.grids[i].name);
    expect_same(a.grids[i], b.grids[i]);
  }
}

}  // namespace brume::grids
