#include "grids/brick_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <iterator>
#include <unordered_map>
#include <vector>

#include "core/box.hpp"
#include "core/tasks.hpp"

namespace brume::grids {
namespace {

/// Largest values within these bounds are stored as they are.
constexpr float kLeastHigh = 1.0f / 64, kMostHigh = 1024;
constexpr float kLargestValue = 1e30f;

/// Voxels of the ramp behind the surface of a level set, as sdfToFogVolume's default.
constexpr double kFogRamp = 3;

/// Reads values of a grid as the numbers that are rendered.
class Reader {
 public:
  explicit Reader(const Grid& grid)
      : type_(grid.type), bytes_(bytes_of(grid.type)), level_set_(grid.grid_class == GridClass::level_set) {
    ramp_ = kFogRamp * std::cbrt(std::abs(glm::determinant(glm::dmat3(grid.world_from_index))));
  }

  float at(const std::byte* values, std::size_t index) const {
    double value = number(values + index * bytes_);
    if (level_set_) value = std::min(-value / ramp_, 1.0);
    return value > 0 ? static_cast<float>(std::min<double>(value, kLargestValue)) : 0.0f;
  }

 private:
  template <typename T>
  static T read(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
  }
  double number(const std::byte* at) const {
    switch (type_) {
      case ValueType::float32:
        return double{read<float>(at)};
      case ValueType::float64:
        return read<double>(at);
      case ValueType::int32:
        return read<std::int32_t>(at);
      case ValueType::int64:
        return static_cast<double>(read<std::int64_t>(at));
      case ValueType::boolean:
        return read<std::uint8_t>(at);
      case ValueType::vec3f:
        return glm::length(glm::dvec3(read<glm::vec3>(at)));
      case ValueType::vec3d:
        return glm::length(read<glm::dvec3>(at));
      case ValueType::vec3i:
        return glm::length(glm::dvec3(read<glm::ivec3>(at)));
      case ValueType::mask:
        break;
    }
    return 0;
  }

  ValueType type_;
  std::size_t bytes_;
  bool level_set_;
  double ramp_ = 1;
};

using Values = std::array<float, kBrickVoxels>;

struct Hash {
  std::size_t operator()(glm::ivec3 p) const {
    const auto mix = [](std::uint64_t a, std::int32_t b) {
      return (a ^ static_cast<std::uint32_t>(b)) * 0x9e3779b97f4a7c15ull;
    };
    return mix(mix(mix(0, p.x), p.y), p.z) >> 16;
  }
};

/// Bricks of numbers by brick coordinate, some of them of one value.
struct Numbers {
  std::unordered_map<glm::ivec3, std::size_t, Hash> index;  ///< Into bricks.
  std::vector<glm::ivec3> at;
  std::vector<Values> bricks;

  Values& add(glm::ivec3 brick) {
    const auto [found, added] = index.try_emplace(brick, bricks.size());
    if (added) {
      at.push_back(brick);
      bricks.emplace_back().fill(0);
    }
    return bricks[found->second];
  }
  const Values* find(glm::ivec3 brick) const {
    const auto found = index.find(brick);
    return found == index.end() ? nullptr : &bricks[found->second];
  }
};

glm::ivec3 brick_of(glm::ivec3 origin) {
  return origin >> 3;
}

/// Adds the bricks of a tile. False where there are more than `limit`.
bool add_tile(const Tile& tile, float value, std::size_t limit, Numbers& numbers) {
  const int bricks = static_cast<int>(tile.edge / 8);
  const auto volume = static_cast<std::uint64_t>(bricks) * static_cast<std::uint64_t>(bricks) *
                      static_cast<std::uint64_t>(bricks);
  if (volume > limit - std::min<std::uint64_t>(limit, numbers.bricks.size())) return false;
  const glm::ivec3 first = brick_of(tile.origin);
  for (int z = 0; z < bricks; ++z)
    for (int y = 0; y < bricks; ++y)
      for (int x = 0; x < bricks; ++x) numbers.add(first + glm::ivec3(x, y, z)).fill(value);
  return true;
}

/// The numbers of a grid, without bricks of zeros.
Result<Numbers> numbers_of(const Grid& grid, std::size_t limit) {
  const Reader reader(grid);
  Numbers numbers;
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    const std::byte* const values = grid.values_of(i).data();
    Values brick;
    bool any = false;
    for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
      brick[voxel] = reader.at(values, voxel);
      any |= brick[voxel] > 0;
    }
    if (any) numbers.add(brick_of(grid.bricks[i].origin)) = brick;
  }
  for (const Tile& tile : grid.tiles) {
    const float value = reader.at(tile.value.data(), 0);
    if (value > 0 && !add_tile(tile, value, limit, numbers))
      return Failure{ErrorCode::resource_limit,
                     "grid " + grid.name + ": its constant regions are larger than " + std::to_string(limit) +
                         " bricks of 8^3 voxels; make them sparser"};
  }
  return numbers;
}

/// Means over 2^3 voxels. Adds the squares of what they lose to `square_error`.
Numbers halved(const Numbers& fine, double& square_error) {
  Numbers coarse;
  for (std::size_t i = 0; i < fine.bricks.size(); ++i) {
    const glm::ivec3 to = fine.at[i] >> 1, octant = (fine.at[i] & 1) * 4;
    Values& brick = coarse.add(to);
    const Values& from = fine.bricks[i];
    for (int voxel = 0; voxel < 64; ++voxel) {
      const glm::ivec3 p(voxel & 3, voxel >> 2 & 3, voxel >> 4);
      const auto number = [](glm::ivec3 q) { return static_cast<std::size_t>(q.x + 8 * (q.y + 8 * q.z)); };
      double sum = 0, squares = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const double value =
            double{from[number(2 * p + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2))]};
        sum += value;
        squares += value * value;
      }
      square_error += squares - sum * sum / 8;
      brick[number(octant + p)] = static_cast<float>(sum / 8);
    }
  }
  return coarse;
}

/// The bricks beside a brick into which filtering carries one of its values: bit of the neighbour
/// x + 3 y + 9 z, itself in the middle.
std::uint32_t neighbours_reached(const Values& values) {
  std::uint32_t reached = 0;
  for (int voxel = 0; voxel < int{kBrickVoxels}; ++voxel) {
    if (values[static_cast<std::size_t>(voxel)] <= 0) continue;
    const glm::ivec3 p(voxel & 7, voxel >> 3 & 7, voxel >> 6);
    const glm::ivec3 low(p.x == 0 ? 0 : 1, p.y == 0 ? 0 : 1, p.z == 0 ? 0 : 1);
    const glm::ivec3 high(p.x == 7 ? 2 : 1, p.y == 7 ? 2 : 1, p.z == 7 ? 2 : 1);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) reached |= 1u << (x + 3 * y + 9 * z);
  }
  return reached;
}

/// All bricks in which a filtered value can differ from 0, rising.
std::vector<glm::ivec3> sampled_bricks(const Numbers& numbers) {
  std::vector<std::uint32_t> reached(numbers.bricks.size());
  parallel_for(numbers.bricks.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) reached[i] = neighbours_reached(numbers.bricks[i]);
  });
  std::vector<glm::ivec3> bricks;
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (int n = 0; n < 27; ++n)
      if (reached[i] >> n & 1u) bricks.push_back(numbers.at[i] + glm::ivec3(n % 3, n / 3 % 3, n / 9) - 1);
  std::sort(bricks.begin(), bricks.end(), goes_before);
  bricks.erase(std::unique(bricks.begin(), bricks.end()), bricks.end());
  return bricks;
}

/// The texels of a brick with its apron.
void fill_texels(const Numbers& numbers, float per_value, glm::ivec3 brick, std::span<std::uint16_t> texels) {
  std::array<const Values*, 27> around{};
  for (int n = 0; n < 27; ++n)
    around[static_cast<std::size_t>(n)] = numbers.find(brick + glm::ivec3(n % 3, n / 3 % 3, n / 9) - 1);
  std::size_t out = 0;
  for (int z = -1; z <= 8; ++z)
    for (int y = -1; y <= 8; ++y)
      for (int x = -1; x <= 8; ++x, ++out) {
        const glm::ivec3 p(x, y, z), side = (p >> 3) + 1, q = p & 7;
        const Values* const values = around[static_cast<std::size_t>(side.x + 3 * side.y + 9 * side.z)];
        texels[out] = values ? glm::packHalf1x16(
                                   per_value * (*values)[static_cast<std::size_t>(q.x + 8 * (q.y + 8 * q.z))])
                             : std::uint16_t{0};
      }
}

/// Around all that filtering carries the values to: half a voxel beyond their own.
Box<float> bounds_of(const Numbers& numbers) {
  Box<float> bounds = kEmptyBox;
  for (std::size_t i = 0; i < numbers.bricks.size(); ++i)
    for (int voxel = 0; voxel < int{kBrickVoxels}; ++voxel) {
      if (numbers.bricks[i][static_cast<std::size_t>(voxel)] <= 0) continue;
      const glm::vec3 p(numbers.at[i] * 8 + glm::ivec3(voxel & 7, voxel >> 3 & 7, voxel >> 6));
      bounds = united(bounds, {p - 0.5f, p + 1.5f});
    }
  return bounds;
}

/// Needs the range of the values.
void count_values(const Numbers& numbers, BrickVolume& out) {
  if (out.high <= out.low) return;
  out.histogram.assign(kHistogramBins, 0);
  const float per_value = static_cast<float>(kHistogramBins) / (out.high - out.low);
  for (const Values& brick : numbers.bricks)
    for (const float value : brick) {
      if (value <= 0) continue;
      const auto bin = static_cast<std::size_t>(per_value * (value - out.low));
      ++out.histogram[std::min(bin, kHistogramBins - 1)];
    }
}

/// Range, sum and distribution of the values.
void measure(const Numbers& numbers, BrickVolume& out) {
  glm::dvec3 places(0), squares(0);
  out.low = numbers.bricks.empty() ? 0 : kLargestValue;
  for (std::size_t i = 0; i < numbers.bricks.size(); ++i)
    for (int voxel = 0; voxel < int{kBrickVoxels}; ++voxel) {
      const float value = numbers.bricks[i][static_cast<std::size_t>(voxel)];
      out.low = std::min(out.low, value);
      out.high = std::max(out.high, value);
      const glm::dvec3 p(numbers.at[i] * 8 + glm::ivec3(voxel & 7, voxel >> 3 & 7, voxel >> 6));
      out.sum += double{value};
      places += double{value} * (p + 0.5);
      squares += double{value} * (p + 0.5) * (p + 0.5);
    }
  if (out.sum <= 0) return;
  count_values(numbers, out);
  if (out.high < kLeastHigh || out.high > kMostHigh) out.unit = std::exp2(std::floor(std::log2(out.high)));
  out.mean = places / out.sum;
  out.deviation = glm::sqrt(glm::max(squares / out.sum - out.mean * out.mean, 0.0));
}

std::unique_ptr<volume::SparseVolume> fill_volume(const Numbers& numbers, float unit,
                                                  const std::vector<glm::ivec3>& bricks,
                                                  const Box<float>& bounds) {
  volume::SparseVolumeInfo info;
  info.channels = {{sizeof(std::uint16_t)}};
  auto volume = std::make_unique<volume::SparseVolume>(info);
  const volume::ChannelId channel{0};
  volume->begin_update();
  std::vector<std::uint32_t> slots;
  slots.reserve(bricks.size());
  for (const glm::ivec3 brick : bricks) slots.push_back(volume->acquire(brick));
  parallel_for(bricks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      fill_texels(numbers, 1 / unit, bricks[i], volume->texels<std::uint16_t>(channel, slots[i]));
  });
  volume->set_bounds(bounds.empty() ? glm::vec3(0) : bounds.low, bounds.empty() ? glm::vec3(0) : bounds.high);
  volume->end_update();
  return volume;
}

/// The bricks of both, rising.
std::vector<glm::ivec3> sampled_bricks(const Numbers& numbers, const Numbers& also) {
  const std::vector<glm::ivec3> a = sampled_bricks(numbers), b = sampled_bricks(also);
  std::vector<glm::ivec3> both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both), goes_before);
  return both;
}

}  // namespace

Result<BrickVolume> make_brick_volume(const Grid& grid, const BrickVolumeOptions& options) {
  if (grid.type == ValueType::mask)
    return Failure{ErrorCode::bad_input, "grid " + grid.name + ": is a mask, which has no values to render"};
  constexpr std::size_t kMostBricks = std::size_t{1} << 23;
  auto numbers = numbers_of(grid, kMostBricks);
  if (!numbers) return numbers.failure();
  auto also = options.also ? numbers_of(*options.also, kMostBricks) : Result<Numbers>(Numbers());
  if (!also) return also.failure();
  BrickVolume out;
  double square_error = 0;
  std::vector<glm::ivec3> bricks = sampled_bricks(*numbers, *also);
  while (bricks.size() > options.max_bricks) {
    // Each level's error counts once per voxel of the file.
    double lost = 0, ignored = 0;
    *numbers = halved(*numbers, lost);
    *also = halved(*also, ignored);
    square_error += lost * std::exp2(3 * out.level);
    ++out.level;
    bricks = sampled_bricks(*numbers, *also);
  }
  measure(*numbers, out);
  out.volume = fill_volume(*numbers, out.unit, bricks, united(bounds_of(*numbers), bounds_of(*also)));
  const auto active = static_cast<double>(count_active(grid));
  out.rms_error = active > 0 ? std::sqrt(square_error / active) : 0;
  // Voxel i of level l has its centre at index 2^l (i + 1/2) - 1/2.
  const double scale = std::exp2(out.level);
  out.world_from_voxel = grid.world_from_index * glm::translate(glm::dmat4(1), glm::dvec3(-0.5)) *
                         glm::scale(glm::dmat4(1), glm::dvec3(scale));
  return out;
}

}  // namespace brume::grids
