#include "sim/event_fields.hpp"

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

/// Checks the fields of an event, and keeps the first failure.
struct FieldCheck {
  const Check& check;
  const voxel::GridLayout& layout;
  Result<void> outcome = {};

  void operator()(const PositionField& field, const Position& position) {
    if (outcome) outcome = check.position(field.about, position);
  }
  void operator()(const NumberField& field, std::uint32_t number) {
    if (outcome) outcome = check.number(field.about, number, field.low, high(field));
  }
  void operator()(const ChoiceField&, const auto&) {}  // check_rules has it
  std::uint64_t high(const NumberField& field) const {
    if (!field.in_voxels) return field.high;
    const double metres = static_cast<double>(layout.voxel_size) * static_cast<double>(field.high);
    return static_cast<std::uint64_t>(metres * kUnitsPerMetre);
  }
};

/// What is no range of a field.
Result<void> check_rules(const Check& check, const Shot& e, const voxel::GridLayout&) {
  if (e.origin == e.toward) return check.expected("`toward` to differ from the muzzle");
  if (e.shape > HoleShape::mask) return check.expected("a cylinder, a box or a mask");
  if (e.shape != HoleShape::mask && e.mask != 0) return check.expected("no mask unless the shape is a mask");
  return {};
}

Result<void> check_rules(const Check& check, const LevelEdit& e, const voxel::GridLayout& layout) {
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
  return {};
}

template <typename Other>
Result<void> check_rules(const Check&, const Other&, const voxel::GridLayout&) {
  return {};
}

template <typename Kind>
Result<void> check(const Kind& event, const voxel::GridLayout& layout) {
  const Check check(name_of(event), event.tick);
  if (auto outcome = check_rules(check, event, layout); !outcome) return outcome;
  if (auto outcome = check.number("a tick", event.tick, 0, kMaxTick); !outcome) return outcome;
  FieldCheck fields{check, layout};
  visit_fields(event, fields);
  return fields.outcome;
}

}  // namespace

Result<void> check_event(const Event& event, const voxel::GridLayout& layout) {
  return std::visit([&](const auto& e) { return check(e, layout); }, event);
}

}  // namespace brume::sim
