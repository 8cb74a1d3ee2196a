#include "sim/fill.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>

#include "core/error.hpp"
#include "core/float4.hpp"
#include "core/progress.hpp"

namespace brume::sim {
namespace {

// Distances are below 2^31: over faces a voxel takes one step of 10, and longer steps need more free voxels.
constexpr std::uint32_t kUnreached = std::numeric_limits<std::int32_t>::max();
constexpr std::uint32_t kNoBrick = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kVoxelsOfLongJob = 1u << 18;

/// Moves by their number x + 3 y + 9 z of step + 1; 13 stays in place.
constexpr std::size_t kMoves = 27;
constexpr glm::ivec3 step_of(std::size_t move) {
  return glm::ivec3(static_cast<int>(move % 3), static_cast<int>(move / 3 % 3), static_cast<int>(move / 9)) -
         1;
}
constexpr std::array<std::uint32_t, kMoves> make_lengths() {
  constexpr std::array<std::uint32_t, 4> kByAxes{0, kFaceStep, kEdgeStep, kCornerStep};
  std::array<std::uint32_t, kMoves> lengths{};
  for (std::size_t m = 0; m < kMoves; ++m)
    lengths[m] =
        kByAxes[static_cast<std::size_t>(m % 3 != 1) + std::size_t{m / 3 % 3 != 1} + std::size_t{m / 9 != 1}];
  return lengths;
}
constexpr std::array<std::uint32_t, kMoves> kLengths = make_lengths();

/// Distances of a brick's voxels and of those around it, -1 to 8 per axis, in rows of 12.
constexpr std::uint32_t kRow = 12, kLayer = 10 * kRow, kDistances = 10 * kLayer;
constexpr std::uint32_t distance_index(glm::ivec3 v) {
  return static_cast<std::uint32_t>(v.x + 1 + static_cast<int>(kRow) * (v.y + 1) +
                                    static_cast<int>(kLayer) * (v.z + 1));
}

/// Voxel index x + 2^18 y + 2^36 z, ordered as the indices of any grid.
constexpr int kIndexBits = 18;
std::uint64_t index_of(glm::ivec3 v) {
  return static_cast<std::uint64_t>(v.x) | static_cast<std::uint64_t>(v.y) << kIndexBits |
         static_cast<std::uint64_t>(v.z) << (2 * kIndexBits);
}
glm::ivec3 voxel_of(std::uint64_t index) {
  constexpr std::uint64_t kAxis = (1u << kIndexBits) - 1;
  return {static_cast<int>(index & kAxis), static_cast<int>(index >> kIndexBits & kAxis),
          static_cast<int>(index >> (2 * kIndexBits))};
}

/// 3x3 words: slice of an 8x8 brick layer as seen from a step of (dx, dy).
using ShiftedSlice = std::array<std::array<std::uint64_t, 3>, 3>;

/// A brick of the fill: the distances of its 8^3 voxels and, for each move, the voxels from which it is
/// valid. Distances of the voxels around the brick may be older and larger than those in their own bricks.
struct FillBrick {
  glm::ivec3 coordinates;
  std::array<std::uint32_t, 27> neighbours;
  voxel::BitGrid::Brick settled;
  std::array<voxel::BitGrid::Brick, kMoves> may_move;  // word z, bit x + 8 y
  std::array<std::uint32_t, kDistances> distances;     // solid voxels: 0, which no path improves
};

std::uint64_t low_bits(int count) {
  return count >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

/// The free voxels of a brick as 8 words; none outside the grid.
voxel::BitGrid::Brick free_words(const voxel::BitGrid& grid, glm::ivec3 brick) {
  voxel::BitGrid::Brick words{};
  const glm::ivec3 inside = glm::min(grid.size() - brick * 8, glm::ivec3(8));
  if (glm::any(glm::lessThan(brick, glm::ivec3(0))) || glm::any(glm::lessThanEqual(inside, glm::ivec3(0))))
    return words;
  const std::uint64_t row = low_bits(inside.x);
  const std::uint64_t slice = (row * 0x0101010101010101u) & low_bits(8 * inside.y);
  const voxel::BitGrid::Brick* solid = grid.find_brick(brick);
  for (std::size_t z = 0; z < static_cast<std::size_t>(inside.z); ++z)
    words[z] = solid ? slice & ~(*solid)[z] : slice;
  return words;
}

/// The voxels of a set within a brick.
voxel::BitGrid::Brick words_of(const BlockSet& set, glm::ivec3 brick) {
  voxel::BitGrid::Brick words{};
  for (int octant = 0; octant < 8; ++octant) {
    const glm::ivec3 corner(octant & 1, octant >> 1 & 1, octant >> 2);
    const VoxelBlock* block = set.find_block(brick * 2 + corner);
    if (!block) continue;
    for (int z = 0; z < kBlockSize; ++z)
      for (int y = 0; y < kBlockSize; ++y)
        words[static_cast<std::size_t>(4 * corner.z + z)] |= (block->mask >> (4 * y + 16 * z) & 0xf)
                                                             << (4 * corner.x + 8 * (4 * corner.y + y));
  }
  return words;
}

/// Shifts one layer of 3x3 brick slices: bit (x, y) of result[dy + 1][dx + 1] is voxel (x + dx, y + dy).
ShiftedSlice shift_slice(const std::array<std::array<std::uint64_t, 3>, 3>& around) {
  constexpr std::uint64_t kFirstColumn = 0x0101010101010101u;
  ShiftedSlice by_x;
  for (std::size_t y = 0; y < 3; ++y) {
    const auto& [left, middle, right] = around[y];
    by_x[y] = {((middle << 1) & ~kFirstColumn) | ((left >> 7) & kFirstColumn), middle,
               ((middle >> 1) & ~(kFirstColumn << 7)) | ((right << 7) & (kFirstColumn << 7))};
  }
  ShiftedSlice result;
  for (std::size_t x = 0; x < 3; ++x) {
    result[0][x] = (by_x[1][x] << 8) | (by_x[0][x] >> 56);
    result[1][x] = by_x[1][x];
    result[2][x] = (by_x[1][x] >> 8) | (by_x[2][x] << 56);
  }
  return result;
}

/// The free voxels of a brick and of the 26 around it.
using FreeAround = std::array<voxel::BitGrid::Brick, 27>;

/// Writes FillBrick::may_move, 64 voxels at a time.
void find_moves(const FreeAround& words, FillBrick& brick) {
  // For each layer and step in x and y: where the rectangle of the step is free.
  std::array<ShiftedSlice, 10> rectangles;  // z = -1 .. 8
  for (std::size_t s = 0; s < 10; ++s) {
    const std::size_t layer = (s + 7) / 8;
    std::array<std::array<std::uint64_t, 3>, 3> around;
    for (std::size_t y = 0; y < 3; ++y)
      for (std::size_t x = 0; x < 3; ++x) around[y][x] = words[x + 3 * y + 9 * layer][(s + 7) % 8];
    const ShiftedSlice free = shift_slice(around);
    for (std::size_t y = 0; y < 3; ++y)
      for (std::size_t x = 0; x < 3; ++x)
        rectangles[s][y][x] = free[1][1] & free[1][x] & free[y][1] & free[y][x];
  }

  // A move is valid where the rectangles in both layers of its box are free.
  for (std::size_t m = 0; m < kMoves; ++m)
    for (std::size_t z = 0; z < 8; ++z)
      brick.may_move[m][z] = rectangles[z + 1][m / 3 % 3][m % 3] & rectangles[z + m / 9][m / 3 % 3][m % 3];
}

/// Writes FillBrick::distances: unreached where a voxel is free.
void clear_distances(const FreeAround& words, FillBrick& brick) {
  constexpr Uint4 kBits{1, 2, 4, 8};
  for (int z = -1; z <= 8; ++z)
    for (int y = -1; y <= 8; ++y) {
      const auto i = static_cast<std::size_t>(3 * ((y >> 3) + 1) + 9 * ((z >> 3) + 1));
      const auto row = [&](std::size_t x) {
        return static_cast<std::uint32_t>(words[i + x][static_cast<std::size_t>(z & 7)] >> (8 * (y & 7))) &
               0xffu;
      };
      const std::uint32_t bits = row(0) >> 7 | row(1) << 1 | row(2) << 9;
      std::uint32_t* out = brick.distances.data() + distance_index({-1, y, z});
      for (std::uint32_t x = 0; x < kRow; x += 4) {
        const Uint4 free = Uint4{bits, bits, bits, bits} >> x & kBits;
        const Uint4 distances = reinterpret_cast<Uint4>(free != 0u) & kUnreached;
        std::memcpy(out + x, &distances, sizeof(distances));
      }
    }
}

/// Dial's bucket queue over bricks created on demand. Dial 1969, "Algorithm 360: Shortest-Path Forest with
/// Topological Ordering": edge lengths are small integers, so 18 buckets in a ring hold all open voxels.
template <typename FreeWords>
class Flooder {
 public:
  /// free(brick): the free voxels of a brick as 8 words, word z, bit x + 8 y.
  explicit Flooder(FreeWords free) : free_(std::move(free)) {}

  struct Open {
    std::uint32_t brick, local;  // x + 8 y + 64 z in the brick
  };
  /// Calls settle(distance, voxels) for each distance that occurs, in order, with at most `budget` voxels in
  /// all. The voxels of one distance are in no order.
  template <typename Settle>
  void run(glm::ivec3 source, std::uint32_t budget, const Settle& settle);

  const std::deque<FillBrick>& bricks() const { return bricks_; }
  glm::ivec3 voxel_of(Open open) const {
    return bricks_[open.brick].coordinates * 8 + local_voxel(open.local);
  }

 private:
  static glm::ivec3 local_voxel(std::uint32_t local) {
    return {static_cast<int>(local & 7), static_cast<int>(local >> 3 & 7), static_cast<int>(local >> 6)};
  }
  std::uint32_t brick_at(glm::ivec3 coordinates);
  void take_nearest(std::uint32_t distance);
  void spread(Open from, std::uint32_t distance);
  bool shorten(FillBrick& home, glm::ivec3 to, std::uint32_t length, Open& target);

  FreeWords free_;
  std::deque<FillBrick> bricks_;
  std::unordered_map<std::uint64_t, std::uint32_t> brick_of_;
  std::array<std::vector<Open>, kCornerStep + 1> buckets_;
  std::size_t open_ = 0;
  std::vector<Open> nearest_;
};

template <typename FreeWords>
std::uint32_t Flooder<FreeWords>::brick_at(glm::ivec3 b) {
  const std::uint64_t key = static_cast<std::uint64_t>(b.x) | static_cast<std::uint64_t>(b.y) << 20 |
                            static_cast<std::uint64_t>(b.z) << 40;
  const auto [entry, is_new] = brick_of_.try_emplace(key, static_cast<std::uint32_t>(bricks_.size()));
  if (is_new) {
    FillBrick& brick = bricks_.emplace_back();
    brick.coordinates = b;
    brick.neighbours.fill(kNoBrick);
    brick.neighbours[13] = entry->second;
    brick.settled = {};
    FreeAround free;
    for (std::size_t i = 0; i < 27; ++i) free[i] = free_(b + step_of(i));
    find_moves(free, brick);
    clear_distances(free, brick);
  }
  return entry->second;
}

/// Whether a path of this length to a voxel in or next to the brick is the shortest so far; then notes it.
template <typename FreeWords>
bool Flooder<FreeWords>::shorten(FillBrick& home, glm::ivec3 to, std::uint32_t length, Open& target) {
  std::uint32_t& here = home.distances[distance_index(to)];
  target.local = static_cast<std::uint32_t>((to.x & 7) | (to.y & 7) << 3 | (to.z & 7) << 6);
  target.brick = home.neighbours[13];
  if (static_cast<unsigned>(to.x | to.y | to.z) > 7) {
    // In a neighbour, of whose distance this is a copy.
    const glm::ivec3 beyond = to >> 3;
    std::uint32_t& brick =
        home.neighbours[static_cast<std::size_t>(beyond.x + 3 * beyond.y + 9 * beyond.z + 13)];
    if (brick == kNoBrick) brick = brick_at(home.coordinates + beyond);
    target.brick = brick;
    std::uint32_t& known = bricks_[brick].distances[distance_index(to & 7)];
    here = std::min(known, length);
    if (length >= known) return false;
    known = length;
    return true;
  }
  here = length;
  return true;
}

/// Relaxes all moves from a voxel.
template <typename FreeWords>
void Flooder<FreeWords>::spread(Open from, std::uint32_t distance) {
  FillBrick& home = bricks_[from.brick];
  const glm::ivec3 local = local_voxel(from.local);
  const std::uint32_t* around = home.distances.data() + distance_index(local - 1);

  // The moves that would shorten a path, three a row; the fourth lane never does.
  const auto limits = [&](std::size_t row) {
    const auto length = [&](std::size_t x) {
      return static_cast<std::int32_t>(distance + kLengths[3 * row + x]);
    };
    return Int4{length(0), length(1), length(2), static_cast<std::int32_t>(kUnreached)};
  };
  const std::array<Int4, 3> by_axes{limits(4), limits(1), limits(0)};
  std::uint32_t moves = 0;
  for (std::uint32_t row = 0; row < 9; ++row) {
    Int4 known;
    std::memcpy(&known, around + kRow * (row % 3) + kLayer * (row / 3), sizeof(known));
    moves |= bits_of(known > by_axes[(row % 3 != 1) + (row / 3 != 1)]) << 3 * row;
  }

  for (; moves != 0; moves &= moves - 1) {
    const auto m = static_cast<std::size_t>(std::countr_zero(moves));
    if ((home.may_move[m][from.local >> 6] >> (from.local & 63) & 1) == 0) continue;
    const std::uint32_t length = distance + kLengths[m];
    Open target;
    if (!shorten(home, local + step_of(m), length, target)) continue;
    buckets_[length % buckets_.size()].push_back(target);
    ++open_;
  }
}

/// Moves the open voxels at this distance to nearest_.
template <typename FreeWords>
void Flooder<FreeWords>::take_nearest(std::uint32_t distance) {
  nearest_.clear();
  nearest_.swap(buckets_[distance % buckets_.size()]);
  open_ -= nearest_.size();
  // An entry is stale when a shorter path to its voxel was found meanwhile.
  std::erase_if(nearest_, [&](Open o) {
    return bricks_[o.brick].distances[distance_index(local_voxel(o.local))] != distance;
  });
}

template <typename FreeWords>
template <typename Settle>
void Flooder<FreeWords>::run(glm::ivec3 source, std::uint32_t budget, const Settle& settle) {
  // Start at the source, if it is free.
  const glm::ivec3 in_brick = source & 7;
  const std::uint64_t layer = free_(source >> 3)[static_cast<std::size_t>(in_brick.z)];
  if (budget == 0 || (layer >> (in_brick.x + 8 * in_brick.y) & 1) == 0) return;
  const Open first{brick_at(source >> 3),
                   static_cast<std::uint32_t>(in_brick.x | in_brick.y << 3 | in_brick.z << 6)};
  bricks_[first.brick].distances[distance_index(in_brick)] = 0;
  buckets_[0].push_back(first);
  open_ = 1;

  std::optional<Progress> job;
  if (budget >= kVoxelsOfLongJob) job.emplace("flood", budget);
  for (std::uint32_t distance = 0; open_ > 0 && budget > 0; ++distance) {
    take_nearest(distance);
    if (nearest_.empty()) continue;

    // The last ones that the budget allows are those with the lowest indices.
    if (nearest_.size() > budget) {
      std::sort(nearest_.begin(), nearest_.end(),
                [&](Open a, Open b) { return index_of(voxel_of(a)) < index_of(voxel_of(b)); });
      nearest_.resize(budget);
    }
    budget -= static_cast<std::uint32_t>(nearest_.size());
    for (const Open o : nearest_)
      bricks_[o.brick].settled[o.local >> 6] |= std::uint64_t{1} << (o.local & 63);
    settle(distance, std::span<const Open>(nearest_));
    if (job) job->advance(nearest_.size());
    if (budget == 0) return;
    for (const Open o : nearest_) spread(o, distance);
  }
}

/// The settled voxels in order of distance and index.
template <typename FreeWords>
std::vector<FilledVoxel> list_of(const FreeWords& free, glm::ivec3 source, std::uint32_t budget) {
  Flooder flooder(free);
  std::vector<FilledVoxel> filled;
  filled.reserve(std::min(budget, 1u << 12));
  std::vector<std::uint64_t> indices;
  flooder.run(source, budget, [&](std::uint32_t distance, auto voxels) {
    indices.clear();
    for (const auto open : voxels) indices.push_back(index_of(flooder.voxel_of(open)));
    std::sort(indices.begin(), indices.end());
    for (const std::uint64_t index : indices) filled.push_back({voxel_of(index), distance});
  });
  return filled;
}

/// The settled voxels as a set.
template <typename FreeWords>
Flood make_set(const FreeWords& free, glm::ivec3 source, std::uint32_t budget) {
  Flooder flooder(free);
  Flood flood;
  flooder.run(source, budget, [&](std::uint32_t distance, auto voxels) {
    const std::uint64_t before = flood.counts.empty() ? 0 : flood.counts.back().count;
    flood.counts.push_back({distance, before + voxels.size()});
  });

  // The blocks of all bricks, in the order of the set.
  struct Part {
    VoxelBlock block;
    const std::uint32_t* distances;
  };
  std::vector<Part> parts;
  for (const FillBrick& brick : flooder.bricks())
    for (int octant = 0; octant < 8; ++octant) {
      const glm::ivec3 corner(octant & 1, octant >> 1 & 1, octant >> 2);
      if (const std::uint64_t mask = block_of(brick.settled, corner); mask != 0)
        parts.push_back({{glm::i16vec3(brick.coordinates * 2 + corner), mask, 0},
                         brick.distances.data() + distance_index(corner * kBlockSize)});
    }
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return block_before(a.block.at, b.block.at); });

  // Their voxels' distances.
  std::vector<VoxelBlock> blocks;
  blocks.reserve(parts.size());
  if (!flood.counts.empty()) flood.distances.reserve(flood.counts.back().count);
  for (const Part& part : parts) {
    blocks.push_back(part.block);
    for (std::uint64_t bits = part.block.mask; bits != 0; bits &= bits - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(bits));
      flood.distances.push_back(part.distances[(bit & 3) + kRow * (bit >> 2 & 3) + kLayer * (bit >> 4)]);
    }
  }
  flood.voxels = BlockSet::from_blocks(std::move(blocks));
  return flood;
}

}  // namespace

std::vector<FilledVoxel> flood_fill(const voxel::BitGrid& grid, glm::ivec3 source, std::uint32_t budget) {
  BRUME_ASSERT(budget <= kMaxFillVoxels, std::to_string(budget));
  if (!grid.contains(source)) return {};
  return list_of([&grid](glm::ivec3 brick) { return free_words(grid, brick); }, source, budget);
}

std::vector<FilledVoxel> flood_fill(const BlockSet& domain, glm::ivec3 source) {
  if (!domain.contains(source)) return {};
  return list_of([&domain](glm::ivec3 brick) { return words_of(domain, brick); }, source, domain.size());
}

Flood flood_set(const voxel::BitGrid& grid, glm::ivec3 source, std::uint32_t budget) {
  BRUME_ASSERT(budget <= kMaxFillVoxels, std::to_string(budget));
  if (!grid.contains(source)) return {};
  return make_set([&grid](glm::ivec3 brick) { return free_words(grid, brick); }, source, budget);
}

Flood flood_set(const BlockSet& domain, glm::ivec3 source) {
  if (!domain.contains(source)) return {};
  return make_set([&domain](glm::ivec3 brick) { return words_of(domain, brick); }, source, domain.size());
}

}  // namespace brume::sim
