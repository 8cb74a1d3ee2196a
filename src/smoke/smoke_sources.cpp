#include "smoke/smoke_sources.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

namespace brume::smoke {
namespace {

/// The bricks that a block's voxels are in or within two voxels of.
void add_bricks_around(const sim::VoxelBlock& block, std::vector<glm::ivec3>& bricks) {
  constexpr std::array<std::uint64_t, 3> kLowHalf{0x3333333333333333u, 0x00ff00ff00ff00ffu, 0xffffffffu};
  const glm::ivec3 at(block.at);
  for (int direction = 0; direction < 8; ++direction) {
    std::uint64_t mask = block.mask;
    glm::ivec3 brick = at >> 1;
    for (int axis = 0; axis < 3; ++axis) {
      if ((direction >> axis & 1) == 0) continue;
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

/// Which blocks of a set lie in a brick; all kNoBlock when there is none.
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

/// Goes through what is held and what is live, both by id: `keep` decides whether a held one stays, `make`
/// makes a new one. `held` is then what is live.
template <typename Held, typename Live, typename Keep, typename Make>
SmokeSources::Exchange<Held> exchange(std::vector<std::unique_ptr<Held>>& held, const std::vector<Live>& live,
                                      Keep keep, Make make) {
  SmokeSources::Exchange<Held> result;
  std::vector<std::unique_ptr<Held>> next;
  next.reserve(live.size());
  std::size_t i = 0;
  for (const Live& one : live) {
    while (i < held.size() && held[i]->id < one.id) result.removed.push_back(std::move(held[i++]));
    if (i < held.size() && held[i]->id == one.id) {
      if (keep(*held[i], one)) {
        next.push_back(std::move(held[i++]));
        continue;
      }
      result.removed.push_back(std::move(held[i++]));
    }
    next.push_back(make(one));
    result.added.push_back(next.back().get());
  }
  while (i < held.size()) result.removed.push_back(std::move(held[i++]));
  held = std::move(next);
  return result;
}

/// Whether only the reach decides the densities at a phase.
bool only_reach_counts(const sim::Cloud& cloud, const sim::CloudPhase& phase) {
  const sim::CloudParts& parts = cloud.parts();
  return parts.flow_tick == 0 && parts.detached.empty() && phase.dissolved == 0;
}

/// The densities of a whole cloud by rank.
void densities_of_cloud(const sim::Cloud& cloud, const sim::CloudPhase& phase,
                        std::vector<std::uint8_t>& out) {
  out.resize(cloud.voxels().size());
  if (!only_reach_counts(cloud, phase)) {
    for (std::uint32_t rank = 0; rank < out.size(); ++rank) out[rank] = cloud.density(rank, phase);
    return;
  }
  // Only the reach counts: 0 from the front on, full from the taper inwards; between them a table.
  const auto end = static_cast<std::uint32_t>(
      std::min<sim::Front>(phase.front / sim::kFrontUnit + 1, sim::Cloud::kNoDistance));
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

std::vector<ReachSpan> reaches_of(const sim::Cloud& cloud) {
  std::vector<ReachSpan> spans;
  for (const sim::VoxelBlock& block : cloud.voxels().blocks()) {
    ReachSpan span{cloud.reach(block.first), cloud.reach(block.first)};
    const auto count = static_cast<std::uint32_t>(std::popcount(block.mask));
    for (std::uint32_t rank = block.first + 1; rank < block.first + count; ++rank) {
      span.nearest = std::min(span.nearest, cloud.reach(rank));
      span.farthest = std::max(span.farthest, cloud.reach(rank));
    }
    spans.push_back(span);
  }
  return spans;
}

/// Where densities are constant behind and beyond a front: full below one reach, 0 from another one on.
struct FrontEnds {
  sim::Front full, none;
  explicit FrontEnds(sim::Front front)
      : full(front < sim::Cloud::taper(front) ? 0 : (front - sim::Cloud::taper(front)) / sim::kFrontUnit + 1),
        none((front + sim::kFrontUnit - 1) / sim::kFrontUnit) {}
};

/// The densities of a brick, block after block.
using BlockDensities = std::array<std::array<std::uint8_t, 64>, 8>;

std::uint8_t limited_sum(std::uint8_t a, std::uint8_t b) {
  const auto sum = static_cast<std::uint8_t>(a + b);
  return static_cast<std::uint8_t>(sum | -(sum < a));
}

void add_cloud_part(const CloudPart& part, BlockDensities& sums) {
  const std::span<const std::uint8_t> densities = part.source->densities();
  for (std::size_t i = 0; i < 8; ++i) {
    if (part.blocks[i] == kNoBlock) continue;
    const sim::VoxelBlock& block = part.source->cloud->voxels().blocks()[part.blocks[i]];
    const std::uint8_t* density = densities.data() + block.first;
    std::array<std::uint8_t, 64>& sum = sums[i];
    if (~block.mask == 0) {
      for (std::size_t k = 0; k < 64; ++k) sum[k] = limited_sum(sum[k], density[k]);
      continue;
    }
    for (std::uint64_t bits = block.mask; bits != 0; bits &= bits - 1) {
      std::uint8_t& here = sum[static_cast<std::size_t>(std::countr_zero(bits))];
      here = limited_sum(here, *density++);
    }
  }
}

void apply_sink_part(const SinkPart& part, BlockDensities& densities) {
  const sim::BlastField& field = *part.sink->field;
  for (std::size_t i = 0; i < 8; ++i) {
    if (part.blocks[i] == kNoBlock) continue;
    const sim::VoxelBlock& block = field.reached().blocks()[part.blocks[i]];
    const std::uint8_t* reach = field.reach().data() + block.first;
    for (std::uint64_t bits = block.mask; bits != 0; bits &= bits - 1) {
      std::uint8_t& here = densities[i][static_cast<std::size_t>(std::countr_zero(bits))];
      here = sim::scaled_density(here, part.sink->profile.remaining[*reach++]);
    }
  }
}

/// The same, row after row of the brick.
BrickDensities by_rows(const BlockDensities& blocks) {
  BrickDensities densities;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t row = 0; row < 16; ++row) {
      const std::size_t to =
          4 * (i & 1) + 32 * (i >> 1 & 1) + 256 * (i >> 2) + 8 * (row & 3) + 64 * (row >> 2);
      std::memcpy(densities.data() + to, blocks[i].data() + 4 * row, 4);
    }
  return densities;
}

}  // namespace

BrickBlocks no_blocks() {
  BrickBlocks blocks;
  blocks.fill(kNoBlock);
  return blocks;
}

BrickBits voxels_of(std::span<const CloudPart> clouds) {
  BrickBits bits{};
  for (const CloudPart& part : clouds)
    for (std::size_t i = 0; i < 8; ++i)
      if (part.blocks[i] != kNoBlock)
        set_block(bits, i, part.source->cloud->voxels().blocks()[part.blocks[i]].mask);
  return bits;
}

BrickDensities densities_of(std::span<const CloudPart> clouds, std::span<const SinkPart> sinks) {
  BlockDensities densities{};
  for (const CloudPart& part : clouds) add_cloud_part(part, densities);
  for (const SinkPart& part : sinks) apply_sink_part(part, densities);
  return by_rows(densities);
}

void add_sink_part(glm::ivec3 brick, const SmokeSink& sink, std::vector<SinkPart>& parts) {
  if (!reaches(sink.field->reached(), brick)) return;
  const SinkPart part{&sink, blocks_in(sink.field->reached(), brick)};
  if (part.blocks == no_blocks()) return;
  const auto after = std::find_if(parts.begin(), parts.end(),
                                  [&](const SinkPart& other) { return other.sink->id > sink.id; });
  parts.insert(after, part);
}

std::vector<glm::ivec3> bricks_around(const sim::Cloud& cloud) {
  std::vector<glm::ivec3> bricks;
  for (const sim::VoxelBlock& block : cloud.voxels().blocks()) add_bricks_around(block, bricks);
  sort_unique(bricks);
  return bricks;
}

SmokeSources::Exchange<SmokeSource> SmokeSources::take_clouds(const sim::State& state) {
  const auto same = [](const sim::LiveCloud& a, const sim::LiveCloud& b) {
    return a.id == b.id && a.cloud == b.cloud;
  };
  if (std::equal(live_clouds_.begin(), live_clouds_.end(), state.clouds.begin(), state.clouds.end(), same))
    return {};
  live_clouds_ = state.clouds;
  auto result = exchange(
      clouds_, state.clouds,
      [](SmokeSource& held, const sim::LiveCloud& live) {
        if (held.cloud != live.cloud && held.cloud->hash() != live.cloud->hash()) return false;
        held.cloud = live.cloud;
        return true;
      },
      [](const sim::LiveCloud& live) {
        auto source = std::make_unique<SmokeSource>();
        source->id = live.id;
        source->cloud = live.cloud;
        source->reach_of_block = reaches_of(*live.cloud);
        return source;
      });
  steady_.clear();
  for (const auto& source : clouds_) steady_.push_back(source->steady);
  return result;
}

SmokeSources::Exchange<SmokeSink> SmokeSources::take_sinks(const sim::State& state) {
  const auto same = [](const std::unique_ptr<SmokeSink>& held, const sim::LiveBlast& live) {
    return held->id == live.id && held->field == live.field;
  };
  if (std::equal(sinks_.begin(), sinks_.end(), state.blasts.begin(), state.blasts.end(), same)) return {};
  return exchange(
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
        return sink;
      });
}

std::span<const std::uint8_t> SmokeSource::densities() const {
  if (densities_at_ != phase) {
    densities_of_cloud(*cloud, *phase, densities_);
    densities_at_ = phase;
  }
  return densities_;
}

void SmokeSources::advance_to(std::uint32_t tick, std::vector<const SmokeSource*>& moved,
                              std::vector<std::uint32_t>& slots, std::vector<glm::ivec3>& bricks) {
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    if (tick >= steady_[i].first && tick <= steady_[i].last) continue;
    if (advance_cloud(*clouds_[i], tick, slots)) moved.push_back(clouds_[i].get());
    steady_[i] = clouds_[i]->steady;
  }
  for (const auto& sink : sinks_) {
    const sim::BlastProfile profile = sink->field->profile(tick);
    if (profile == sink->profile) continue;
    sink->profile = profile;
    bricks.insert(bricks.end(), sink->bricks.begin(), sink->bricks.end());
  }
}

/// Returns whether the cloud has another phase.
bool SmokeSources::advance_cloud(SmokeSource& source, std::uint32_t tick, std::vector<std::uint32_t>& slots) {
  // How long the phase stays. A phase only rises: if it is the same at the end of the hold, it stays so.
  const sim::Cloud& cloud = *source.cloud;
  const sim::CloudPhase phase = cloud.phase(tick);
  const sim::CloudOrigin& origin = cloud.origin();
  const std::uint32_t hold_end =
      origin.detonation_tick + origin.settings.bloom_ticks + origin.settings.hold_ticks;
  const bool steady = tick < hold_end && cloud.phase(hold_end) == phase;
  source.steady = steady ? TickSpan{tick, hold_end} : TickSpan{};
  if (source.phase == phase) return false;

  // Blocks behind both tapers, or beyond both fronts, stay as they are.
  const std::optional<sim::CloudPhase> before = std::exchange(source.phase, phase);
  const bool by_reach = before && only_reach_counts(cloud, *before) && only_reach_counts(cloud, phase);
  const FrontEnds was(by_reach ? before->front : 0), is(phase.front);
  for (std::size_t i = 0; i < source.slot_of_block.size(); ++i) {
    const ReachSpan reach = source.reach_of_block[i];
    const bool constant =
        reach.farthest < std::min(was.full, is.full) || reach.nearest >= std::max(was.none, is.none);
    if (!by_reach || !constant) slots.push_back(source.slot_of_block[i]);
  }
  return true;
}

std::uint64_t SmokeSources::bytes() const {
  std::uint64_t sum = 0;
  for (const auto& source : clouds_)
    sum += sizeof(SmokeSource) + source->densities_.capacity() +
           source->reach_of_block.capacity() * sizeof(ReachSpan) +
           4 * (source->slot_of_block.capacity() + source->slots.capacity());
  return sum;
}

}  // namespace brume::smoke
