#include "smoke/smoke_volume.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace brume::smoke {
namespace {

/// Numbers of voxels and means share 32 bits.
constexpr std::uint32_t kMaxSlots = kMeanBit / kVoxelsPerBrick;
/// The bricks that a block's voxels are in or within two voxels of: a surface may run that far beyond them.
void add_bricks_around(const sim::VoxelBlock& block, std::vector<glm::ivec3>& bricks) {
  constexpr std::array<std::uint64_t, 3> kLowHalf{0x3333333333333333u, 0x00ff00ff00ff00ffu, 0xffffffffu};
  const glm::ivec3 at(block.at);
  for (int way = 0; way < 8; ++way) {
    std::uint64_t mask = block.mask;
    glm::ivec3 brick = at >> 1;
    for (int axis = 0; axis < 3; ++axis) {
      if ((way >> axis & 1) == 0) continue;
      const bool upper = (at[axis] & 1) != 0;
      const std::uint64_t low = kLowHalf[static_cast<std::size_t>(axis)];
      mask &= upper ? ~low : low;
      brick[axis] += upper ? 1 : -1;
    }
    if (mask != 0) bricks.push_back(brick);
  }
}

bool brick_before(glm::ivec3 a, glm::ivec3 b) {
  return a.z != b.z ? a.z < b.z : a.y != b.y ? a.y < b.y : a.x < b.x;
}

void sort_unique(std::vector<glm::ivec3>& bricks) {
  std::sort(bricks.begin(), bricks.end(), brick_before);
  bricks.erase(std::unique(bricks.begin(), bricks.end()), bricks.end());
}

BrickBlocks no_blocks() {
  BrickBlocks blocks;
  blocks.fill(kNoBlock);
  return blocks;
}

/// Which blocks of a set are those of a brick; all kNoBlock when there is none.
BrickBlocks blocks_in(const sim::BlockSet& set, glm::ivec3 brick) {
  BrickBlocks blocks = no_blocks();
  for (std::size_t i = 0; i < 8; ++i) {
    const glm::ivec3 at = 2 * brick + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
    if (const sim::VoxelBlock* block = set.find_block(at))
      blocks[i] = static_cast<std::uint32_t>(block - set.blocks().data());
  }
  return blocks;
}

bool reaches(const sim::BlockSet& set, glm::ivec3 brick) {
  return glm::all(glm::lessThanEqual(set.low(), 8 * brick + 7)) &&
         glm::all(glm::greaterThanEqual(set.high(), 8 * brick));
}

void add_blast_part(SmokeBrick& brick, const SmokeSink& sink) {
  if (!reaches(sink.field->reached(), brick.at)) return;
  const BlastPart part{&sink, blocks_in(sink.field->reached(), brick.at)};
  if (part.blocks == no_blocks()) return;
  const auto after = std::find_if(brick.blasts.begin(), brick.blasts.end(),
                                  [&](const BlastPart& other) { return other.sink->id > sink.id; });
  brick.blasts.insert(after, part);
}

/// Goes through what is there and what will be, both by id: `add` makes what is new, `keep` says whether a
/// thing stays as it is. Returns what is no longer there; `held` is then what will be.
template <typename Held, typename Live, typename Keep, typename Add>
std::vector<std::unique_ptr<Held>> exchange(std::vector<std::unique_ptr<Held>>& held,
                                            const std::vector<Live>& live, Keep keep, Add add) {
  std::vector<std::unique_ptr<Held>> gone, next;
  next.reserve(live.size());
  std::size_t i = 0;
  for (const Live& one : live) {
    while (i < held.size() && held[i]->id < one.id) gone.push_back(std::move(held[i++]));
    if (i < held.size() && held[i]->id == one.id) {
      if (keep(*held[i], one)) {
        next.push_back(std::move(held[i++]));
        continue;
      }
      gone.push_back(std::move(held[i++]));
    }
    next.push_back(add(one));
  }
  while (i < held.size()) gone.push_back(std::move(held[i++]));
  held = std::move(next);
  return gone;
}

}  // namespace

SmokeVolume::SmokeVolume(const voxel::BitGrid& grid, PlaneSource planes)
    : grid_layout_(grid.layout()), planes_(std::move(planes)), builder_(planes_) {
  layout_.origin_world = grid_layout_.origin_world;
  layout_.voxel_size = grid_layout_.voxel_size;
}

SmokeVolume::SmokeVolume(const voxel::BitGrid& grid, const voxel::SurfacePlanes& planes)
    : SmokeVolume(grid, [&planes](glm::ivec3 cell) { return planes.at(cell); }) {}

void SmokeVolume::update(const sim::State& state, const voxel::BitGrid& grid) {
  BRUME_ASSERT(grid.layout() == grid_layout_ && state.layout == grid_layout_, "the state is of another grid");
  grid_ = &grid;
  pages_.forget_changes();
  take_edits(state);
  take_clouds(state);
  take_blasts(state);
  update_structure();
  update_phases(state);
  refresh();
  report_changes();
  ++revision_;
  grid_ = nullptr;
}

void SmokeVolume::mark(std::uint32_t slot, bool SmokeBrick::*what) {
  SmokeBrick& brick = *slots_[slot];
  if (!brick.touched) touched_.push_back(slot);
  brick.touched = true;
  brick.*what = true;
}

void SmokeVolume::take_clouds(const sim::State& state) {
  const auto same = [](const sim::LiveCloud& a, const sim::LiveCloud& b) { return a.id == b.id && a.cloud == b.cloud; };
  if (std::equal(seen_clouds_.begin(), seen_clouds_.end(), state.clouds.begin(), state.clouds.end(), same))
    return;
  seen_clouds_ = state.clouds;
  // What comes is added before what goes is removed: no brick that stays loses its slot in between.
  const auto gone = exchange(
      sources_, state.clouds,
      [](SmokeSource& held, const sim::LiveCloud& live) {
        if (held.cloud != live.cloud && held.cloud->hash() != live.cloud->hash()) return false;
        held.cloud = live.cloud;
        return true;
      },
      [&](const sim::LiveCloud& live) {
        auto source = std::make_unique<SmokeSource>();
        source->id = live.id;
        source->cloud = live.cloud;
        add_cloud(*source);
        return source;
      });
  for (const auto& source : gone) remove_cloud(*source);
  steady_.clear();
  for (const auto& source : sources_) steady_.push_back(source->steady);
}

void SmokeVolume::add_cloud(SmokeSource& source) {
  structure_changed_ = true;
  const std::span<const sim::VoxelBlock> blocks = source.cloud->voxels().blocks();
  std::vector<glm::ivec3> bricks;
  for (const sim::VoxelBlock& block : blocks) add_bricks_around(block, bricks);
  sort_unique(bricks);
  for (const glm::ivec3 brick : bricks) source.slots.push_back(need_brick(brick));
  source.slot_of_block.reserve(blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const glm::ivec3 at(blocks[i].at);
    const std::uint32_t slot = slot_at(at >> 1);
    source.slot_of_block.push_back(slot);
    std::vector<CloudPart>& parts = slots_[slot]->clouds;
    if (parts.empty() || parts.back().source != &source) parts.push_back({&source, no_blocks()});
    parts.back().blocks[block_in_brick(at)] = static_cast<std::uint32_t>(i);
    mark(slot, &SmokeBrick::masks_stale);
  }
}

void SmokeVolume::remove_cloud(SmokeSource& source) {
  structure_changed_ = true;
  for (const std::uint32_t slot : source.slots) {
    SmokeBrick& brick = *slots_[slot];
    std::erase_if(brick.clouds, [&](const CloudPart& part) { return part.source == &source; });
    mark(slot, &SmokeBrick::masks_stale);
    mark(slot, &SmokeBrick::densities_stale);
    --brick.needed;
  }
}

std::array<std::uint32_t, 27> SmokeVolume::slots_around(glm::ivec3 brick) const {
  std::array<std::uint32_t, 27> slots;
  for (int i = 0; i < 27; ++i)
    slots[static_cast<std::size_t>(i)] = slot_at(brick + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1);
  return slots;
}

/// The slot of the brick, a new one when it has none; counts that one cloud more needs it.
std::uint32_t SmokeVolume::need_brick(glm::ivec3 at) {
  std::uint32_t slot = slot_at(at);
  if (slot == kNoSlot) {
    slot = slot_count();
    if (free_slots_.empty()) {
      if (slot == kMaxSlots)
        throw Error(ErrorCode::resource_limit, "smoke in more than " + std::to_string(kMaxSlots) +
                                                   " bricks of 8^3 voxels; use larger voxels");
      slots_.push_back(std::make_unique<SmokeBrick>());
      densities_.resize(std::size_t{kVoxelsPerBrick} * slots_.size());
    } else {
      slot = free_slots_.top();
      free_slots_.pop();
    }
    SmokeBrick& brick = *slots_[slot];
    brick.live = true;
    brick.at = at;
    for (const auto& sink : sinks_) add_blast_part(brick, *sink);
    pages_.set(at, slot);
    mark(slot, &SmokeBrick::fresh);
    mark(slot, &SmokeBrick::cells_stale);
  }
  ++slots_[slot]->needed;
  return slot;
}

void SmokeVolume::free_slot(std::uint32_t slot) {
  SmokeBrick& brick = *slots_[slot];
  drop_cells(brick);
  // What was here still shows in the aprons around.
  std::uint8_t* densities = densities_.data() + std::size_t{slot} * kVoxelsPerBrick;
  for (std::size_t i = 0; i < kVoxelsPerBrick; ++i)
    brick.changed[i / 64] |= std::uint64_t{densities[i] != 0} << i % 64;
  std::fill_n(densities, kVoxelsPerBrick, std::uint8_t{0});
  if (brick.changed != BrickBits{}) spread_changes(brick);
  pages_.set(brick.at, kNoSlot);
  brick = SmokeBrick{};
  brick.touched = brick.texels_changed = brick.cells_changed = true;
  free_slots_.push(slot);
}

void SmokeVolume::take_blasts(const sim::State& state) {
  const auto same = [](const std::unique_ptr<SmokeSink>& held, const sim::LiveBlast& live) {
    return held->id == live.id && held->field == live.field;
  };
  if (std::equal(sinks_.begin(), sinks_.end(), state.blasts.begin(), state.blasts.end(), same)) return;
  const auto gone = exchange(
      sinks_, state.blasts,
      [](SmokeSink& held, const sim::LiveBlast& live) {
        if (held.field != live.field && held.field->hash() != live.field->hash()) return false;
        held.field = live.field;
        return true;
      },
      [&](const sim::LiveBlast& live) {
        auto sink = std::make_unique<SmokeSink>();
        sink->id = live.id;
        sink->field = live.field;
        sink->profile = live.field->profile(state.tick);
        for (const sim::VoxelBlock& block : live.field->reached().blocks())
          sink->bricks.push_back(glm::ivec3(block.at) >> 1);
        sort_unique(sink->bricks);
        add_blast(*sink);
        return sink;
      });
  for (const auto& sink : gone) remove_blast(*sink);
}

void SmokeVolume::add_blast(SmokeSink& sink) {
  for (const glm::ivec3 at : sink.bricks)
    if (const std::uint32_t slot = slot_at(at); slot != kNoSlot) {
      add_blast_part(*slots_[slot], sink);
      mark(slot, &SmokeBrick::densities_stale);
    }
}

void SmokeVolume::remove_blast(const SmokeSink& sink) {
  for (const glm::ivec3 at : sink.bricks)
    if (const std::uint32_t slot = slot_at(at); slot != kNoSlot) {
      std::erase_if(slots_[slot]->blasts, [&](const BlastPart& part) { return part.sink == &sink; });
      mark(slot, &SmokeBrick::densities_stale);
    }
}

void SmokeVolume::take_edits(const sim::State& state) {
  if (state.edits == edits_) return;
  static const sim::EditBlocks kNone;
  const sim::EditBlocks& was = edits_ ? *edits_ : kNone;
  const sim::EditBlocks& is = state.edits ? *state.edits : kNone;
  auto a = was.begin(), b = is.begin();
  while (a != was.end() || b != is.end()) {
    const bool take_a = b == is.end() || (a != was.end() && !sim::block_before(b->at, a->at));
    const bool take_b = a == was.end() || (b != is.end() && !sim::block_before(a->at, b->at));
    const sim::EditBlock before = take_a ? *a : sim::EditBlock{}, after = take_b ? *b : sim::EditBlock{};
    const std::uint64_t mask = (before.make_solid ^ after.make_solid) | (before.make_free ^ after.make_free);
    if (mask != 0) voxels_changed(glm::ivec3(take_a ? a->at : b->at), mask);
    if (take_a) ++a;
    if (take_b) ++b;
  }
  edits_ = state.edits;
}

/// Voxels of a block became solid or free.
void SmokeVolume::voxels_changed(glm::ivec3 block, std::uint64_t mask) {
  BrickBits bits{};
  set_block(bits, block_in_brick(block), mask);
  pockets_.changed(block >> 1, bits, stale_bricks_);
  mark_walls(sim::kBlockSize * block - 2, sim::kBlockSize * block + sim::kBlockSize + 1);
}

void SmokeVolume::planes_changed(glm::ivec3 low_cell, glm::ivec3 high_cell) {
  // A cell looks at the planes of those next to it; its voxel numbers are its corners' lowest.
  mark_walls(low_cell - 1, high_cell + 1);
}

/// What depends on the walls of these voxels is to be built anew.
void SmokeVolume::mark_walls(glm::ivec3 low_voxel, glm::ivec3 high_voxel) {
  const glm::ivec3 low = glm::max(low_voxel >> 3, 8 * pages_.origin());
  const glm::ivec3 high = glm::min(high_voxel >> 3, 8 * (pages_.origin() + pages_.size()) - 1);
  if (glm::any(glm::lessThan(high, low))) return;
  const auto stale = [&](std::uint32_t slot) {
    mark(slot, &SmokeBrick::walls_stale);
    mark(slot, &SmokeBrick::cells_stale);
  };
  const glm::u64vec3 bricks(high - low + 1);
  if (bricks.x * bricks.y * bricks.z > slot_count()) {
    for (std::uint32_t slot = 0; slot < slot_count(); ++slot) {
      const SmokeBrick& brick = *slots_[slot];
      if (brick.live && glm::all(glm::greaterThanEqual(brick.at, low)) &&
          glm::all(glm::lessThanEqual(brick.at, high)))
        stale(slot);
    }
    return;
  }
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        if (const std::uint32_t slot = slot_at({x, y, z}); slot != kNoSlot) stale(slot);
}

std::span<const std::uint32_t> SmokeVolume::cells(std::uint32_t slot) const {
  static constexpr std::array<std::uint32_t, shared::kCellsPerBrick> kNone{};
  return slots_[slot]->cells ? *slots_[slot]->cells : kNone;
}

std::uint64_t SmokeVolume::bytes() const {
  std::uint64_t sum = densities_.capacity() + boundary_cells_.capacity() * sizeof(shared::BoundaryCell) +
                      corner_sets_.capacity() * sizeof(glm::uvec2) + pages_.root().size_bytes() +
                      pages_.nodes().size_bytes();
  for (const auto& brick : slots_) {
    sum += sizeof(SmokeBrick) + brick->clouds.capacity() * sizeof(CloudPart) +
           brick->blasts.capacity() * sizeof(BlastPart) + (brick->cells ? sizeof(*brick->cells) : 0);
    if (const BrickCells* home = brick->home.get())
      sum += sizeof(BrickCells) + home->cells.capacity() * 2 +
             home->records.capacity() * sizeof(shared::BoundaryCell) +
             home->means.capacity() * (sizeof(SmokeMean) + 1) + home->mean_voxels.capacity() * 4 +
             home->mean_weights.capacity() + home->sources.capacity() * sizeof(CornerSource);
  }
  for (const auto& source : sources_)
    sum += sizeof(SmokeSource) + source->densities.capacity() +
           4 * (source->slot_of_block.capacity() + source->slots.capacity());
  return sum;
}

}  // namespace brume::smoke
