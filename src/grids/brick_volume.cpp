#include "grids/brick_volume.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <iterator>
#include <limits>

#include "core/box.hpp"
#include "core/tasks.hpp"
#include "grids/grid_numbers.hpp"

namespace brume::grids {
namespace {

/// Largest values within these bounds are stored as they are.
constexpr float kLeastHigh = 1.0f / 64, kMostHigh = 1024;
/// Enough for any grid: indices have 32 bits.
constexpr int kMostHalvings = 29;

glm::ivec3 voxel_at(int voxel) {
  return {voxel & 7, voxel >> 3 & 7, voxel >> 6};
}

/// The bricks beside a brick into which filtering carries one of its values: bit of the neighbour
/// x + 3 y + 9 z, itself in the middle.
std::uint32_t neighbours_reached(const GridNumbers& numbers, std::size_t i) {
  std::uint32_t reached = 0;
  for (int voxel = 0; voxel < int{kBrickVoxels}; ++voxel) {
    if (numbers.at(i, static_cast<std::size_t>(voxel)) <= 0) continue;
    const glm::ivec3 p = voxel_at(voxel);
    const glm::ivec3 low(p.x == 0 ? 0 : 1, p.y == 0 ? 0 : 1, p.z == 0 ? 0 : 1);
    const glm::ivec3 high(p.x == 7 ? 2 : 1, p.y == 7 ? 2 : 1, p.z == 7 ? 2 : 1);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) reached |= 1u << (x + 3 * y + 9 * z);
  }
  return reached;
}

constexpr std::uint32_t kItself = 1u << 13;

glm::ivec3 neighbour(glm::ivec3 brick, int n) {
  return brick + glm::ivec3(n % 3, n / 3 % 3, n / 9) - 1;
}

/// Bricks of numbers that are looked at per brick that fits: those inside of something dense are uniform.
constexpr std::uint32_t kNumbersPerBrick = 16;

/// What a volume may take.
struct Room {
  std::uint32_t bricks = 0, pages = 0;
  std::uint32_t numbers = 0;  ///< Bricks of the level that is indexed, uniform ones included.
};

/// A level of a grid: its numbers, where each brick of them is, and all bricks in which a filtered value can
/// differ from 0, rising.
struct Level {
  GridNumbers numbers;
  volume::PageTable index;
  std::vector<glm::ivec3> sampled;

  bool is_filtered = true;  ///< False: nothing is carried beyond the bricks of the numbers.

  explicit Level(GridNumbers values, bool filtered = true)
      : numbers(std::move(values)), is_filtered(filtered) {}

  /// Whether the numbers may be indexed: their bricks are few and near enough.
  bool may_fit(const Room& room) const {
    if (numbers.brick_count() > room.numbers) return false;
    const Box<int> box = numbers.brick_box();
    const glm::dvec3 nodes = glm::dvec3((box.high >> 3) - (box.low >> 3)) + 1.0;
    return nodes.x * nodes.y * nodes.z <= static_cast<double>(room.pages);
  }
  void find_sampled() {
    numbers.expand_cubes();
    for (std::size_t i = 0; i < numbers.size(); ++i)
      index.set(numbers.brick(i), static_cast<std::uint32_t>(i));
    std::vector<std::uint32_t> reached(numbers.size());
    parallel_for(numbers.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        reached[i] = is_filtered ? neighbours_reached(numbers, i) : kItself;
    });
    sampled.clear();
    for (std::size_t i = 0; i < reached.size(); ++i) {
      if (reached[i] != 0) sampled.push_back(numbers.brick(i));
      for (int n = 0; n < 27; ++n)
        if ((reached[i] >> n & 1u) != 0 &&
            index.at(neighbour(numbers.brick(i), n)) == volume::PageTable::kNoSlot)
          sampled.push_back(neighbour(numbers.brick(i), n));
    }
    std::sort(sampled.begin(), sampled.end(), goes_before);
    sampled.erase(std::unique(sampled.begin(), sampled.end()), sampled.end());
  }
};

/// Entries of the page table of these bricks.
std::uint64_t page_count(const std::vector<glm::ivec3>& bricks) {
  if (bricks.empty()) return 0;
  std::vector<glm::ivec3> nodes;
  Box<int> box{bricks[0] >> 3, (bricks[0] >> 3) + 1};
  for (const glm::ivec3 brick : bricks) {
    const glm::ivec3 node = brick >> 3;
    box = united(box, {node, node + 1});
    if (nodes.empty() || nodes.back() != node) nodes.push_back(node);
  }
  std::sort(nodes.begin(), nodes.end(), goes_before);
  const auto count = std::unique(nodes.begin(), nodes.end()) - nodes.begin();
  const glm::u64vec3 window(box.high - box.low);
  return window.x * window.y * window.z + static_cast<std::uint64_t>(count) * shared::kPageEntries;
}

/// The number of all voxels of a brick and its apron; 0 where they differ.
float uniform_number(const Level& level, glm::ivec3 brick) {
  const std::uint32_t middle = level.index.at(brick);
  if (middle == volume::PageTable::kNoSlot || !level.numbers.is_uniform(middle)) return 0;
  const float number = level.numbers.at(middle, 0);
  std::array<std::uint32_t, 27> around{};
  for (int n = 0; n < 27; ++n) {
    around[static_cast<std::size_t>(n)] = level.index.at(neighbour(brick, n));
    if (around[static_cast<std::size_t>(n)] == volume::PageTable::kNoSlot) return 0;
  }
  for (int z = -1; z <= 8; ++z)
    for (int y = -1; y <= 8; ++y)
      // Rows inside of the brick count with their ends only.
      for (int x = -1; x <= 8; x += y >= 0 && y < 8 && z >= 0 && z < 8 ? 9 : 1) {
        const glm::ivec3 p(x, y, z), side = (p >> 3) + 1, q = p & 7;
        const std::uint32_t from = around[static_cast<std::size_t>(side.x + 3 * side.y + 9 * side.z)];
        if (level.numbers.at(from, static_cast<std::size_t>(q.x + 8 * (q.y + 8 * q.z))) != number) return 0;
      }
  return number;
}

/// A density and what glows beside it, halved together.
struct Levels {
  Level density, also;
  bool may_be_uniform = true, by_power = false;
  std::vector<glm::ivec3> bricks;  ///< The sampled ones of both, rising.
  std::vector<float> uniform;      ///< The uniform_number of each of them.
  int halvings = 0;
  double square_error = 0;

  /// Finds the bricks. False where they take more than the room.
  bool fit(const Room& room) {
    if (!density.may_fit(room) || !also.may_fit(room)) return false;
    density.find_sampled();
    also.find_sampled();
    bricks.clear();
    std::set_union(density.sampled.begin(), density.sampled.end(), also.sampled.begin(), also.sampled.end(),
                   std::back_inserter(bricks), goes_before);
    find_uniform();
    return std::ranges::count(uniform, 0.0f) <= room.bricks && page_count(bricks) <= room.pages;
  }
  void find_uniform() {
    uniform.assign(bricks.size(), 0);
    if (!may_be_uniform) return;
    parallel_for(bricks.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) uniform[i] = uniform_number(density, bricks[i]);
    });
  }
  /// Halves until they fit.
  void reduce(const Room& room) {
    while (!fit(room) && halvings < kMostHalvings) {
      double lost = 0, ignored = 0;
      density = Level(density.numbers.halved(by_power, lost));
      also = Level(also.numbers.halved(by_power, ignored), also.is_filtered);
      // Each level's error counts once per voxel of the file.
      square_error += lost * std::exp2(3 * halvings);
      ++halvings;
    }
  }
};

/// As glm::packHalf1x16, which is slow, of a value >= 0.
std::uint16_t to_half(float value) {
  constexpr float kLeastNormal = 6.103515625e-5f, kMostNormal = 65504;
  if (!(value >= kLeastNormal && value <= kMostNormal)) return glm::packHalf1x16(value);
  // Rounds the mantissa to 10 bits, and changes the bias of the exponent from 127 to 15.
  return static_cast<std::uint16_t>(((std::bit_cast<std::uint32_t>(value) + 0x1000u) >> 13) - (112u << 10));
}

/// The texels of a brick with its apron.
void fill_texels(const Level& level, float per_value, float outside, glm::ivec3 brick,
                 std::span<std::uint16_t> texels) {
  if (outside > 0) std::ranges::fill(texels, to_half(per_value * outside));
  std::array<std::uint32_t, 27> around{};
  for (int n = 0; n < 27; ++n) around[static_cast<std::size_t>(n)] = level.index.at(neighbour(brick, n));
  const auto set = [&](std::size_t texel, std::uint32_t from, std::size_t voxel) {
    if (from != volume::PageTable::kNoSlot)  // else the texel is outside
      texels[texel] = to_half(per_value * level.numbers.at(from, voxel));
  };
  for (int z = -1; z <= 8; ++z)
    for (int y = -1; y <= 8; ++y) {
      const auto sides = static_cast<std::size_t>(3 * ((y >> 3) + 1) + 9 * ((z >> 3) + 1));
      const auto voxel = static_cast<std::size_t>(8 * ((y & 7) + 8 * (z & 7)));
      const auto texel = static_cast<std::size_t>(10 * (y + 1 + 10 * (z + 1)));
      set(texel, around[sides], voxel + 7);
      for (std::size_t x = 0; x < 8; ++x) set(texel + 1 + x, around[sides + 1], voxel + x);
      set(texel + 9, around[sides + 2], voxel);
    }
}

/// Range, sum and distribution of the numbers of a level, and the box around all that filtering carries them
/// to: half a voxel beyond their own.
struct Measures {
  float low = std::numeric_limits<float>::infinity(), high = 0;
  double sum = 0;
  glm::dvec3 places{0};
  Box<float> bounds = kEmptyBox;

  void add(const GridNumbers& numbers, std::size_t i) {
    for (int voxel = 0; voxel < int{kBrickVoxels}; ++voxel) {
      const float value = numbers.at(i, static_cast<std::size_t>(voxel));
      low = std::min(low, value);
      high = std::max(high, value);
      if (value <= 0) continue;
      const glm::dvec3 p(numbers.brick(i) * 8 + voxel_at(voxel));
      sum += double{value};
      places += double{value} * (p + 0.5);
      bounds = united(bounds, {glm::vec3(p) - 0.5f, glm::vec3(p) + 1.5f});
    }
  }
  void add(const Measures& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
    sum += other.sum;
    places += other.places;
    bounds = united(bounds, other.bounds);
  }
};

/// Summed in order, whatever thread measured a part.
Measures measure(const GridNumbers& numbers) {
  constexpr std::size_t kPart = 256;
  std::vector<Measures> parts((numbers.size() + kPart - 1) / kPart);
  parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part)
      for (std::size_t i = part * kPart; i < std::min(numbers.size(), (part + 1) * kPart); ++i)
        parts[part].add(numbers, i);
  });
  Measures all;
  for (const Measures& part : parts) all.add(part);
  if (numbers.size() == 0) all.low = 0;
  return all;
}

/// Needs the range of the values.
void count_values(const GridNumbers& numbers, BrickVolume& out) {
  if (out.high <= out.low) return;
  out.histogram.assign(kHistogramBins, 0);
  const float per_value = static_cast<float>(kHistogramBins) / (out.high - out.low);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
      const float value = numbers.at(i, voxel);
      if (value <= 0) continue;
      const auto bin = static_cast<std::size_t>(per_value * (value - out.low));
      ++out.histogram[std::min(bin, kHistogramBins - 1)];
    }
}

/// Halves of values above 0 are in the order of their bits. Needs the unit.
void find_percentiles(const GridNumbers& numbers, BrickVolume& out) {
  constexpr std::size_t kInfinity = 0x7c00;
  std::vector<std::uint64_t> counts(kInfinity + 1);
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
      const float value = numbers.at(i, voxel);
      if (value <= 0) continue;
      ++counts[to_half(value / out.unit)];
      ++all;
    }
  const auto percentile = [&](double fraction) {
    const auto rank = static_cast<std::uint64_t>(fraction * static_cast<double>(all - 1));
    std::uint64_t below = 0;
    std::size_t half = 0;
    while (below += counts[half], below <= rank) ++half;
    return out.unit * glm::unpackHalf1x16(static_cast<std::uint16_t>(half));
  };
  out.usual = percentile(0.9);
  out.densest = percentile(0.999);
}

void fill_volume(const Levels& levels, const Box<float>& bounds, BrickVolume& out) {
  volume::SparseVolumeInfo info;
  info.channels = {{sizeof(std::uint16_t)}};
  out.volume = std::make_unique<volume::SparseVolume>(info);
  const volume::ChannelId channel{0};
  out.volume->begin_update();
  // Bricks with slots: a new volume numbers them in the order in which they are acquired.
  std::vector<glm::ivec3> bricks;
  for (std::size_t i = 0; i < levels.bricks.size(); ++i) {
    if (levels.uniform[i] > 0) {
      out.volume->set_uniform(levels.bricks[i], glm::packHalf1x16(levels.uniform[i] / out.unit));
    } else {
      out.volume->acquire(levels.bricks[i]);
      bricks.push_back(levels.bricks[i]);
    }
  }
  out.ranges.resize(bricks.size());
  parallel_for(bricks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto texels = out.volume->texels<std::uint16_t>(channel, static_cast<std::uint32_t>(i));
      fill_texels(levels.density, 1 / out.unit, out.outside, bricks[i], texels);
      out.ranges[i] = filtered_range(texels);
    }
  });
  out.volume->set_bounds(bounds.empty() ? glm::vec3(0) : bounds.low,
                         bounds.empty() ? glm::vec3(0) : bounds.high);
  out.volume->end_update();
}

/// What a level looks like in a unit (0: the one that suits it) and in bounds (empty: its own). Without its
/// place. `outside`: of the voxels beyond its numbers.
BrickVolume make_volume(const Levels& levels, float unit, float outside, const Box<float>& bounds) {
  BrickVolume out;
  out.outside = outside;
  const Measures all = measure(levels.density.numbers);
  out.low = all.low;
  out.high = all.high;
  out.sum = all.sum;
  if (all.sum > 0) {
    if (out.high < kLeastHigh || out.high > kMostHigh) out.unit = std::exp2(std::floor(std::log2(out.high)));
    out.mean = all.places / all.sum;
    count_values(levels.density.numbers, out);
    find_percentiles(levels.density.numbers, out);
  }
  if (unit > 0) out.unit = unit;
  fill_volume(levels, bounds.empty() ? united(all.bounds, measure(levels.also.numbers).bounds) : bounds, out);
  return out;
}

/// Around the active voxels of a grid, in voxels of a level counted from an origin.
Box<float> bounds_of(const Grid& grid, const glm::ivec3& origin, int halvings) {
  Box<double> active = active_bounds(grid);
  active.low -= glm::dvec3(origin);
  active.high -= glm::dvec3(origin);
  const double per_voxel = std::exp2(-halvings);
  if (active.empty()) return kEmptyBox;
  return {glm::vec3((active.low + 0.5) * per_voxel), glm::vec3((active.high + 0.5) * per_voxel)};
}

/// Where the voxels of any grid are counted from, so that floats hold places between them: the grid's own
/// origin unless that is too far; then near the corner of its bricks, or their middle where a few of them lie
/// far from the others. Halvings and tiles keep their alignment [bricks].
glm::ivec3 near_origin(const GridNumbers& numbers) {
  constexpr int kFar = 1 << 14;
  const Box<int> box = numbers.brick_box();
  if (box.empty()) return glm::ivec3(0);
  const glm::ivec3 farthest = glm::max(glm::abs(box.low), glm::abs(box.high));
  if (std::max({farthest.x, farthest.y, farthest.z}) <= kFar) return glm::ivec3(0);
  constexpr int kLargestTile = 4096 / kBrickEdge;
  const glm::ivec3 size = box.high - box.low;
  const bool is_near = std::max({size.x, size.y, size.z}) <= kFar;
  return (is_near ? box.low : numbers.middle_brick()) & ~(kLargestTile - 1);
}

/// From the voxels of a level to those before it was halved: voxel i of level l has its centre at index
/// 2^l (i + 1/2) - 1/2.
glm::dmat4 scale_of(const Levels& levels) {
  return glm::scale(glm::dmat4(1), glm::dvec3(std::exp2(levels.halvings)));
}

}  // namespace

ValueRange filtered_range(std::span<const std::uint16_t, shared::kTexelsPerBrick> texels) {
  if (std::all_of(texels.begin(), texels.end(), [&](std::uint16_t texel) { return texel == texels[0]; })) {
    const float value = glm::unpackHalf1x16(texels[0]);
    return {value, value};
  }
  std::array<double, shared::kTexelsPerBrick> values;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = double{glm::unpackHalf1x16(texels[i])};
  // The first and last texel along each axis become the values at the faces.
  struct Strides {
    std::size_t along, u, v;
  };
  for (const auto& [along, u, v] : {Strides{1, 10, 100}, Strides{10, 1, 100}, Strides{100, 1, 10}})
    for (std::size_t line = 0; line < 100; ++line) {
      double* const first = &values[line % 10 * u + line / 10 * v];
      first[0] = 0.5 * (first[0] + first[along]);
      first[9 * along] = 0.5 * (first[9 * along] + first[8 * along]);
    }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  ValueRange range{static_cast<float>(*low), static_cast<float>(*high)};
  constexpr float kFar = std::numeric_limits<float>::infinity();
  if (double{range.low} > *low) range.low = std::nextafter(range.low, -kFar);
  if (double{range.high} < *high) range.high = std::nextafter(range.high, kFar);
  return range;
}

Result<BrickVolume> make_brick_volume(const Grid& grid, const BrickVolumeOptions& options) {
  if (grid.type == ValueType::mask)
    return Failure{ErrorCode::bad_input, "grid " + grid.name + ": is a mask, which has no values to render"};
  BRUME_ASSERT(options.max_bricks >= kFewestVolumeBricks && options.max_pages >= kFewestVolumePages,
               std::to_string(options.max_bricks) + " " + std::to_string(options.max_pages));
  const Grid nothing;
  const std::optional<ValueShift> shift = is_level_set(grid) ? std::nullopt : options.shift;
  GridNumbers numbers(grid, shift);
  const std::uint64_t odd = numbers.odd();
  const float outside = shift ? numbers.background(grid) : 0;
  GridNumbers also(options.also ? *options.also : nothing);
  // Count bricks from near the values, so that floats hold their places.
  const glm::ivec3 origin = near_origin(numbers);
  numbers.move(-origin);
  also.move(-origin);
  // Halve the resolution until the bricks fit, and store them.
  Levels levels{
      Level(std::move(numbers)), Level(std::move(also)), options.may_be_uniform, options.glows, {}, {}};
  levels.reduce({options.max_bricks, options.max_pages, kNumbersPerBrick * options.max_bricks});
  BrickVolume out = make_volume(levels, 0, outside,
                                shift ? bounds_of(grid, kBrickEdge * origin, levels.halvings) : kEmptyBox);
  // Give the statistics back in the file's values and in its world.
  if (shift) {
    out.offset = shift->offset;
    out.low += shift->offset;
    out.high += shift->offset;
  }
  const auto active = static_cast<double>(count_active(grid));
  out.level = levels.halvings;
  out.odd = odd;
  out.rms_error = active > 0 ? std::sqrt(levels.square_error / active) : 0;
  out.world_from_voxel = grid.world_from_index *
                         glm::translate(glm::dmat4(1), glm::dvec3(kBrickEdge * origin) - 0.5) *
                         scale_of(levels);
  return out;
}

BrickVolume make_preview(const BrickVolume& fine, std::uint32_t max_bricks, bool glows) {
  BRUME_ASSERT(max_bricks >= kFewestVolumeBricks, std::to_string(max_bricks));
  // Where the fine one has bricks of zeros, something else may glow.
  Levels levels{Level(GridNumbers(*fine.volume, false)),
                Level(GridNumbers(*fine.volume, true), false),
                true,
                glows,
                {},
                {}};
  levels.reduce({max_bricks, kMostVolumePages, max_bricks});
  const shared::VolumeLayout& layout = fine.volume->layout();
  const auto per_voxel = static_cast<float>(std::exp2(-levels.halvings));
  BrickVolume out = make_volume(levels, 1, fine.outside / fine.unit,
                                {layout.bounds_min * per_voxel, layout.bounds_max * per_voxel});
  out.unit = fine.unit;
  out.offset = fine.offset;
  out.outside = fine.outside;
  out.low = out.low * fine.unit + fine.offset;
  out.high = out.high * fine.unit + fine.offset;
  out.sum *= double{fine.unit};
  out.usual *= fine.unit;
  out.densest *= fine.unit;
  out.level = fine.level + levels.halvings;
  out.world_from_voxel = fine.world_from_voxel * scale_of(levels);
  return out;
}

}  // namespace brume::grids
