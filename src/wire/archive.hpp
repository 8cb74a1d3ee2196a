// Serialization for the wire: one `serialize` function per struct lists its fields, and the coder behind the
// archive writes or reads them. A number is coded as its difference from the last one of its kind.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "sim/event_fields.hpp"
#include "sim/events.hpp"
#include "sim/state.hpp"
#include "wire/block_coding.hpp"
#include "wire/limits.hpp"
#include "wire/range_coder.hpp"

namespace brume::wire {

/// Kinds of numbers. Positions have three consecutive kinds, named by x.
enum class Field : std::uint8_t {
  events,
  id,
  from,
  voxel = from + 3,
  toward = voxel + 3,
  body_at = toward + 3,
  body_was = body_at + 3,
  centre = body_was + 3,
  throw_tick = centre + 3,
  detonation_tick,
  flow_tick,
  body_tick,
  body_tick_before,
  kind,
  voxels,
  bloom,
  hold,
  dissolve,
  distance,
  body,
  count
};

/// Kinds of the numbers of events behind them: by the event's place in sim::Event, then by its tick and the
/// numbers and choices of sim/event_fields.hpp.
constexpr std::size_t kMostEventNumbers = 16;
constexpr std::size_t kFields =
    static_cast<std::size_t>(Field::count) + std::variant_size_v<sim::Event> * kMostEventNumbers;

/// Kinds of yes-or-no decisions.
enum class Flag : std::uint8_t { list, retained, replaced, settled, flows, edits, count };

/// The last number of each kind, which predicts the next one.
class DeltaContext {
 public:
  /// Predicts ticks near `tick` and settings near their defaults.
  explicit DeltaContext(std::uint32_t tick);

  std::int64_t& at(Field field) { return last_[static_cast<std::size_t>(field)]; }

  // `serialize` called with a DeltaContext sets its predictions to the values of an object.
  template <typename Value>
  void field(Field field, Value& value) {
    at(field) = static_cast<std::int64_t>(value);
  }

 private:
  std::array<std::int64_t, kFields> last_{};
};

template <typename Coder>
class Archive {
 public:
  static constexpr bool kReads = Coder::kReads;

  Archive(Coder& coder, const voxel::GridLayout& layout, std::uint32_t tick, const Limits& limits)
      : context(tick),
        coder_(coder),
        layout_(layout),
        limits_(limits),
        voxels_remaining_(limits.max_voxels) {}

  DeltaContext context;

  const voxel::GridLayout& layout() const { return layout_; }
  bool ok() const { return coder_.ok(); }
  /// Why reading failed; empty when the bytes are merely malformed.
  const std::string& reason() const { return reason_; }
  void fail(std::string reason) {
    if constexpr (kReads) {
      if (coder_.ok()) reason_ = std::move(reason);
      coder_.fail();
    }
  }

  /// An integer of at most 64 bits.
  template <typename Value>
  void field(Field field, Value& value) {
    std::int64_t& last = context.at(field);
    const auto now = static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
    const std::uint64_t code =
        coder_.number(numbers_[static_cast<std::size_t>(field)],
                      folded(static_cast<std::int64_t>(now - static_cast<std::uint64_t>(last))));
    if constexpr (kReads) {
      if (!ok()) return;
      const std::uint64_t read =
          static_cast<std::uint64_t>(last) + static_cast<std::uint64_t>(unfolded(code));
      value = static_cast<Value>(read);
      if (static_cast<std::uint64_t>(static_cast<std::int64_t>(value)) != read) coder_.fail();
    }
    last = static_cast<std::int64_t>(value);
  }

  bool flag(Flag flag, bool value) { return coder_.bit(flags_[static_cast<std::size_t>(flag)], value); }

  /// The length of a list, at most Limits::max_items.
  std::uint64_t count(std::uint64_t count) {
    const std::uint64_t coded = coder_.number(counts_, count);
    if constexpr (kReads) {
      if (coded > limits_.max_items) coder_.fail();
    }
    return ok() ? coded : 0;
  }

  /// The voxels of an item of the state: all must lie in the grid.
  void set(glm::ivec3 near_voxel, const Prediction& like, sim::BlockSet& set) {
    std::vector<sim::VoxelBlock> coded =
        blocks({set.blocks().begin(), set.blocks().end()}, near_voxel, like, false);
    if constexpr (kReads) set = sim::BlockSet::from_blocks(std::move(coded));
  }
  /// The blocks of an edit: their voxels may lie outside the grid.
  std::vector<sim::VoxelBlock> edit_blocks(std::vector<sim::VoxelBlock> list) {
    return blocks(std::move(list), glm::ivec3(0), {}, true);
  }

  /// Per-voxel lists (block_coding.hpp); lists of one kind share their models.
  void densities(std::size_t kind, const sim::BlockSet& set, std::span<const std::uint8_t> expected,
                 std::vector<std::uint8_t>& list) {
    code_densities(coder_, density_models_[kind], set, expected, list);
  }
  void delays(std::size_t kind, std::span<const std::uint32_t> order, std::span<const std::uint8_t> group,
              std::vector<std::uint16_t>& list) {
    code_delays(coder_, delay_models_[kind], order, group, list);
  }

 private:
  std::vector<sim::VoxelBlock> blocks(std::vector<sim::VoxelBlock> list, glm::ivec3 near_voxel,
                                      const Prediction& like, bool whole) {
    if constexpr (kReads) list.clear();
    code_blocks(coder_, block_models_, {layout_.size, whole, voxels_remaining_}, near_voxel >> 2, like, list);
    if constexpr (kReads)
      for (const sim::VoxelBlock& block : list) voxels_remaining_ -= cost_of(block);
    return list;
  }

  Coder& coder_;
  const voxel::GridLayout& layout_;
  Limits limits_;
  std::uint64_t voxels_remaining_;
  std::string reason_;
  std::array<NumberModel, kFields> numbers_;
  std::array<BitModel, static_cast<std::size_t>(Flag::count)> flags_;
  NumberModel counts_;
  BlockModels block_models_;
  std::array<DensityModels, 3> density_models_;
  std::array<DelayModels, 2> delay_models_;
};

template <typename F>
void serialize_position(F& archive, Field x, glm::ivec3& position) {
  for (int axis = 0; axis < 3; ++axis)
    archive.field(static_cast<Field>(static_cast<int>(x) + axis), position[axis]);
}

template <typename F>
void serialize(F& archive, sim::SmokeSettings& smoke) {
  archive.field(Field::voxels, smoke.voxels);
  archive.field(Field::bloom, smoke.bloom_ticks);
  archive.field(Field::hold, smoke.hold_ticks);
  archive.field(Field::dissolve, smoke.dissolve_ticks);
}

/// Codes the fields of an event: the visitor of sim/event_fields.hpp.
template <typename F, typename Event>
class EventCoder {
 public:
  explicit EventCoder(F& archive) : archive_(archive) {}

  void operator()(const sim::PositionField& field, sim::Position& position) {
    // What an event goes towards is the second one.
    const std::string_view key = field.key;
    serialize_position(archive_,
                       is_second_      ? Field::toward
                       : key == "from" ? Field::from
                       : key == "to"   ? Field::body_at
                                       : Field::centre,
                       position);
    is_second_ = true;
  }
  void operator()(const sim::NumberField&, std::uint32_t& number) { add(number); }
  void operator()(const sim::ChoiceField&, auto& choice) { add(choice); }
  void add(auto& number) {
    const std::size_t first = sim::Event(Event{}).index() * kMostEventNumbers;
    BRUME_ASSERT(count_ < kMostEventNumbers, "an event with more numbers than kinds");
    archive_.field(static_cast<Field>(static_cast<std::size_t>(Field::count) + first + count_++), number);
  }

 private:
  F& archive_;
  std::size_t count_ = 0;
  bool is_second_ = false;
};

/// The tick and the fields of an event, as sim/event_fields.hpp lists them.
template <typename F, typename Event>
void serialize_event(F& archive, Event& event) {
  EventCoder<F, Event> coder(archive);
  coder.add(event.tick);
  sim::visit_fields(event, coder);
}

// Edits are coded as lists of blocks: the voxels that they make solid, those that they make free, and where a
// voxel is in both, because it becomes glass or a grille, the grilles. So edits of walls alone take no more.

/// Lists as they are coded: make_solid and make_free have the voxels of glass and of grilles, too, make_glass
/// none.
sim::EditBlocks folded(const sim::EditBlocks& edits);
/// The reverse. Nothing where a grille is not among the voxels of both lists.
std::optional<sim::EditBlocks> unfolded(const sim::EditBlocks& folded);
/// The bits in exactly one of the two; flipping again restores the original.
sim::EditBlocks flipped(const sim::EditBlocks& a, const sim::EditBlocks& b);
/// Whether the list of grilles is coded.
bool has_roles(const sim::EditBlocks& folded);

/// The first two lists of folded edits; decoded blocks are sorted.
template <typename Coder>
void serialize_solid_and_free(Archive<Coder>& archive, sim::EditBlocks& folded);
/// The third, which is added to the first two.
template <typename Coder>
void serialize_grilles(Archive<Coder>& archive, sim::EditBlocks& folded);

/// All lists of an edit.
template <typename Coder>
void serialize(Archive<Coder>& archive, sim::EditBlocks& edits);

}  // namespace brume::wire
