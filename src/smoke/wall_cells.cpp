#include "smoke/wall_cells.hpp"

#include <algorithm>
#include <bit>

namespace brume::smoke {
namespace {

constexpr std::uint32_t kNoSlot = volume::SparseVolume::kNoSlot;
constexpr std::uint64_t kColumn0 = 0x0101010101010101u;

/// For voxels of a layer, the cells voxel - 2 to voxel + 1 along x: in the previous brick, this, the next.
std::array<std::uint64_t, 3> spread_x(std::uint64_t v) {
  const std::uint64_t first = v & kColumn0, second = v & kColumn0 << 1;
  return {
      first << 7 | first << 6 | second << 6,
      v | (v << 1 & ~kColumn0) | (v >> 1 & ~(kColumn0 << 7)) | (v >> 2 & ~(kColumn0 << 7 | kColumn0 << 6)),
      v >> 7 & kColumn0};
}
/// The same along y.
std::array<std::uint64_t, 3> spread_y(std::uint64_t v) {
  const std::uint64_t first = v & 0xff, second = v & 0xff00;
  return {first << 56 | first << 48 | second << 48, v | v << 8 | v >> 8 | v >> 16, v >> 56};
}

void sort_and_merge(std::vector<volume::IndexRange>& ranges) {
  std::sort(ranges.begin(), ranges.end(),
            [](const volume::IndexRange& a, const volume::IndexRange& b) { return a.first < b.first; });
  std::size_t merged = 0;
  for (const volume::IndexRange& range : ranges) {
    // A short gap between two ranges costs less than a copy of its own.
    if (merged > 0 && range.first <= ranges[merged - 1].first + ranges[merged - 1].count + 8)
      ranges[merged - 1].count = range.first + range.count - ranges[merged - 1].first;
    else
      ranges[merged++] = range;
  }
  ranges.resize(merged);
}

}  // namespace

/// Voxel - 2 to voxel + 1 per axis.
std::array<BrickBits, 27> cells_that_take(const BrickBits& voxels) {
  std::array<BrickBits, 27> cells{};
  for (int z = 0; z < 8; ++z) {
    const std::uint64_t layer = voxels[static_cast<std::size_t>(z)];
    if (layer == 0) continue;
    const auto by_x = spread_x(layer);
    for (std::size_t x = 0; x < 3; ++x) {
      const auto by_y = spread_y(by_x[x]);
      for (std::size_t y = 0; y < 3; ++y)
        for (int to = z - 2; to <= z + 1; ++to)
          cells[x + 3 * y + 9 * static_cast<std::size_t>((to >> 3) + 1)][static_cast<std::size_t>(to & 7)] |=
              by_y[y];
    }
  }
  return cells;
}

WallCells::WallCells(const volume::SparseVolume& volume, PlaneSource planes)
    : volume_(volume), planes_(std::move(planes)), builder_(planes_) {}

void WallCells::begin_update() {
  for (const std::uint32_t slot : touched_) {
    Brick& brick = bricks_[slot];
    brick.touched = brick.cells_changed = brick.home_changed = false;
    brick.sets_changed = {};
  }
  touched_.clear();
  dirty_slots_.clear();
  dirty_boundary_cells_.clear();
  dirty_corner_sets_.clear();
}

void WallCells::touch(std::uint32_t slot) {
  if (bricks_[slot].touched) return;
  bricks_[slot].touched = true;
  touched_.push_back(slot);
}

void WallCells::add(std::uint32_t slot) {
  if (slot >= bricks_.size()) bricks_.resize(slot + 1);
  bricks_[slot].cells_changed = true;
  touch(slot);
}

void WallCells::remove(std::uint32_t slot) {
  drop(slot);
  touch(slot);
  bricks_[slot].cells.reset();
  bricks_[slot].cells_changed = true;
}

void WallCells::build(std::uint32_t slot, const BrickScene& scene, const CellBuilder::Sealed& sealed) {
  drop(slot);
  Brick& brick = bricks_[slot];
  brick.home = builder_.build(scene, sealed);
  if (!brick.home) return;
  store(*brick.home);
  write_cells(scene.brick, *brick.home, false);
  brick.home_changed = true;
  brick.stale.fill(~std::uint64_t{0});
  touch(slot);
}

/// Gives the brick's cells a place in the lists.
void WallCells::store(BrickCells& home) {
  home.cell_range = cell_arena_.take(static_cast<std::uint32_t>(home.records.size()));
  home.set_range = set_arena_.take(home.set_count);
  if (boundary_cells_.size() < cell_arena_.end()) boundary_cells_.resize(cell_arena_.end());
  if (corner_sets_.size() < set_arena_.end()) corner_sets_.resize(set_arena_.end());
  for (std::size_t i = 0; i < home.records.size(); ++i) {
    shared::BoundaryCell record = home.records[i];
    record.first_set += home.set_range.first;
    boundary_cells_[home.cell_range.first + i] = record;
  }
  std::fill_n(corner_sets_.begin() + home.set_range.first, home.set_range.count, glm::uvec2(0));
}

void WallCells::drop(std::uint32_t slot) {
  Brick& brick = bricks_[slot];
  brick.stale = {};
  if (!brick.home) return;
  write_cells(volume_.brick_of(slot), *brick.home, true);
  cell_arena_.give_back(brick.home->cell_range);
  set_arena_.give_back(brick.home->set_range);
  brick.home.reset();
  brick.home_changed = false;
  brick.sets_changed = {};
}

/// Writes the cells' numbers, or 0, into every brick in which their points may lie: this one and those above.
void WallCells::write_cells(glm::ivec3 brick, const BrickCells& home, bool clear) {
  std::array<std::uint32_t, 8> slots;
  for (int i = 0; i < 8; ++i) slots[static_cast<std::size_t>(i)] = volume_.slot_at(brick + corner_offset(i));
  for (std::size_t k = 0; k < home.cells.size(); ++k) {
    const glm::ivec3 local(home.cells[k] & 7, home.cells[k] >> 3 & 7, home.cells[k] >> 6);
    const glm::ivec3 last = (local + 1) >> 3;
    for (int i = 0; i < 8; ++i) {
      const glm::ivec3 step = corner_offset(i);
      const std::uint32_t slot = slots[static_cast<std::size_t>(i)];
      if (glm::any(glm::greaterThan(step, last)) || slot == kNoSlot) continue;
      Brick& into = bricks_[slot];
      if (!into.cells && clear) continue;
      if (!into.cells) into.cells = std::make_unique<CellTable>();
      const glm::ivec3 at = local + 1 - 8 * step;
      (*into.cells)[static_cast<std::size_t>(at.x + 9 * (at.y + 9 * at.z))] =
          clear ? 0 : home.cell_range.first + static_cast<std::uint32_t>(k) + 1;
      into.cells_changed = true;
      touch(slot);
    }
  }
}

void WallCells::densities_changed(glm::ivec3 brick, const BrickBits& voxels) {
  const volume::NeighbourSlots slots = volume_.slots_around(brick);
  const std::array<BrickBits, 27> cells = cells_that_take(voxels);
  for (std::size_t i = 0; i < 27; ++i) {
    if (slots[i] == kNoSlot || !bricks_[slots[i]].home || cells[i] == BrickBits{}) continue;
    for (std::size_t z = 0; z < 8; ++z) bricks_[slots[i]].stale[z] |= cells[i][z];
    touch(slots[i]);
  }
}

void WallCells::evaluate(std::span<const std::uint8_t> densities) {
  for (const std::uint32_t slot : touched_) {
    Brick& brick = bricks_[slot];
    if (brick.home && brick.stale != BrickBits{}) {
      evaluate_means(*brick.home, brick.stale, densities);
      brick.sets_changed = evaluate_sets(*brick.home, brick.stale, densities);
    }
    brick.stale = {};
  }
}

/// The numbers of the items whose cell is stale. Without a branch for each, which no processor could predict.
template <typename Item>
std::span<const std::uint32_t> WallCells::stale_of(const std::vector<Item>& items,
                                                   const std::array<std::uint16_t, 64>& items_of_row,
                                                   const BrickBits& stale) {
  if (stale_numbers_.size() < items.size()) stale_numbers_.resize(items.size());
  std::size_t count = 0;
  std::uint32_t end = 0;
  for (std::size_t row = 0; row < 64; ++row) {
    const std::uint32_t first = end;
    end += items_of_row[row];
    const auto cells = static_cast<unsigned>(stale[row / 8] >> (8 * (row % 8)) & 0xff);
    if (cells == 0) continue;
    for (std::uint32_t i = first; i < end; ++i) {
      stale_numbers_[count] = i;
      count += cells >> (items[i].cell & 7) & 1;
    }
  }
  return std::span(stale_numbers_).first(count);
}

void WallCells::evaluate_means(BrickCells& home, const BrickBits& stale,
                               std::span<const std::uint8_t> densities) {
  for (const std::uint32_t i : stale_of(home.means, home.means_of_row, stale)) {
    const SmokeMean& mean = home.means[i];
    const std::uint32_t* voxels = home.mean_voxels.data() + mean.first;
    const std::uint8_t* weights = home.mean_weights.data() + mean.first;
    std::uint32_t sum = mean.total / 2u;
    for (std::uint32_t k = 0; k < mean.count; ++k) sum += std::uint32_t{weights[k]} * densities[voxels[k]];
    home.mean_values[i + 1] = static_cast<std::uint8_t>(sum / mean.total);
  }
}

/// Returns the sets that changed, counted in the brick.
volume::IndexRange WallCells::evaluate_sets(BrickCells& home, const BrickBits& stale,
                                            std::span<const std::uint8_t> densities) {
  const std::array<const std::uint8_t*, 2> values{densities.data(), home.mean_values.data()};
  std::uint32_t low = home.set_range.count, high = 0;
  for (const std::uint32_t i : stale_of(home.sources, home.sources_of_row, stale)) {
    // Its eight densities, from voxels or from means.
    const CornerSource& source = home.sources[i];
    const auto value = [&](std::size_t corner) -> std::uint32_t {
      const std::uint32_t from = source.corners[corner];
      return values[from / kMeanBit][from & ~kMeanBit];
    };
    const glm::uvec2 packed(value(0) | value(1) << 8 | value(2) << 16 | value(3) << 24,
                            value(4) | value(5) << 8 | value(6) << 16 | value(7) << 24);

    // Every set of the cell that has these corners.
    for (unsigned sides = source.sides; sides != 0; sides &= sides - 1) {
      const std::uint32_t set = source.first_set + static_cast<std::uint32_t>(std::countr_zero(sides));
      glm::uvec2& held = corner_sets_[home.set_range.first + set];
      if (held == packed) continue;
      held = packed;
      low = std::min(low, set);
      high = std::max(high, set + 1);
    }
  }
  return low < high ? volume::IndexRange{low, high - low} : volume::IndexRange{};
}

void WallCells::shrink() {
  std::erase_if(touched_, [&](std::uint32_t slot) { return slot >= volume_.slot_count(); });
  bricks_.resize(volume_.slot_count());
  if (!bricks_.empty()) return;
  boundary_cells_.clear();
  corner_sets_.clear();
}

void WallCells::end_update() {
  std::sort(touched_.begin(), touched_.end());
  for (const std::uint32_t slot : touched_) {
    const Brick& brick = bricks_[slot];
    if (brick.cells_changed) dirty_slots_.push_back(slot);
    if (brick.home && brick.home_changed) {
      dirty_boundary_cells_.push_back(brick.home->cell_range);
      dirty_corner_sets_.push_back(brick.home->set_range);
    } else if (brick.home && brick.sets_changed.count > 0) {
      dirty_corner_sets_.push_back(
          {brick.home->set_range.first + brick.sets_changed.first, brick.sets_changed.count});
    }
  }
  sort_and_merge(dirty_boundary_cells_);
  sort_and_merge(dirty_corner_sets_);
}

std::span<const std::uint32_t> WallCells::cells(std::uint32_t slot) const {
  static constexpr CellTable kNone{};
  return bricks_[slot].cells ? *bricks_[slot].cells : kNone;
}

std::uint64_t WallCells::bytes() const {
  std::uint64_t sum = boundary_cells_.capacity() * sizeof(shared::BoundaryCell) +
                      corner_sets_.capacity() * sizeof(glm::uvec2) + bricks_.capacity() * sizeof(Brick);
  for (const Brick& brick : bricks_) {
    if (brick.cells) sum += sizeof(CellTable);
    if (const BrickCells* home = brick.home.get())
      sum += sizeof(BrickCells) + home->cells.capacity() * 2 +
             home->records.capacity() * sizeof(shared::BoundaryCell) +
             home->means.capacity() * (sizeof(SmokeMean) + 1) + home->mean_voxels.capacity() * 4 +
             home->mean_weights.capacity() + home->sources.capacity() * sizeof(CornerSource);
  }
  return sum;
}

}  // namespace brume::smoke
