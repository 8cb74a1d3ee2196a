#include "wire/state_coding.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "wire/archive.hpp"
#include "wire/cloud_coding.hpp"

namespace brume::wire {
namespace {

using sim::Body;
using sim::BulletHole;
using sim::EditBlocks;
using sim::Flight;
using sim::Live;
using sim::LiveCloud;
using sim::State;

template <typename Item>
std::uint32_t key_of(const Item& item) {
  return item.id;
}
std::uint32_t key_of(const Body& body) {
  return body.body;
}

template <typename Item>
bool same(const Item& a, const Item& b) {
  return a == b;
}
bool same(const LiveCloud& a, const LiveCloud& b) {
  return a.cloud == b.cloud || a.cloud->hash() == b.cloud->hash();
}
template <typename Made>
bool same(const Live<Made>& a, const Live<Made>& b) {
  return a.field == b.field || a.field->hash() == b.field->hash();
}

template <typename F>
void serialize_fields(F& archive, Flight& flight) {
  archive.field(Field::throw_tick, flight.throw_tick);
  archive.field(Field::detonation_tick, flight.detonation_tick);
  serialize_position(archive, Field::from, flight.from);
  serialize_position(archive, Field::voxel, flight.landing);
  serialize(archive, flight.smoke);
}

template <typename F>
void serialize_fields(F& archive, BulletHole& hole) {
  serialize_event(archive, hole.shot);
  archive.field(Field::distance, hole.distance);
}

template <typename F>
void serialize_fields(F& archive, Body& body) {
  serialize_position(archive, Field::body_at, body.position);
  serialize_position(archive, Field::body_was, body.previous);
  archive.field(Field::body_tick, body.tick);
  archive.field(Field::body_tick_before, body.previous_tick);
}

// Codes one State as the difference from another.
template <typename Coder>
class StateCoder {
 public:
  static constexpr bool kReads = Coder::kReads;

  StateCoder(Archive<Coder>& archive, const State& base, State& now)
      : archive_(archive), base_(base), now_(now) {}

  void code() {
    archive_.context.at(Field::events) = archive_.context.at(Field::id) = base_.events;
    archive_.field(Field::events, now_.events);
    // Unchanged items are not validated again: they stem from earlier events.
    if (now_.events < base_.events) archive_.fail("fewer events than in the base state");
    code_edits();
    sim::for_each_state_list([&](const char*, auto list) { code_list(base_.*list, now_.*list); });
  }

 private:
  // Codes only the bits that differ: an edit present in both states costs nothing.
  void code_edits() {
    EditBlocks before, after, changed;
    if (base_.edits) before = folded(*base_.edits);
    if constexpr (!kReads)
      if (base_.edits != now_.edits) {
        if (now_.edits) after = folded(*now_.edits);
        changed = flipped(before, after);
      }
    if (!archive_.flag(Flag::edits, !changed.empty())) {
      if constexpr (kReads) now_.edits = base_.edits;
      return;
    }
    serialize_solid_and_free(archive_, changed);
    if constexpr (kReads) after = flipped(before, changed);
    if (has_roles(before) || has_roles(after)) serialize_grilles(archive_, changed);
    if constexpr (kReads) {
      auto edits = unfolded(flipped(before, changed));
      if (!edits) archive_.fail("an edit makes a voxel a grille and something else");
      now_.edits = !edits || edits->empty() ? nullptr : std::make_shared<const EditBlocks>(std::move(*edits));
    }
  }

  // For each item of the base: whether it remains and whether it changed. Then the new items.
  template <typename Item>
  void code_list(const std::vector<Item>& base, std::vector<Item>& now) {
    // One flag for an unchanged list.
    bool differs = false;
    if constexpr (!kReads)
      differs = base.size() != now.size() ||
                !std::equal(base.begin(), base.end(), now.begin(), [](const Item& a, const Item& b) {
                  return key_of(a) == key_of(b) && same(a, b);
                });
    if (!archive_.flag(Flag::list, differs)) {
      if constexpr (kReads) now = base;
      return;
    }

    // The items of the base.
    std::vector<Item> retained, added;
    auto next = now.begin();
    for (const Item& before : base) {
      if (!archive_.ok()) return;
      Item after = before;
      bool remains = false;
      if constexpr (!kReads) {
        for (; next != now.end() && key_of(*next) < key_of(before); ++next) added.push_back(*next);
        remains = next != now.end() && key_of(*next) == key_of(before);
        if (remains) after = *next++;
      }
      if (!archive_.flag(Flag::retained, remains)) continue;
      if (archive_.flag(Flag::replaced, !same(before, after))) code_item(&before, after);
      if constexpr (kReads) retained.push_back(std::move(after));
    }

    // The new items.
    if constexpr (!kReads) added.insert(added.end(), next, now.end());
    code_added(added);
    if constexpr (kReads) merge_items(std::move(retained), std::move(added), now);
  }

  template <typename Item>
  void code_added(std::vector<Item>& added) {
    const std::uint64_t count = archive_.count(added.size());
    for (std::uint64_t i = 0; i < count && archive_.ok(); ++i) {
      Item item{};
      if constexpr (!kReads) item = added[i];
      std::uint32_t key = key_of(item);
      archive_.field(std::is_same_v<Item, Body> ? Field::body : Field::id, key);
      set_key(item, key);
      code_item(static_cast<const Item*>(nullptr), item);
      if constexpr (kReads)
        if (archive_.ok()) added.push_back(std::move(item));
    }
  }

  template <typename Item>
  void merge_items(std::vector<Item> retained, std::vector<Item> added, std::vector<Item>& now) {
    if (!archive_.ok()) return;
    const auto before = [](const Item& a, const Item& b) { return key_of(a) < key_of(b); };
    now.clear();
    std::merge(std::make_move_iterator(retained.begin()), std::make_move_iterator(retained.end()),
               std::make_move_iterator(added.begin()), std::make_move_iterator(added.end()),
               std::back_inserter(now), before);
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (i > 0 && !before(now[i - 1], now[i])) archive_.fail("ids are out of order");
      if (!std::is_same_v<Item, Body> && key_of(now[i]) >= now_.events)
        archive_.fail("an id belongs to a future event");
    }
  }

  template <typename Item>
  static void set_key(Item& item, std::uint32_t key) {
    item.id = key;
  }
  static void set_key(Body& body, std::uint32_t key) { body.body = key; }

  template <typename Item>
  void code_item(const Item* before, Item& item) {
    if (before) {
      Item expected = *before;
      serialize_fields(archive_.context, expected);
    }
    serialize_fields(archive_, item);
    if constexpr (kReads) check(item);
  }

  // A moving body's previous position is its position in the base state: it costs nothing.
  void code_item(const Body* before, Body& body) {
    if (before) {
      Body expected = *before;
      expected.previous = before->position;
      expected.previous_tick = before->tick;
      expected.tick = now_.tick;
      serialize_fields(archive_.context, expected);
    }
    serialize_fields(archive_, body);
    if constexpr (kReads) check(body);
  }

  void code_item(const LiveCloud* before, LiveCloud& live) {
    if (before && archive_.flag(Flag::settled, is_settled(*before, live))) {
      if constexpr (kReads) live.cloud = std::make_shared<const sim::Cloud>(before->cloud->settled());
      return;
    }
    // Its grenade predicts most of it.
    const auto flight = std::find_if(base_.flights.begin(), base_.flights.end(),
                                     [&](const Flight& f) { return f.id == live.id; });
    if (flight != base_.flights.end()) {
      Flight expected = *flight;
      serialize_fields(archive_.context, expected);
    }
    if (before) {
      sim::CloudOrigin expected = before->cloud->origin();
      serialize(archive_.context, expected);
    }
    sim::CloudParts parts;
    if constexpr (!kReads) parts = live.cloud->parts();
    code_cloud(archive_, before ? before->cloud.get() : nullptr, now_.tick, parts);
    if constexpr (kReads) {
      if (!archive_.ok()) return;
      auto cloud = sim::Cloud::from_parts(std::move(parts));
      if (cloud)
        live.cloud = std::make_shared<const sim::Cloud>(std::move(*cloud));
      else
        archive_.fail(cloud.failure().message);
    }
  }

  static bool is_settled(const LiveCloud& before, const LiveCloud& now) {
    if constexpr (kReads) return false;
    return before.cloud->settle_tick() && !now.cloud->settle_tick() &&
           before.cloud->settled().hash() == now.cloud->hash();
  }

  template <typename Made>
  void code_item(const Live<Made>* before, Live<Made>& live) {
    // The event and the centre, validated before they are used.
    using Event = std::remove_cvref_t<decltype(live.field->event())>;
    Event event;
    sim::Position centre{0};
    sim::BlockSet reached;
    if constexpr (!kReads) {
      event = live.field->event();
      centre = live.field->centre();
      reached = live.field->reached();
    }
    if (before) {
      Event expected = before->field->event();
      serialize_event(archive_.context, expected);
    }
    serialize_event(archive_, event);
    serialize_position(archive_, Field::centre, centre);
    if (!archive_.ok()) return;
    const sim::VoxelRuler ruler(archive_.layout());
    if constexpr (kReads) {
      check_event(event);
      check_begun(event.tick);
      check_event(sim::MoveBody{0, 0, centre});
      if (!archive_.ok()) return;
    }

    // The voxels it reached.
    archive_.set(glm::ivec3(ruler.subvoxel(centre) >> std::int64_t{10}), {}, reached);
    if constexpr (kReads) {
      if (!archive_.ok()) return;
      auto field =
          Made::from_parts(archive_.layout(), event, centre, std::move(reached), now_.ticks_per_second);
      if (field)
        live.field = std::make_shared<const Made>(std::move(*field));
      else
        archive_.fail(field.failure().message);
    }
  }

  void check_event(const sim::Event& event) {
    const Result<void> checked = sim::check_event(event, archive_.layout());
    if (!checked) archive_.fail(checked.failure().message);
  }
  void check_inside(glm::ivec3 voxel, const char* message) {
    if (glm::any(glm::lessThan(voxel, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(voxel, archive_.layout().size)))
      archive_.fail(message);
  }
  void check_begun(std::uint32_t tick) {
    if (tick > now_.tick) archive_.fail("an item exists before its first tick");
  }
  void check(const Flight& flight) {
    check_event(sim::ThrowSmoke{flight.throw_tick, flight.from, flight.from, flight.smoke});
    check_inside(flight.landing, "a grenade lands outside of the grid");
    check_begun(flight.throw_tick);
    if (flight.detonation_tick <= flight.throw_tick || flight.detonation_tick > 2 * sim::kMaxTick)
      archive_.fail("a grenade detonates before it is thrown, or never");
  }
  void check(const BulletHole& hole) {
    check_event(hole.shot);
    check_begun(hole.shot.tick);
    if (hole.shot.shape == sim::HoleShape::mask && hole.shot.mask >= now_.masks.count)
      archive_.fail("a hole's mask does not exist");
    if (hole.distance == 0 || hole.distance > kMaxDistance) archive_.fail("a hole's depth is out of range");
  }
  void check(const Body& body) {
    check_event(sim::MoveBody{body.tick, body.body, body.position});
    check_event(sim::MoveBody{body.previous_tick, body.body, body.previous});
    check_begun(body.tick);
    if (body.previous_tick > body.tick) archive_.fail("a body's last move precedes the one before");
  }

  // Longer than any path through the world.
  static constexpr std::uint64_t kMaxDistance = std::uint64_t{8} * sim::kMaxCoordinate;

  Archive<Coder>& archive_;
  const State& base_;
  State& now_;
};

}  // namespace

// An Archive is large, so it lives on the heap.
std::vector<std::byte> write_body(const sim::State& base, const sim::State& now) {
  Encoder coder;
  const auto archive = std::make_unique<Archive<Encoder>>(coder, now.layout, now.tick, Limits{});
  sim::State copy = now;
  StateCoder<Encoder>(*archive, base, copy).code();
  return coder.finish();
}

Result<sim::State> read_body(std::span<const std::byte> body, const sim::State& base, std::uint32_t tick,
                             const Limits& limits) {
  sim::State now;
  now.layout = base.layout;
  now.ticks_per_second = base.ticks_per_second;
  now.masks = base.masks;
  now.level_hash = base.level_hash;
  now.tick = tick;
  Decoder coder(body);
  const auto archive = std::make_unique<Archive<Decoder>>(coder, now.layout, now.tick, limits);
  StateCoder<Decoder>(*archive, base, now).code();
  if (!archive->reason().empty()) return Failure{ErrorCode::bad_input, archive->reason()};
  if (!coder.at_end())
    return Failure{ErrorCode::bad_input, "the bytes are truncated, too many, or out of range"};
  return now;
}

}  // namespace brume::wire
