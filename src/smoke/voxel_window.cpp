#include "smoke/voxel_window.hpp"

namespace brume::smoke {
namespace {

constexpr std::uint64_t kColumn0 = 0x0101010101010101u;
constexpr std::uint64_t kColumn7 = kColumn0 << 7;

/// For voxels of a layer, the cells that take from them along x, voxel - 2 to voxel + 1: in the brick before,
/// this one and the next. The number of a cell in its brick is one more than its place.
std::array<std::uint64_t, 3> spread_x(std::uint64_t v) {
  const std::uint64_t last = v & kColumn7, second = v & kColumn7 >> 1;
  return {(v & kColumn0) << 7,
          v | (v >> 1 & ~kColumn7) | (v << 1 & ~kColumn0) | (v << 2 & ~(kColumn0 | kColumn0 << 1)),
          last >> 7 | last >> 6 | second >> 6};
}
/// The same along y.
std::array<std::uint64_t, 3> spread_y(std::uint64_t v) {
  const std::uint64_t last = v >> 56, second = v >> 48 & 0xff;
  return {v << 56, v | v >> 8 | v << 8 | v << 16, last | last << 8 | second};
}

/// The cells with any bit set among the voxels from kFirst on, kCount along each axis, of the 4^3 around
/// them.
template <std::size_t kFirst, std::size_t kCount>
BrickBits cells_with_any(const VoxelWindow& window) {
  // Joined along z, then y, then x.
  BrickBits cells{};
  for (std::size_t z = 0; z < 8; ++z) {
    std::array<unsigned, 11> layers{};
    for (std::size_t y = 0; y < 11; ++y)
      for (std::size_t k = kFirst; k < kFirst + kCount; ++k) layers[y] |= window[z + k][y];
    for (std::size_t y = 0; y < 8; ++y) {
      unsigned row = 0, any = 0;
      for (std::size_t j = kFirst; j < kFirst + kCount; ++j) row |= layers[y + j];
      for (std::size_t i = kFirst; i < kFirst + kCount; ++i) any |= row >> i;
      cells[z] |= std::uint64_t{any & 0xff} << (8 * y);
    }
  }
  return cells;
}

}  // namespace

VoxelWindow make_window(const std::array<const BrickBits*, 27>& around) {
  VoxelWindow window;
  const auto byte = [&](std::size_t i, int y, int z) -> unsigned {
    if (!around[i]) return 0;
    return static_cast<std::uint8_t>((*around[i])[static_cast<std::size_t>(z & 7)] >> (8 * (y & 7)));
  };
  for (int z = -2; z < 9; ++z)
    for (int y = -2; y < 9; ++y) {
      const auto i = static_cast<std::size_t>(3 * ((y >> 3) + 1) + 9 * ((z >> 3) + 1));
      window[static_cast<std::size_t>(z + 2)][static_cast<std::size_t>(y + 2)] = static_cast<std::uint16_t>(
          byte(i, y, z) >> 6 | byte(i + 1, y, z) << 2 | (byte(i + 2, y, z) & 1) << 10);
    }
  return window;
}

std::array<const BrickBits*, 27> solid_around(const voxel::BitGrid& grid, glm::ivec3 brick) {
  std::array<const BrickBits*, 27> around{};
  const glm::ivec3 bricks = (grid.size() + 7) >> 3;
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 b = brick + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    if (glm::all(glm::greaterThanEqual(b, glm::ivec3(0))) && glm::all(glm::lessThan(b, bricks)))
      around[static_cast<std::size_t>(i)] = grid.find_brick(b);
  }
  return around;
}

Neighbourhood64 neighbourhood_of(const VoxelWindow& window, std::uint32_t number) {
  Neighbourhood64 voxels = 0;
  const unsigned x = number & 7;
  const std::size_t y = number >> 3 & 7, z = number >> 6;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      voxels |= static_cast<Neighbourhood64>(window[z + k][y + j] >> x & 15) << (4 * j + 16 * k);
  return voxels;
}

BrickBits cells_at_solid(const VoxelWindow& solid) {
  return cells_with_any<1, 2>(solid);
}

BrickBits cells_near_smoke(const VoxelWindow& smoke) {
  return cells_with_any<0, 4>(smoke);
}

std::array<BrickBits, 27> cells_that_take(const BrickBits& voxels) {
  std::array<BrickBits, 27> cells{};
  for (int z = 0; z < 8; ++z) {
    const std::uint64_t layer = voxels[static_cast<std::size_t>(z)];
    if (layer == 0) continue;
    const auto by_x = spread_x(layer);
    for (std::size_t x = 0; x < 3; ++x) {
      const auto by_y = spread_y(by_x[x]);
      for (std::size_t y = 0; y < 3; ++y)
        for (int to = z - 1; to <= z + 2; ++to)
          cells[x + 3 * y + 9 * static_cast<std::size_t>((to >> 3) + 1)][static_cast<std::size_t>(to & 7)] |=
              by_y[y];
    }
  }
  return cells;
}

}  // namespace brume::smoke
