#include "sim/fill.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>

#include "core/error.hpp"
#include "core/progress.hpp"

namespace brume::sim {
namespace {

constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kNoBrick = std::numeric_limits<std::uint32_t>::max();
constexpr int kMoves = 26;
constexpr std::uint32_t kVoxelsOfLongJob = 1u << 18;
/// Voxel index x + kRow y + kLayer z, ordered as the indices of any grid.
constexpr std::int64_t kRow = std::int64_t{1} << 18, kLayer = kRow << 18;

struct Move {
  glm::ivec3 step;
  std::uint32_t length;
};

constexpr std::array<Move, kMoves> make_moves() {
  std::array<Move, kMoves> moves{};
  std::size_t count = 0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const int axes = (x != 0) + (y != 0) + (z != 0);
        if (axes == 0) continue;
        moves[count++] = {{x, y, z}, axes == 1 ? kFaceStep : axes == 2 ? kEdgeStep : kCornerStep};
      }
  return moves;
}
constexpr std::array<Move, kMoves> kMoveTable = make_moves();

/// 3x3 words: slice of an 8x8 brick layer as seen from a step of (dx, dy).
using ShiftedSlice = std::array<std::array<std::uint64_t, 3>, 3>;

/// A brick of the fill: the distances of its 8^3 voxels and, for each move, the voxels from which it is
/// valid.
struct FillBrick {
  glm::ivec3 coordinates;
  std::array<std::uint32_t, 27> neighbours;
  std::array<std::array<std::uint64_t, voxel::kBrickSize>, kMoves> may_move;  // word z, bit x + 8 y
  std::array<std::uint32_t, 512> distances;
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

/// The free voxels of a brick as 8 words: word z, bit x + 8 y.
using FreeWords = std::function<voxel::BitGrid::Brick(glm::ivec3 brick)>;

/// Writes FillBrick::may_move, 64 voxels at a time.
void find_moves(const FreeWords& free, FillBrick& brick) {
  // The free voxels of the brick and its 26 neighbours.
  std::array<voxel::BitGrid::Brick, 27> words;
  for (int i = 0; i < 27; ++i)
    words[static_cast<std::size_t>(i)] = free(brick.coordinates + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1);

  // Each slice, shifted by every step in x and y.
  std::array<ShiftedSlice, 10> slices;  // z = -1 .. 8
  for (std::size_t s = 0; s < 10; ++s) {
    const std::size_t layer = (s + 7) / 8;
    std::array<std::array<std::uint64_t, 3>, 3> around;
    for (std::size_t y = 0; y < 3; ++y)
      for (std::size_t x = 0; x < 3; ++x) around[y][x] = words[x + 3 * y + 9 * layer][(s + 7) % 8];
    slices[s] = shift_slice(around);
  }

  // A move is valid where all corners of its box are free.
  for (std::size_t m = 0; m < kMoves; ++m) {
    const glm::ivec3 step = kMoveTable[m].step;
    for (std::size_t z = 0; z < 8; ++z) {
      std::uint64_t all = ~std::uint64_t{0};
      for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 at = step * glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2) + 1;
        all &= slices[z + static_cast<std::size_t>(at.z)][static_cast<std::size_t>(at.y)]
                     [static_cast<std::size_t>(at.x)];
      }
      brick.may_move[m][z] = all;
    }
  }
}

/// Dial's bucket queue over bricks created on demand. Dial 1969, "Algorithm 360: Shortest-Path Forest with
/// Topological Ordering": edge lengths are small integers, so 18 buckets in a ring hold all open voxels.
class Fill {
 public:
  explicit Fill(FreeWords free) : free_(std::move(free)) {}

  std::vector<FilledVoxel> run(glm::ivec3 source, std::uint32_t budget);

 private:
  struct Open {
    std::uint64_t index;  // voxel index: breaks ties
    std::uint32_t brick, local;
  };

  std::uint32_t brick_at(glm::ivec3 coordinates);
  void spread(const Open& from, std::uint32_t distance);
  glm::ivec3 voxel_of(const Open& open) const {
    const int local = static_cast<int>(open.local);
    return bricks_[open.brick].coordinates * 8 + glm::ivec3(local & 7, local >> 3 & 7, local >> 6);
  }

  FreeWords free_;
  std::deque<FillBrick> bricks_;
  std::unordered_map<std::uint64_t, std::uint32_t> brick_of_;
  std::array<std::vector<Open>, kCornerStep + 1> buckets_;
  std::size_t open_ = 0;
};

std::uint32_t Fill::brick_at(glm::ivec3 b) {
  const std::uint64_t key = static_cast<std::uint64_t>(b.x) | static_cast<std::uint64_t>(b.y) << 20 |
                            static_cast<std::uint64_t>(b.z) << 40;
  const auto [entry, is_new] = brick_of_.try_emplace(key, static_cast<std::uint32_t>(bricks_.size()));
  if (is_new) {
    FillBrick& brick = bricks_.emplace_back();
    brick.coordinates = b;
    brick.neighbours.fill(kNoBrick);
    brick.neighbours[13] = entry->second;
    brick.distances.fill(kUnreached);
    find_moves(free_, brick);
  }
  return entry->second;
}

/// Relaxes all moves from a voxel.
void Fill::spread(const Open& from, std::uint32_t distance) {
  FillBrick& home = bricks_[from.brick];
  const glm::ivec3 local(static_cast<int>(from.local & 7), static_cast<int>(from.local >> 3 & 7),
                         static_cast<int>(from.local >> 6));
  const std::size_t word = from.local >> 6;
  const std::uint64_t bit = std::uint64_t{1} << (from.local & 63);
  for (std::size_t m = 0; m < kMoves; ++m) {
    if (!(home.may_move[m][word] & bit)) continue;

    // The target voxel, perhaps in a neighbouring brick.
    const Move& move = kMoveTable[m];
    const glm::ivec3 to = local + move.step;
    const glm::ivec3 beyond = to >> 3;  // -1, 0 or 1 bricks away
    std::uint32_t& brick =
        home.neighbours[static_cast<std::size_t>(beyond.x + 3 * beyond.y + 9 * beyond.z + 13)];
    if (brick == kNoBrick) brick = brick_at(home.coordinates + beyond);
    const auto to_local = static_cast<std::uint32_t>((to.x & 7) | (to.y & 7) << 3 | (to.z & 7) << 6);

    // Queue it when this path is shorter.
    std::uint32_t& known = bricks_[brick].distances[to_local];
    const std::uint32_t length = distance + move.length;
    if (length >= known) continue;
    known = length;
    const std::int64_t offset = move.step.x + kRow * move.step.y + kLayer * move.step.z;
    buckets_[length % buckets_.size()].push_back(
        {static_cast<std::uint64_t>(static_cast<std::int64_t>(from.index) + offset), brick, to_local});
    ++open_;
  }
}

std::vector<FilledVoxel> Fill::run(glm::ivec3 source, std::uint32_t budget) {
  // Start at the source, if it is free.
  std::vector<FilledVoxel> filled;
  const glm::ivec3 in_brick = source & 7;
  const bool is_free =
      free_(source >> 3)[static_cast<std::size_t>(in_brick.z)] >> (in_brick.x + 8 * in_brick.y) & 1;
  if (budget == 0 || !is_free) return filled;
  filled.reserve(std::min(budget, 1u << 12));

  const Open first{static_cast<std::uint64_t>(source.x + kRow * source.y + kLayer * source.z),
                   brick_at(source >> 3),
                   static_cast<std::uint32_t>(in_brick.x | in_brick.y << 3 | in_brick.z << 6)};
  bricks_[first.brick].distances[first.local] = 0;
  buckets_[0].push_back(first);
  open_ = 1;

  // Settle the voxels bucket by bucket, those of one distance by index.
  std::optional<Progress> job;
  if (budget >= kVoxelsOfLongJob) job.emplace("flood", budget);
  std::vector<Open> nearest;
  for (std::uint32_t distance = 0; open_ > 0; ++distance) {
    nearest.clear();
    nearest.swap(buckets_[distance % buckets_.size()]);
    open_ -= nearest.size();
    // An entry is stale when a shorter path to its voxel was found meanwhile.
    std::erase_if(nearest, [&](const Open& o) { return bricks_[o.brick].distances[o.local] != distance; });
    std::sort(nearest.begin(), nearest.end(), [](const Open& a, const Open& b) { return a.index < b.index; });
    for (const Open& open : nearest) {
      filled.push_back({voxel_of(open), distance});
      if (filled.size() == budget) return filled;
    }
    if (job) job->advance(nearest.size());
    for (const Open& open : nearest) spread(open, distance);
  }
  return filled;
}

}  // namespace

std::vector<FilledVoxel> flood_fill(const voxel::BitGrid& grid, glm::ivec3 source, std::uint32_t budget) {
  BRUME_ASSERT(budget <= kMaxFillVoxels, std::to_string(budget));
  if (!grid.contains(source)) return {};
  return Fill([&grid](glm::ivec3 brick) { return free_words(grid, brick); }).run(source, budget);
}

std::vector<FilledVoxel> flood_fill(const BlockSet& domain, glm::ivec3 source) {
  if (!domain.contains(source)) return {};
  return Fill([&domain](glm::ivec3 brick) { return words_of(domain, brick); }).run(source, domain.size());
}

}  // namespace brume::sim
