#include "grids/grid_numbers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <mutex>
#include <numeric>

#include "core/tasks.hpp"

namespace brume::grids {
namespace {

/// Voxels of the ramp behind the surface of a level set, as sdfToFogVolume's default.
constexpr double kFogRamp = 3;

template <typename T>
T read(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

std::size_t voxel_number(glm::ivec3 v) {
  return static_cast<std::size_t>(v.x + 8 * (v.y + 8 * v.z));
}

/// A value kFarBeyond times as large as all but a part kOutliers of them is ignored: half floats are scaled
/// to the largest value, and would have no precision left for the rest.
constexpr double kOutliers = 1e-3, kFarBeyond = 1024;

/// How many values there are of each power of two, and the largest of each.
struct Magnitudes {
  static constexpr int kLeast = -160, kMost = 100;
  std::array<std::uint64_t, kMost - kLeast + 1> counts{};
  std::array<double, kMost - kLeast + 1> largest{};
  std::uint64_t odd = 0;  ///< NaN, infinite or beyond NumberReader::kLargest.

  void add(double value) {
    if (!(std::abs(value) <= double{NumberReader::kLargest})) {
      ++odd;
    } else if (value > 0) {
      const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(value) >> 52) - 1023;
      const auto power = static_cast<std::size_t>(std::clamp(exponent, kLeast, kMost) - kLeast);
      ++counts[power];
      largest[power] = std::max(largest[power], value);
    }
  }
  void add(const Magnitudes& other) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      counts[i] += other.counts[i];
      largest[i] = std::max(largest[i], other.largest[i]);
    }
    odd += other.odd;
  }
  /// The largest value but for outliers, whose number is added to `odd`.
  double largest_but_outliers() {
    std::uint64_t all = 0, above = 0;
    for (const std::uint64_t count : counts) all += count;
    const auto few = static_cast<std::uint64_t>(kOutliers * static_cast<double>(all));
    std::size_t i = counts.size();
    while (i-- > 0 && (above += counts[i]) <= few) continue;
    if (above == 0) return 0;
    const double limit = kFarBeyond * largest[i];
    for (i = counts.size() - 1; std::ldexp(1.0, static_cast<int>(i) + kLeast) > limit; --i) odd += counts[i];
    while (counts[i] == 0) --i;
    return largest[i];
  }
};

}  // namespace

NumberReader::NumberReader(const Grid& grid, const std::optional<ValueShift>& shift)
    : type_(grid.type),
      bytes_(bytes_of(grid.type)),
      level_set_(is_level_set(grid)),
      is_plain_(type_ == ValueType::float32 && !level_set_ && !shift),
      shift_(level_set_ ? std::nullopt : shift) {
  ramp_ = kFogRamp * std::cbrt(std::abs(glm::determinant(glm::dmat3(grid.world_from_index))));
  find_most(grid);
}

void NumberReader::find_most(const Grid& grid) {
  std::mutex mutex;
  Magnitudes all;
  parallel_for(grid.bricks.size(), 256, [&](std::size_t begin, std::size_t end) {
    Magnitudes some;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel)
        some.add(number(grid.values_of(i).data() + voxel * bytes_));
    const std::lock_guard lock(mutex);
    all.add(some);
  });
  for (const Tile& tile : grid.tiles) all.add(number(tile.value.data()));
  const double most = level_set_ || shift_ ? std::ranges::max(all.largest) : all.largest_but_outliers();
  odd_ = all.odd;
  if (odd_ > 0) most_ = level_set_ ? 1 : static_cast<float>(most);
}

float NumberReader::converted(const std::byte* at) const {
  double value = number(at);
  if (level_set_) value = std::min(-value / ramp_, 1.0);
  if (shift_) {
    if (std::isnan(value)) value = 0;
    value = std::clamp(value, double{shift_->least}, std::max(double{most_}, double{shift_->least}));
    return static_cast<float>(value - double{shift_->offset});
  }
  return value > 0 ? static_cast<float>(std::min<double>(value, most_)) : 0.0f;
}

double NumberReader::number(const std::byte* at) const {
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

GridNumbers::GridNumbers(const Grid& grid, const std::optional<ValueShift>& shift) : reader_(grid, shift) {
  std::vector<std::uint8_t> any(grid.bricks.size());
  parallel_for(grid.bricks.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::byte* const values = grid.values_of(i).data();
      for (std::size_t voxel = 0; voxel < kBrickVoxels && any[i] == 0; ++voxel)
        any[i] = reader_.at(values, voxel) > 0;
    }
  });
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    if (any[i] == 0) continue;
    at_.push_back(grid.bricks[i].origin >> 3);
    sources_.push_back({grid.values_of(i).data(), nullptr, nullptr, 0});
  }
  for (const Tile& tile : grid.tiles)
    if (const float number = reader_.at(tile.value.data(), 0); number > 0)
      add_cube({tile.origin >> 3, static_cast<int>(tile.edge / 8), number});
  if (shift) add_background(grid);
}

void GridNumbers::move(const glm::ivec3& bricks) {
  for (glm::ivec3& at : at_) at += bricks;
  for (Cube& cube : cubes_) cube.origin += bricks;
}

void GridNumbers::add_background(const Grid& grid) {
  constexpr std::uint64_t kMost = 1u << 18;
  const float number = background(grid);
  if (!(number > 0) || brick_count() == 0) return;
  const Box<int> box = brick_box();
  const glm::u64vec3 size(box.high - box.low);
  if (size.x > kMost || size.y > kMost || size.z > kMost || size.x * size.y * size.z > kMost) return;
  // Bricks that are there, or in cubes, are taken.
  std::vector<bool> taken(size.x * size.y * size.z);
  const auto place_of = [&](glm::ivec3 at) {
    const glm::u64vec3 p(at - box.low);
    return p.x + size.x * (p.y + size.y * p.z);
  };
  for (const glm::ivec3 at : at_) taken[place_of(at)] = true;
  for (const Cube& cube : cubes_)
    for_each_in(Box<int>{cube.origin, cube.origin + cube.edge},
                [&](glm::ivec3 at) { taken[place_of(at)] = true; });
  for_each_in(box, [&](glm::ivec3 at) {
    if (!taken[place_of(at)]) add_cube({at, 1, number});
  });
}

GridNumbers::GridNumbers(const volume::SparseVolume& volume, bool only_presence) : reader_(Grid()) {
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
    const auto texels = volume.texels<std::uint16_t>(volume::ChannelId{0}, slot);
    at_.push_back(volume.brick_of(slot));
    sources_.push_back({nullptr, only_presence ? nullptr : texels.data(), nullptr, 1});
  }
  for (const volume::UniformBrick& brick : volume.uniform_bricks()) {
    at_.push_back(brick.at);
    sources_.push_back({nullptr, nullptr, nullptr, only_presence ? 1 : glm::unpackHalf1x16(brick.texel)});
  }
}

bool GridNumbers::is_uniform(std::size_t i) const {
  const Source& source = sources_[i];
  if (!source.values && !source.halves && !source.numbers) return true;
  const float first = at(i, 0);
  for (std::size_t voxel = 1; voxel < kBrickVoxels; ++voxel)
    if (at(i, voxel) != first) return false;
  return true;
}

float GridNumbers::half_at(const std::uint16_t* texels, std::size_t voxel) {
  return glm::unpackHalf1x16(texels[111 + voxel % 8 + 10 * (voxel / 8 % 8) + 100 * (voxel / 64)]);
}

void GridNumbers::add_cube(const Cube& cube) {
  if (cube.edge > 1) {
    cubes_.push_back(cube);
    return;
  }
  at_.push_back(cube.origin);
  sources_.push_back({nullptr, nullptr, nullptr, cube.number});
}

GridNumbers GridNumbers::halved(bool by_power, double& square_error) const {
  // The bricks that share a coarse one, one behind the other.
  std::vector<std::uint32_t> order(at_.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto coarse_at = [&](std::uint32_t i) { return at_[i] >> 1; };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (coarse_at(a) != coarse_at(b)) return goes_before(coarse_at(a), coarse_at(b));
    return a < b;
  });
  std::vector<std::size_t> first;
  GridNumbers coarse(reader_);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && coarse_at(order[i]) == coarse_at(order[i - 1])) continue;
    first.push_back(i);
    coarse.at_.push_back(coarse_at(order[i]));
  }
  first.push_back(order.size());

  // Their means. The errors are summed in order, whatever thread found them.
  const std::size_t count = coarse.at_.size();
  coarse.owned_.resize(count);
  coarse.sources_.resize(count);
  std::vector<double> lost(count);
  parallel_for(count, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      coarse.owned_[i] = std::make_unique<BrickNumbers>();
      coarse.sources_[i].numbers = coarse.owned_[i].get();
      for (std::size_t from = first[i]; from < first[i + 1]; ++from) {
        const std::uint32_t fine = order[from];
        const glm::ivec3 octant = (at_[fine] & 1) * 4;
        for (int voxel = 0; voxel < 64; ++voxel) {
          const glm::ivec3 p(voxel & 3, voxel >> 2 & 3, voxel >> 4);
          double sum = 0, squares = 0, fourths = 0;
          for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 q = 2 * p + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
            const double value{at(fine, voxel_number(q))};
            sum += value;
            squares += value * value;
            fourths += value * value * value * value;
          }
          const double mean = by_power ? std::sqrt(std::sqrt(fourths / 8)) : sum / 8;
          lost[i] += squares - 2 * mean * sum + 8 * mean * mean;
          (*coarse.owned_[i])[voxel_number(octant + p)] = static_cast<float>(mean);
        }
      }
    }
  });
  square_error = std::accumulate(lost.begin(), lost.end(), square_error);

  // Cubes begin at multiples of their edge, so that half of one is one.
  for (const Cube& cube : cubes_) coarse.add_cube({cube.origin >> 1, cube.edge / 2, cube.number});
  return coarse;
}

std::uint64_t GridNumbers::brick_count() const {
  std::uint64_t count = at_.size();
  for (const Cube& cube : cubes_) {
    const auto edge = static_cast<std::uint64_t>(cube.edge);
    count += edge * edge * edge;
  }
  return count;
}

Box<int> GridNumbers::brick_box() const {
  Box<int> box;
  bool any = false;
  const auto add = [&](const Box<int>& other) {
    box = any ? united(box, other) : other;
    any = true;
  };
  for (const glm::ivec3 at : at_) add({at, at + 1});
  for (const Cube& cube : cubes_) add({cube.origin, cube.origin + cube.edge});
  return box;
}

glm::ivec3 GridNumbers::middle_brick() const {
  glm::ivec3 middle(0);
  std::vector<int> along;
  for (int axis = 0; axis < 3; ++axis) {
    along.clear();
    for (const glm::ivec3 at : at_) along.push_back(at[axis]);
    for (const Cube& cube : cubes_) along.push_back(cube.origin[axis] + cube.edge / 2);
    if (along.empty()) break;
    const auto half = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
    std::ranges::nth_element(along, half);
    middle[axis] = *half;
  }
  return middle;
}

void GridNumbers::expand_cubes() {
  for (const Cube& cube : cubes_)
    for_each_in(Box<int>{cube.origin, cube.origin + cube.edge}, [&](glm::ivec3 brick) {
      at_.push_back(brick);
      sources_.push_back({nullptr, nullptr, nullptr, cube.number});
    });
  cubes_.clear();
}

}  // namespace brume::grids
