// The part of SmokeVolume that follows the densities: tick by tick, only what changes.
#include <algorithm>
#include <bit>
#include <cstring>

#include "smoke/smoke_volume.hpp"

namespace brume::smoke {
namespace {

using BrickDensities = std::array<std::uint8_t, kVoxelsPerBrick>;

/// The densities of a whole cloud by rank.
void densities_of(const sim::Cloud& cloud, const sim::CloudPhase& phase, std::vector<std::uint8_t>& out) {
  out.resize(cloud.voxels().size());
  const sim::CloudParts& parts = cloud.parts();
  if (parts.flow_tick != 0 || !parts.detached.empty() || phase.dissolved != 0) {
    for (std::uint32_t rank = 0; rank < out.size(); ++rank) out[rank] = cloud.density(rank, phase);
    return;
  }
  // Only the reach counts: 0 from the front on, full from the taper inwards; between them a table.
  const auto end =
      static_cast<std::uint32_t>(std::min<sim::Front>(phase.front / sim::kFrontUnit + 1, sim::Cloud::kNoDistance));
  std::vector<std::uint8_t> taper;
  std::uint32_t begin = end;
  while (begin > 0 && (taper.empty() || taper.back() < 255))
    taper.push_back(sim::Cloud::profile(--begin, phase.front));
  taper.insert(taper.begin(), 0);  // for `end` and beyond
  const auto last = static_cast<std::uint32_t>(taper.size() - 1);
  for (std::uint32_t rank = 0; rank < out.size(); ++rank) {
    const std::uint32_t within = end - std::min(cloud.reach(rank), end);
    out[rank] = taper[std::min(within, last)];
  }
}

/// Index of a brick's voxel from the brick's block and the bit in it.
constexpr std::size_t first_of_block(std::size_t block) {
  return 4 * (block & 1) + 32 * (block >> 1 & 1) + 256 * (block >> 2);
}
constexpr std::size_t voxel_of_bit(int bit) {
  return static_cast<std::size_t>((bit & 3) + 8 * (bit >> 2 & 3) + 64 * (bit >> 4));
}

void add_cloud_part(const CloudPart& part, BrickDensities& sums) {
  for (std::size_t i = 0; i < 8; ++i) {
    if (part.blocks[i] == kNoBlock) continue;
    const sim::VoxelBlock& block = part.source->cloud->voxels().blocks()[part.blocks[i]];
    const std::uint8_t* density = part.source->densities.data() + block.first;
    std::uint8_t* sum = sums.data() + first_of_block(i);
    for (std::uint64_t left = block.mask; left != 0; left &= left - 1) {
      std::uint8_t& here = sum[voxel_of_bit(std::countr_zero(left))];
      here = static_cast<std::uint8_t>(std::min(255, here + *density++));
    }
  }
}

void apply_blast_part(const BlastPart& part, BrickDensities& densities) {
  const sim::BlastField& field = *part.sink->field;
  for (std::size_t i = 0; i < 8; ++i) {
    if (part.blocks[i] == kNoBlock) continue;
    const sim::VoxelBlock& block = field.reached().blocks()[part.blocks[i]];
    const std::uint8_t* reach = field.reach().data() + block.first;
    std::uint8_t* density = densities.data() + first_of_block(i);
    for (std::uint64_t left = block.mask; left != 0; left &= left - 1) {
      std::uint8_t& here = density[voxel_of_bit(std::countr_zero(left))];
      here = sim::scaled_density(here, part.sink->profile.remaining[*reach++]);
    }
  }
}

/// The texel of each voxel of a brick.
constexpr std::array<std::uint16_t, kVoxelsPerBrick> make_texels_of_voxels() {
  std::array<std::uint16_t, kVoxelsPerBrick> texels{};
  for (unsigned i = 0; i < kVoxelsPerBrick; ++i)
    texels[i] = static_cast<std::uint16_t>((i & 7) + 1 + 10 * ((i >> 3 & 7) + 1) + 100 * ((i >> 6) + 1));
  return texels;
}
constexpr auto kTexelOfVoxel = make_texels_of_voxels();

constexpr std::uint64_t kColumn0 = 0x0101010101010101u;

/// For voxels of a layer, the cells voxel - 2 to voxel + 1 along x in the brick before, this one and the
/// next.
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
  std::size_t kept = 0;
  for (const volume::IndexRange& range : ranges) {
    // What lies between near ranges costs less than a copy of its own.
    if (kept > 0 && range.first <= ranges[kept - 1].first + ranges[kept - 1].count + 8)
      ranges[kept - 1].count = range.first + range.count - ranges[kept - 1].first;
    else
      ranges[kept++] = range;
  }
  ranges.resize(kept);
}

}  // namespace

void SmokeVolume::update_phases(const sim::State& state) {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (state.tick >= steady_[i].first && state.tick <= steady_[i].last) continue;
    update_phase(*sources_[i], state.tick);
    steady_[i] = sources_[i]->steady;
  }
  for (const auto& sink : sinks_) {
    const sim::BlastProfile profile = sink->field->profile(state.tick);
    if (profile == sink->profile) continue;
    sink->profile = profile;
    for (const glm::ivec3 at : sink->bricks)
      if (const std::uint32_t slot = slot_at(at); slot != kNoSlot && !slots_[slot]->clouds.empty())
        mark(slot, &SmokeBrick::densities_stale);
  }
}

void SmokeVolume::update_phase(SmokeSource& source, std::uint32_t tick) {
  const sim::Cloud& cloud = *source.cloud;
  const sim::CloudPhase phase = cloud.phase(tick);
  // All of a phase only rises: what is the same at the end of the hold stays so until then.
  const sim::CloudOrigin& origin = cloud.origin();
  const std::uint32_t held_until =
      origin.detonation_tick + origin.settings.bloom_ticks + origin.settings.hold_ticks;
  const bool steady = tick < held_until && cloud.phase(held_until) == phase;
  source.steady = steady ? TickSpan{tick, held_until} : TickSpan{};

  const bool first = source.densities.empty();
  if (!first && phase == source.phase) return;
  source.phase = phase;
  densities_of(cloud, phase, scratch_);
  std::swap(source.densities, scratch_);
  const std::span<const sim::VoxelBlock> blocks = cloud.voxels().blocks();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const std::uint32_t rank = blocks[i].first;
    const auto count = static_cast<std::size_t>(std::popcount(blocks[i].mask));
    if (first || std::memcmp(source.densities.data() + rank, scratch_.data() + rank, count) != 0)
      mark(source.slot_of_block[i], &SmokeBrick::densities_stale);
  }
}

void SmokeVolume::refresh() {
  // More slots are touched on the way; those have no densities of their own to refresh.
  for (std::size_t i = 0; i < touched_.size(); ++i)
    if (slots_[touched_[i]]->densities_stale) refresh_densities(touched_[i]);
  for (std::size_t i = 0; i < touched_.size(); ++i) {
    SmokeBrick& brick = *slots_[touched_[i]];
    if (brick.changed != BrickBits{}) spread_changes(brick);
  }
  for (const std::uint32_t slot : touched_) {
    SmokeBrick& brick = *slots_[slot];
    if (brick.fresh) fill_texels(brick);
    if (brick.home && brick.stale_cells != BrickBits{}) evaluate_cells(brick);
  }
}

void SmokeVolume::refresh_densities(std::uint32_t slot) {
  SmokeBrick& brick = *slots_[slot];
  BrickDensities densities{};
  for (const CloudPart& part : brick.clouds) add_cloud_part(part, densities);
  for (const BlastPart& part : brick.blasts) apply_blast_part(part, densities);
  std::uint8_t* held = densities_.data() + std::size_t{slot} * kVoxelsPerBrick;
  for (std::size_t z = 0; z < 8; ++z) {
    std::uint64_t changed = 0;
    if (std::memcmp(held + 64 * z, densities.data() + 64 * z, 64) != 0)
      for (std::size_t i = 0; i < 64; ++i)
        changed |= std::uint64_t{held[64 * z + i] != densities[64 * z + i]} << i;
    brick.changed[z] = changed;
  }
  std::memcpy(held, densities.data(), kVoxelsPerBrick);
}

/// Takes changed densities over into the texels of this brick and of the aprons around it, and marks the
/// boundary cells that they matter to.
void SmokeVolume::spread_changes(SmokeBrick& brick) {
  const std::array<std::uint32_t, 27> slots = slots_around(brick.at);
  const std::uint8_t* densities = densities_.data() + std::size_t{slots[13]} * kVoxelsPerBrick;
  for (int i = 0; i < 27; ++i) {
    if (slots[static_cast<std::size_t>(i)] == kNoSlot) continue;
    SmokeBrick& into = *slots_[slots[static_cast<std::size_t>(i)]];
    if (into.fresh) continue;
    const glm::ivec3 step = glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    // The voxels that lie in the other brick's apron.
    std::uint64_t layer = ~std::uint64_t{0};
    if (step.x != 0) layer &= step.x < 0 ? kColumn0 : kColumn0 << 7;
    if (step.y != 0) layer &= step.y < 0 ? std::uint64_t{0xff} : std::uint64_t{0xff} << 56;
    const std::size_t first_z = step.z > 0 ? 7 : 0, last_z = step.z < 0 ? 0 : 7;
    const int shift =
        -8 * (step.x + 10 * (step.y + 10 * step.z));  // from texels of this brick to the other's
    bool any = false;
    for (std::size_t z = first_z; z <= last_z; ++z)
      for (std::uint64_t left = brick.changed[z] & layer; left != 0; left &= left - 1) {
        const std::size_t voxel = 64 * z + static_cast<std::size_t>(std::countr_zero(left));
        into.texels[static_cast<std::size_t>(kTexelOfVoxel[voxel] + shift)].density = densities[voxel];
        any = true;
      }
    if (any) mark(slots[static_cast<std::size_t>(i)], &SmokeBrick::texels_changed);
  }

  std::array<BrickBits, 27> cells{};
  for (int z = 0; z < 8; ++z) {
    const std::uint64_t changed = brick.changed[static_cast<std::size_t>(z)];
    if (changed == 0) continue;
    const auto by_x = spread_x(changed);
    for (std::size_t x = 0; x < 3; ++x) {
      const auto by_y = spread_y(by_x[x]);
      for (std::size_t y = 0; y < 3; ++y)
        for (int to = z - 2; to <= z + 1; ++to)
          cells[x + 3 * y + 9 * static_cast<std::size_t>((to >> 3) + 1)][static_cast<std::size_t>(to & 7)] |=
              by_y[y];
    }
  }
  for (std::size_t i = 0; i < 27; ++i) {
    if (slots[i] == kNoSlot || !slots_[slots[i]]->home || cells[i] == BrickBits{}) continue;
    SmokeBrick& into = *slots_[slots[i]];
    for (std::size_t z = 0; z < 8; ++z) into.stale_cells[z] |= cells[i][z];
    if (!into.touched) {
      into.touched = true;
      touched_.push_back(slots[i]);
    }
  }
}

/// All texels of a new brick.
void SmokeVolume::fill_texels(SmokeBrick& brick) {
  const std::array<std::uint32_t, 27> slots = slots_around(brick.at);
  std::size_t texel = 0;
  for (int z = -1; z < 9; ++z)
    for (int y = -1; y < 9; ++y)
      for (int x = -1; x < 9; ++x, ++texel) {
        const glm::ivec3 local(x, y, z), b = (local >> 3) + 1;
        const std::uint32_t slot = slots[static_cast<std::size_t>(b.x + 3 * b.y + 9 * b.z)];
        brick.texels[texel].density =
            slot == kNoSlot ? std::uint8_t{0}
                            : densities_[std::size_t{slot} * kVoxelsPerBrick + local_voxel(local)];
      }
}

/// Numbers of those things whose cell is stale. Written without a branch: which are is not to be foreseen.
template <typename Thing>
std::span<const std::uint32_t> SmokeVolume::stale_of(const std::vector<Thing>& things,
                                                     const BrickBits& stale) {
  if (stale_numbers_.size() < things.size()) stale_numbers_.resize(things.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < things.size(); ++i) {
    const unsigned cell = things[i].cell;
    stale_numbers_[count] = static_cast<std::uint32_t>(i);
    count += stale[cell >> 6] >> (cell & 63) & 1;
  }
  return std::span(stale_numbers_).first(count);
}

/// Means and corner sets of the stale cells.
void SmokeVolume::evaluate_cells(SmokeBrick& brick) {
  BrickCells& home = *brick.home;
  const std::uint8_t* densities = densities_.data();
  for (const std::uint32_t i : stale_of(home.means, brick.stale_cells)) {
    const SmokeMean& mean = home.means[i];
    const std::uint32_t* voxels = home.mean_voxels.data() + mean.first;
    const std::uint8_t* weights = home.mean_weights.data() + mean.first;
    std::uint32_t sum = mean.total / 2u;
    for (std::uint32_t k = 0; k < mean.count; ++k) sum += std::uint32_t{weights[k]} * densities[voxels[k]];
    home.mean_values[i + 1] = static_cast<std::uint8_t>(sum / mean.total);
  }

  const std::array<const std::uint8_t*, 2> values{densities, home.mean_values.data()};
  std::uint32_t low = home.set_range.count, high = 0;
  for (const std::uint32_t i : stale_of(home.sources, brick.stale_cells)) {
    const CornerSource& source = home.sources[i];
    const auto value = [&](std::size_t corner) -> std::uint32_t {
      const std::uint32_t from = source.corners[corner];
      return values[from / kMeanBit][from & ~kMeanBit];
    };
    const glm::uvec2 packed(value(0) | value(1) << 8 | value(2) << 16 | value(3) << 24,
                            value(4) | value(5) << 8 | value(6) << 16 | value(7) << 24);
    for (unsigned sides = source.sides; sides != 0; sides &= sides - 1) {
      const std::uint32_t set = source.first_set + static_cast<std::uint32_t>(std::countr_zero(sides));
      glm::uvec2& held = corner_sets_[home.set_range.first + set];
      if (held == packed) continue;
      held = packed;
      low = std::min(low, set);
      high = std::max(high, set + 1);
    }
  }
  if (low < high) brick.sets_changed = {low, high - low};
}

void SmokeVolume::report_changes() {
  dirty_slots_.clear();
  dirty_cell_slots_.clear();
  dirty_boundary_cells_.clear();
  dirty_corner_sets_.clear();
  std::sort(touched_.begin(), touched_.end());
  for (const std::uint32_t slot : touched_) {
    SmokeBrick& brick = *slots_[slot];
    if (brick.texels_changed || brick.fresh) dirty_slots_.push_back(slot);
    if (brick.cells_changed || brick.fresh) dirty_cell_slots_.push_back(slot);
    if (brick.home && brick.home_changed) {
      dirty_boundary_cells_.push_back(brick.home->cell_range);
      dirty_corner_sets_.push_back(brick.home->set_range);
    } else if (brick.home && brick.sets_changed.count > 0) {
      dirty_corner_sets_.push_back(
          {brick.home->set_range.first + brick.sets_changed.first, brick.sets_changed.count});
    }
    brick.touched = brick.fresh = brick.masks_stale = brick.walls_stale = brick.cells_stale = false;
    brick.densities_stale = brick.texels_changed = brick.cells_changed = brick.home_changed = false;
    brick.sets_changed = {};
    brick.changed = brick.stale_cells = {};
  }
  touched_.clear();
  sort_and_merge(dirty_boundary_cells_);
  sort_and_merge(dirty_corner_sets_);
  if (structure_changed_) ++generation_;
  structure_changed_ = false;
}

float sample_density(const SmokeVolume& volume, glm::vec3 position_voxel) {
  const glm::ivec3 brick(glm::floor(position_voxel / 8.0f));
  const std::uint32_t slot = volume.slot_at(brick);
  if (slot == SmokeVolume::kNoSlot) return 0;

  // Trilinear density and share of free corners.
  const glm::ivec3 cell(glm::floor(position_voxel - 0.5f));
  const glm::vec3 f = position_voxel - 0.5f - glm::vec3(cell);
  const glm::ivec3 in_brick = cell - 8 * brick + 1;
  const std::span<const Texel> texels = volume.texels(slot);
  glm::uvec2 densities(0), frees(0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 t = in_brick + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const Texel texel = texels[static_cast<std::size_t>(t.x + 10 * (t.y + 10 * t.z))];
    densities[corner >> 2] |= std::uint32_t{texel.density} << (8 * (corner & 3));
    frees[corner >> 2] |= std::uint32_t{texel.free} << (8 * (corner & 3));
  }
  const float plain = shared::corner_set_density(densities, f);
  if (shared::corner_set_density(frees, f) >= 1.0f - 1.0f / 512.0f) return plain;

  // A solid corner: the set for the point's side of the surface.
  const std::uint32_t entry =
      volume.cells(slot)[static_cast<std::size_t>(in_brick.x + 9 * (in_brick.y + 9 * in_brick.z))];
  if (entry == 0) return 0;  // no smoke near
  const shared::BoundaryCell& boundary = volume.boundary_cells()[entry - 1];
  const std::uint32_t side = shared::boundary_side(boundary, f - 0.5f);
  return shared::corner_set_density(volume.corner_sets()[boundary.first_set + side], f);
}

}  // namespace brume::smoke
