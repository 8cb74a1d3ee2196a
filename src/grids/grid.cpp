#include "grids/grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <tuple>

#include "core/error.hpp"

namespace brume::grids {

std::size_t bytes_of(ValueType type) {
  switch (type) {
    case ValueType::mask:
      return 0;
    case ValueType::boolean:
      return 1;
    case ValueType::float32:
    case ValueType::int32:
      return 4;
    case ValueType::float64:
    case ValueType::int64:
      return 8;
    case ValueType::vec3f:
    case ValueType::vec3i:
      return 12;
    case ValueType::vec3d:
      return 24;
  }
  BRUME_ASSERT(false, std::to_string(int(type)));
  return 0;
}

const char* name_of(ValueType type) {
  constexpr std::array kNames{"",        "float32", "float64", "int32", "int64",
                              "boolean", "mask",    "vec3f",   "vec3d", "vec3i"};
  return kNames.at(static_cast<std::size_t>(type));
}

const char* name_of(GridClass grid_class) {
  constexpr std::array kNames{"unknown", "level set", "fog volume", "staggered"};
  return kNames.at(static_cast<std::size_t>(grid_class));
}

std::uint64_t count_active(const Grid& grid) {
  std::uint64_t count = 0;
  for (const Brick& brick : grid.bricks)
    for (const std::uint64_t word : brick.active) count += static_cast<std::uint64_t>(std::popcount(word));
  for (const Tile& tile : grid.tiles)
    if (tile.active) count += std::uint64_t{tile.edge} * tile.edge * tile.edge;
  return count;
}

bool any_above(const Grid& grid, double value) {
  return !for_each_active(grid, [&](const ActiveValue& active) {
    const double number = to_number(grid.type, active.value);
    return !(number > value && std::isfinite(number));
  });
}

bool is_level_set(const Grid& grid) {
  if (grid.grid_class == GridClass::level_set) return true;
  if (grid.grid_class != GridClass::unknown) return false;
  if (grid.type != ValueType::float32 && grid.type != ValueType::float64) return false;
  const double background = to_number(grid.type, grid.background.data());
  if (!(background > 0)) return false;
  // Rounding of halves.
  const double most = background * (1 + 1e-3);
  bool inside = false, outside = false;
  const bool all_may_be = for_each_active(grid, [&](const ActiveValue& active) {
    const double value = to_number(grid.type, active.value);
    inside = inside || value < 0;
    outside = outside || value > 0;
    return std::abs(value) <= most;
  });
  return all_may_be && inside && outside;
}

Box<double> active_bounds(const Grid& grid) {
  glm::i64vec3 low(INT64_MAX), high(INT64_MIN);
  const auto add = [&](glm::i64vec3 first, glm::i64vec3 end) {
    low = glm::min(low, first);
    high = glm::max(high, end);
  };
  for (const Brick& brick : grid.bricks) {
    std::uint64_t any = 0;
    for (int z = 0; z < kBrickEdge; ++z) {
      const std::uint64_t word = brick.active[static_cast<std::size_t>(z)];
      any |= word;
      if (word == 0) continue;
      const int first_y = std::countr_zero(word) / 8, last_y = 7 - std::countl_zero(word) / 8;
      add(glm::i64vec3(brick.origin) + glm::i64vec3(8, first_y, z),
          glm::i64vec3(brick.origin) + glm::i64vec3(0, last_y + 1, z + 1));
    }
    if (any == 0) continue;
    // Along x over all rows; y and z of these corners lie inside of what was added above.
    for (const int half : {32, 16, 8}) any |= any >> half;
    const auto row = static_cast<std::uint8_t>(any);
    add(glm::i64vec3(brick.origin) + glm::i64vec3(std::countr_zero(row), 8, 8),
        glm::i64vec3(brick.origin) + glm::i64vec3(8 - std::countl_zero(row), 0, 0));
  }
  for (const Tile& tile : grid.tiles)
    if (tile.active) add(glm::i64vec3(tile.origin), glm::i64vec3(tile.origin) + std::int64_t{tile.edge});
  if (low.x > high.x) return {glm::dvec3(1), glm::dvec3(-1)};
  return {glm::dvec3(low) - 0.5, glm::dvec3(high) - 0.5};
}

std::uint64_t memory_of(const Grid& grid) {
  return grid.bricks.size() * sizeof(Brick) + grid.values.size() + grid.tiles.size() * sizeof(Tile);
}

bool goes_before(glm::ivec3 a, glm::ivec3 b) {
  return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
}

std::optional<std::size_t> find_brick(const Grid& grid, glm::ivec3 origin) {
  const auto found =
      std::lower_bound(grid.bricks.begin(), grid.bricks.end(), origin,
                       [](const Brick& brick, glm::ivec3 at) { return goes_before(brick.origin, at); });
  if (found == grid.bricks.end() || found->origin != origin) return std::nullopt;
  return static_cast<std::size_t>(found - grid.bricks.begin());
}

namespace {

template <typename T>
T read_as(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace

double to_number(ValueType type, const std::byte* bytes) {
  switch (type) {
    case ValueType::float32:
      return static_cast<double>(read_as<float>(bytes));
    case ValueType::float64:
      return read_as<double>(bytes);
    case ValueType::int32:
      return static_cast<double>(read_as<std::int32_t>(bytes));
    case ValueType::int64:
      return static_cast<double>(read_as<std::int64_t>(bytes));
    case ValueType::boolean:
      return static_cast<double>(read_as<std::uint8_t>(bytes));
    case ValueType::mask:
      return 1;
    case ValueType::vec3f:
      return glm::length(glm::dvec3(read_as<glm::vec3>(bytes)));
    case ValueType::vec3d:
      return glm::length(read_as<glm::dvec3>(bytes));
    case ValueType::vec3i:
      return glm::length(glm::dvec3(read_as<glm::ivec3>(bytes)));
  }
  return 0;
}

}  // namespace brume::grids
