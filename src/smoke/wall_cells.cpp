#include "smoke/wall_cells.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace brume::smoke {
namespace {

constexpr std::uint32_t kNoSlot = volume::SparseVolume::kNoSlot;
/// Forms are only kept while they are fewer than this, or than twice the boundary cells.
constexpr std::uint64_t kLeastForms = 1u << 16;

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

template <typename Visit>
void for_each_cell(const BrickBits& cells, Visit visit) {
  for (std::uint32_t z = 0; z < 8; ++z)
    for (std::uint64_t bits = cells[z]; bits != 0; bits &= bits - 1)
      visit(64 * z + static_cast<std::uint32_t>(std::countr_zero(bits)));
}

}  // namespace

WallCells::WallCells(const volume::SparseVolume& volume, PlaneSource planes)
    : volume_(volume), planes_(std::move(planes)), former_(planes_) {}

void WallCells::begin_update() {
  for (const std::uint32_t slot : changed_) {
    if (slot >= bricks_.size()) continue;
    Brick& brick = bricks_[slot];
    brick.changed_hands = brick.listed = false;
    if (!brick.home) continue;
    brick.home->cells_changed = {};
    for (SetChunk& chunk : brick.home->chunks) chunk.changed = {};
  }
  changed_.clear();
  dirty_slots_.clear();
  dirty_boundary_cells_.clear();
  dirty_corner_sets_.clear();
  boundary_cells_.forget_old();
  corner_sets_.forget_old();
  former_placed_ = false;
  if (forms_.size() <= std::max(kLeastForms, 2 * cell_count_)) return;
  forms_.clear();
  for (Brick& brick : bricks_)
    if (brick.home) brick.home->forms.fill(0);
}

/// Lists a slot as one with something to report.
void WallCells::note(std::uint32_t slot) {
  if (bricks_[slot].listed) return;
  bricks_[slot].listed = true;
  changed_.push_back(slot);
}

void WallCells::add(std::uint32_t slot) {
  if (slot >= bricks_.size()) bricks_.resize(slot + 1);
  bricks_[slot].changed_hands = bricks_[slot].table_stale = true;
  note(slot);
}

void WallCells::remove(std::uint32_t slot) {
  drop(slot);
  Brick& brick = bricks_[slot];
  brick.cells.reset();
  brick.table_stale = false;
  brick.changed_hands = true;
  note(slot);
}

void WallCells::shrink() {
  bricks_.resize(volume_.slot_count());
  if (!bricks_.empty()) return;
  boundary_cells_.clear();
  corner_sets_.clear();
}

/// Removes the boundary cells of a brick.
void WallCells::drop(std::uint32_t slot) {
  Brick& brick = bricks_[slot];
  if (!brick.home) return;
  mark_tables(volume_.brick_of(slot));
  give_back(*brick.home);
  brick.home.reset();
}

/// Frees the places of a brick's cells in the lists.
void WallCells::give_back(Home& home) {
  cell_count_ -= home.cell_range.count;
  cell_arena_.give_back(std::exchange(home.cell_range, {}));
  for (const SetChunk& chunk : home.chunks) set_arena_.give_back(chunk.range);
  home.chunks.clear();
}

/// The numbers of a brick's cells changed: they are in the tables of this brick and of those below.
void WallCells::mark_tables(glm::ivec3 brick) {
  for (int i = 0; i < 8; ++i) {
    const std::uint32_t slot = volume_.slot_at(brick - corner_offset(i));
    if (slot == kNoSlot) continue;
    bricks_[slot].table_stale = true;
    note(slot);
  }
}

void WallCells::build(std::uint32_t slot, const VoxelWindow& solid, const VoxelWindow& smoke,
                      bool walls_changed) {
  BrickBits cells = cells_at_solid(solid);
  const BrickBits near_smoke = cells_near_smoke(smoke);
  for (std::size_t z = 0; z < 8; ++z) cells[z] &= near_smoke[z];
  Brick& brick = bricks_[slot];
  if (cells == BrickBits{}) {
    drop(slot);
    return;
  }

  // At the same walls the same forms hold, other than bent ones; and the same cells keep their numbers.
  if (!brick.home) brick.home = std::make_unique<Home>();
  Home& home = *brick.home;
  home.solid = solid;
  home.smoke = smoke;
  if (walls_changed) {
    home.forms.fill(0);
  } else {
    for (std::uint32_t& form : home.forms)
      if (form != 0 && forms_.bent(form - 1)) form = 0;
  }
  if (walls_changed || cells != home.cells) list_cells(volume_.brick_of(slot), cells, home);
  home.stale = cells;
  note(slot);
}

/// Gives the cells of a brick numbers.
void WallCells::list_cells(glm::ivec3 brick, const BrickBits& cells, Home& home) {
  std::uint32_t count = 0;
  for (const std::uint64_t layer : cells) count += static_cast<std::uint32_t>(std::popcount(layer));
  give_back(home);
  home.cell_range = cell_arena_.take(count);
  cell_count_ += count;
  boundary_cells_.grow(cell_arena_.end());
  home.cells_changed = {};
  home.cells_changed.add(home.cell_range);

  home.cells = cells;
  home.entries.fill(0);
  std::uint32_t number = home.cell_range.first;
  for_each_cell(cells, [&](std::uint32_t cell) {
    home.entries[cell] = number + 1;
    boundary_cells_[number++] = {0, 0, 0, kNoSets};
  });
  mark_tables(brick);
}

/// Places of the corner sets of a cell. How many all cells have is only known when all are computed: most
/// have a plane, and two sets.
std::uint32_t WallCells::take_sets(Home& home, std::uint32_t count) {
  const auto has_room = [&](const SetChunk& chunk) { return chunk.used + count <= chunk.range.count; };
  auto chunk = std::ranges::find_if(home.chunks, has_room);
  if (chunk == home.chunks.end()) {
    const std::uint32_t size = home.chunks.empty() ? 2 * home.cell_range.count : home.cell_range.count;
    const volume::IndexRange range = set_arena_.take(std::max(size, 8u));
    corner_sets_.grow(set_arena_.end());
    home.chunks.push_back({range, 0, {}});
    chunk = home.chunks.end() - 1;
  }
  const volume::IndexRange sets{chunk->range.first + chunk->used, count};
  chunk->used += count;
  chunk->changed.add(sets);
  return sets.first;
}

void WallCells::write_sets(Home& home, std::uint32_t first, std::span<const glm::uvec2> sets) {
  const auto holds = [&](const SetChunk& chunk) { return first - chunk.range.first < chunk.range.count; };
  SetChunk& chunk = *std::ranges::find_if(home.chunks, holds);
  for (std::uint32_t side = 0; side < sets.size(); ++side) {
    glm::uvec2& held = corner_sets_[first + side];
    if (held == sets[side]) continue;
    held = sets[side];
    chunk.changed.add({first + side, 1});
  }
}

void WallCells::move_former_to(glm::ivec3 brick) {
  if (former_placed_ && former_brick_ == brick) return;
  former_.move_to(brick);
  former_brick_ = brick;
  former_placed_ = true;
}

void WallCells::densities_changed(glm::ivec3 brick, const BrickBits& voxels) {
  const volume::NeighbourSlots slots = volume_.slots_around(brick);
  const std::array<BrickBits, 27> cells = cells_that_take(voxels);
  for (std::size_t i = 0; i < 27; ++i) {
    if (slots[i] == kNoSlot || !bricks_[slots[i]].home) continue;
    Home& home = *bricks_[slots[i]].home;
    for (std::size_t z = 0; z < 8; ++z) home.stale[z] |= cells[i][z] & home.cells[z];
  }
}

void WallCells::compute(std::uint32_t slot, std::uint32_t cell, std::span<const std::uint8_t> densities,
                        const CellFormer::Sealed& sealed) {
  note(slot);
  compute(volume_.brick_of(slot), *bricks_[slot].home, cell, densities, sealed);
}

void WallCells::compute(glm::ivec3 brick, Home& home, std::uint32_t cell,
                        std::span<const std::uint8_t> densities, const CellFormer::Sealed& sealed) {
  // Its planes, and places for its sets.
  const std::uint32_t form = form_of(brick, home, cell, sealed), number = home.entries[cell] - 1;
  const std::array<std::uint32_t, 3>& planes = forms_.planes(form);
  shared::BoundaryCell record{planes[0], planes[1], planes[2], boundary_cells_[number].first_set};
  if (record.first_set == kNoSets) record.first_set = take_sets(home, forms_.side_count(form));
  shared::BoundaryCell& held = boundary_cells_[number];
  if (std::memcmp(&held, &record, sizeof record) != 0) {
    held = record;
    home.cells_changed.add({number, 1});
  }

  const Neighbourhood64 smoke =
      forms_.reads_smoke(form) ? neighbourhood_of(home.smoke, cell) : Neighbourhood64{0};
  const CellDensities around = densities_around(cell_of_brick(brick, cell), densities);
  write_sets(home, record.first_set, forms_.corner_sets(form, around, smoke));
  std::atomic_ref(home.stale[cell >> 6])
      .fetch_and(~(std::uint64_t{1} << (cell & 63)), std::memory_order_release);
}

std::uint32_t WallCells::form_of(glm::ivec3 brick, Home& home, std::uint32_t cell,
                                 const CellFormer::Sealed& sealed) {
  if (home.forms[cell] != 0) return home.forms[cell] - 1;
  move_former_to(brick);
  const CellSurroundings around{cell_of_brick(brick, cell), ~neighbourhood_of(home.solid, cell),
                                neighbourhood_of(home.smoke, cell)};
  const std::uint32_t form = forms_.number_of(former_.form(around, sealed));
  home.forms[cell] = form + 1;
  return form;
}

/// The densities of the 4^3 voxels around a cell.
CellDensities WallCells::densities_around(glm::ivec3 cell, std::span<const std::uint8_t> densities) const {
  // Up to two bricks an axis.
  CellDensities around{};
  const glm::ivec3 low = cell - 1, first = low >> 3, steps = ((low + 3) >> 3) - first;
  std::array<const std::uint8_t*, 8> bricks{};
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 step = corner_offset(i);
    if (glm::any(glm::greaterThan(step, steps))) continue;
    const std::uint32_t slot = volume_.slot_at(first + step);
    if (slot != kNoSlot)
      bricks[static_cast<std::size_t>(i)] = densities.data() + std::size_t{slot} * kVoxelsPerBrick;
  }
  // Rows of four, the first ones in the lower brick.
  const int in_lower = std::min(4, 8 - (low.x & 7));
  std::uint8_t* row = around.data();
  for (int z = low.z; z < low.z + 4; ++z)
    for (int y = low.y; y < low.y + 4; ++y, row += 4) {
      const auto pair = static_cast<std::size_t>(2 * ((y >> 3) - first.y) + 4 * ((z >> 3) - first.z));
      const std::uint32_t at = local_voxel({low.x, y, z});
      if (in_lower == 4) {
        if (bricks[pair]) std::memcpy(row, bricks[pair] + at, 4);
        continue;
      }
      if (bricks[pair]) std::copy_n(bricks[pair] + at, in_lower, row);
      if (bricks[pair + 1]) std::copy_n(bricks[pair + 1] + (at & ~7u), 4 - in_lower, row + in_lower);
    }
  return around;
}

void WallCells::compute_all(std::span<const std::uint8_t> densities, const SealedOfBrick& sealed_of) {
  for (std::uint32_t slot = 0; slot < bricks_.size(); ++slot) {
    if (bricks_[slot].table_stale) note(slot);
    if (!bricks_[slot].home || bricks_[slot].home->stale == BrickBits{}) continue;
    Home& home = *bricks_[slot].home;
    note(slot);
    const BrickBits stale = home.stale;
    const glm::ivec3 brick = volume_.brick_of(slot);
    const CellFormer::Sealed sealed = sealed_of(brick);
    for_each_cell(stale, [&](std::uint32_t cell) { compute(brick, home, cell, densities, sealed); });
  }
  publish();
}

/// Writes the entries of the cells that overlap a brick; returns whether any changed.
bool WallCells::write_table(std::uint32_t slot) {
  CellTable table{};
  bool any = false;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 step = corner_offset(i);
    const std::uint32_t from = volume_.slot_at(volume_.brick_of(slot) + step);
    if (from == kNoSlot || !bricks_[from].home) continue;
    any = true;
    // All of the brick's own cells, of the bricks above those at the face.
    const glm::ivec3 end = 8 - 7 * step;
    for (int z = 0; z < end.z; ++z)
      for (int y = 0; y < end.y; ++y) {
        const auto to = static_cast<std::size_t>(8 * step.x + 9 * (y + 8 * step.y + 9 * (z + 8 * step.z)));
        std::copy_n(bricks_[from].home->entries.data() + 8 * y + 64 * z, end.x, table.data() + to);
      }
  }
  std::unique_ptr<CellTable>& held = bricks_[slot].cells;
  if (!any || table == CellTable{}) {
    const bool changed = held != nullptr;
    held.reset();
    return changed;
  }
  if (held && *held == table) return false;
  if (!held) held = std::make_unique<CellTable>();
  *held = table;
  return true;
}

/// Lists what is dirty.
void WallCells::publish() {
  dirty_slots_.clear();
  dirty_boundary_cells_.clear();
  dirty_corner_sets_.clear();
  std::erase_if(changed_, [&](std::uint32_t slot) { return slot >= bricks_.size(); });
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  for (const std::uint32_t slot : changed_) {
    Brick& brick = bricks_[slot];
    if (brick.table_stale && write_table(slot)) brick.changed_hands = true;
    brick.table_stale = false;
    if (brick.changed_hands) dirty_slots_.push_back(slot);
    if (!brick.home) continue;
    const auto list = [](const Changes& changes, std::vector<volume::IndexRange>& ranges) {
      if (changes.low < changes.high) ranges.push_back({changes.low, changes.high - changes.low});
    };
    list(brick.home->cells_changed, dirty_boundary_cells_);
    for (const SetChunk& chunk : brick.home->chunks) list(chunk.changed, dirty_corner_sets_);
  }
  sort_and_merge(dirty_boundary_cells_);
  sort_and_merge(dirty_corner_sets_);
}

std::span<const std::uint32_t> WallCells::cells(std::uint32_t slot) const {
  static constexpr CellTable kNone{};
  return bricks_[slot].cells ? *bricks_[slot].cells : kNone;
}

std::uint64_t WallCells::bytes() const {
  std::uint64_t sum =
      boundary_cells_.bytes() + corner_sets_.bytes() + forms_.bytes() + bricks_.capacity() * sizeof(Brick);
  for (const Brick& brick : bricks_) {
    if (brick.cells) sum += sizeof(CellTable);
    if (brick.home) sum += sizeof(Home) + brick.home->chunks.capacity() * sizeof(SetChunk);
  }
  return sum;
}

}  // namespace brume::smoke
