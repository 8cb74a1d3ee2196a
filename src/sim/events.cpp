#include "sim/events.hpp"

#include <algorithm>
#include <bit>
#include <string>

namespace brume::sim {
namespace {

bool in_world(Position p) {
  const auto within = [](int c) { return c >= -kMaxCoordinate && c <= kMaxCoordinate; };
  return within(p.x) && within(p.y) && within(p.z);
}

/// Formats failures of one event: its kind, its tick and the expectation.
class Check {
 public:
  Check(const char* name, std::uint32_t tick)
      : event_(std::string(name) + " at tick " + std::to_string(tick)) {}

  Failure expected(const std::string& what) const {
    return {ErrorCode::bad_input, event_ + ": expected " + what};
  }
  Result<void> number(const char* name, std::uint64_t value, std::uint64_t low, std::uint64_t high) const {
    if (value >= low && value <= high) return {};
    return expected(std::string(name) + " from " + std::to_string(low) + " to " + std::to_string(high) +
                    ", not " + std::to_string(value));
  }
  Result<void> position(const char* name, Position p) const {
    if (in_world(p)) return {};
    return expected(std::string(name) + " within 16384 m of the world's origin");
  }

 private:
  std::string event_;
};

/// The first of several checks that failed.
template <typename... Results>
Result<void> all_of(Results... results) {
  Result<void> first;
  (void)((results ? true : (first = results, false)) && ...);
  return first;
}

Result<void> check(const ThrowSmoke& e, const voxel::GridLayout&) {
  const Check check("smoke", e.tick);
  return all_of(check.number("a tick", e.tick, 0, kMaxTick), check.position("`from`", e.from),
                check.position("`at`", e.at), check.number("voxels", e.smoke.voxels, 1, kMaxFillVoxels),
                check.number("bloom ticks", e.smoke.bloom_ticks, 1, kMaxTick),
                check.number("hold ticks", e.smoke.hold_ticks, 0, kMaxTick),
                check.number("dissolve ticks", e.smoke.dissolve_ticks, 1, kMaxTick));
}

Result<void> check(const Shot& e, const voxel::GridLayout&) {
  const Check check("shot", e.tick);
  if (e.origin == e.toward) return check.expected("`toward` to differ from the muzzle");
  if (e.shape > HoleShape::mask) return check.expected("a cylinder, a box or a mask");
  if (e.shape != HoleShape::mask && e.mask != 0) return check.expected("no mask unless the shape is a mask");
  return all_of(check.number("a tick", e.tick, 0, kMaxTick), check.position("the muzzle", e.origin),
                check.position("`toward`", e.toward), check.number("a radius", e.radius, 1, kMaxCoordinate),
                check.number("a roll", e.roll, 0, kFullTurn - 1),
                check.number("a mask", e.mask, 0, kMaxMasks - 1),
                check.number("milliseconds", e.timing.reach_far, 0, kMaxMilliseconds),
                check.number("milliseconds", e.timing.expand, 0, kMaxMilliseconds),
                check.number("milliseconds", e.timing.stay_open, 0, kMaxMilliseconds),
                check.number("milliseconds", e.timing.fade, 0, kMaxMilliseconds));
}

Result<void> check(const Blast& e, const voxel::GridLayout& layout) {
  const Check check("blast", e.tick);
  const auto max_radius =
      static_cast<std::uint64_t>(static_cast<double>(layout.voxel_size) * kMaxBlastVoxels * kUnitsPerMetre);
  return all_of(check.number("a tick", e.tick, 0, kMaxTick), check.position("`at`", e.at),
                check.number("a radius", e.radius, 1, max_radius),
                check.number("a speed", e.speed, kUnitsPerMetre, 1u << 24),
                check.number("a remaining fraction", e.remaining, 0, 255),
                check.number("milliseconds to refill the rim", e.refill_rim_ms, 1, kMaxMilliseconds),
                check.number("milliseconds to refill the middle", e.refill_middle_ms, e.refill_rim_ms,
                             kMaxMilliseconds));
}

Result<void> check(const MoveBody& e, const voxel::GridLayout&) {
  const Check check("move", e.tick);
  return all_of(check.number("a tick", e.tick, 0, kMaxTick), check.position("`to`", e.to));
}

Result<void> check(const LevelEdit& e, const voxel::GridLayout& layout) {
  const Check check("edit", e.tick);
  const glm::ivec3 blocks = (layout.size + kBlockSize - 1) / kBlockSize;
  for (std::size_t i = 0; i < e.blocks.size(); ++i) {
    const EditBlock& block = e.blocks[i];
    const glm::ivec3 at(block.at);
    if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, blocks)))
      return check.expected("blocks within the grid");
    if (i > 0 && !block_before(e.blocks[i - 1].at, block.at))
      return check.expected("blocks sorted by z, y, x, each once");
    const int bits = std::popcount(block.make_solid) + std::popcount(block.make_free) +
                     std::popcount(block.make_glass) + std::popcount(block.make_grille);
    if (block.all() == 0 || bits != std::popcount(block.all()))
      return check.expected("at least one change per block, and no voxel both solid and free");
  }
  return check.number("a tick", e.tick, 0, kMaxTick);
}

}  // namespace

Result<void> check_event(const Event& event, const voxel::GridLayout& layout) {
  return std::visit([&](const auto& e) { return check(e, layout); }, event);
}

}  // namespace brume::sim
