#include "sim/state.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/hash.hpp"

namespace brume::sim {
namespace {

/// Gathers the numbers of a state for its hash.
class Words {
 public:
  template <typename... Numbers>
  void add(Numbers... numbers) {
    (words_.push_back(static_cast<std::uint64_t>(std::int64_t{numbers})), ...);
  }
  void add(std::uint64_t number) { words_.push_back(number); }
  void add(glm::ivec3 v) { add(v.x, v.y, v.z); }
  void add(float number) { words_.push_back(hash_values(std::span<const float>(&number, 1))); }
  void add(const SmokeSettings& s) { add(s.voxels, s.bloom_ticks, s.hold_ticks, s.dissolve_ticks); }
  std::uint64_t hash() const { return hash_values(std::span<const std::uint64_t>(words_)); }

 private:
  std::vector<std::uint64_t> words_;
};

void add_item(Words& words, const Flight& f, std::uint32_t) {
  words.add(f.id, f.throw_tick, f.detonation_tick);
  words.add(f.from);
  words.add(f.landing);
  words.add(f.smoke);
}

void add_item(Words& words, const LiveCloud& live, std::uint32_t tick) {
  const CloudPhase phase = live.cloud->phase(tick);
  words.add(live.id, phase.dissolved, phase.flowed);
  words.add(live.cloud->hash());
  words.add(phase.front);
}

template <typename Field>
void add_item(Words& words, const Live<Field>& live, std::uint32_t) {
  words.add(live.id);
  words.add(live.field->hash());
}

void add_item(Words& words, const BulletHole& hole, std::uint32_t) {
  const Shot& s = hole.shot;
  words.add(hole.id, s.tick, s.radius);
  words.add(s.origin);
  words.add(s.toward);
  words.add(s.timing.reach_far, s.timing.expand, s.timing.stay_open, s.timing.fade);
  words.add(static_cast<std::uint32_t>(s.shape), s.mask, s.roll);
  words.add(hole.distance);
}

void add_item(Words& words, const Body& b, std::uint32_t) {
  words.add(b.body, b.tick, b.previous_tick);
  words.add(b.position);
  words.add(b.previous);
}

}  // namespace

std::uint8_t State::density(glm::ivec3 voxel) const {
  unsigned sum = 0;
  for (const LiveCloud& live : clouds) {
    const std::uint32_t rank = live.cloud->voxels().rank(voxel);
    if (rank != BlockSet::kNone) sum += live.cloud->density(rank, live.cloud->phase(tick));
  }
  auto density = static_cast<std::uint8_t>(std::min(sum, 255u));
  if (density == 0) return density;
  for (const LiveBlast& live : blasts)
    if (live.field->reached().contains(voxel))
      density = scaled_density(density, live.field->remaining(voxel, live.field->profile(tick)));
  return density;
}

std::uint64_t State::hash() const {
  // Layout, clock and masks.
  Words words;
  words.add(layout.size);
  words.add(layout.voxel_size);
  for (int axis = 0; axis < 3; ++axis) words.add(layout.origin_world[axis]);
  words.add(ticks_per_second, tick, events, masks.count);
  words.add(masks.hash);

  // Level edits.
  words.add(std::uint64_t{edits ? edits->size() : 0});
  if (edits)
    for (const EditBlock& edit : *edits) {
      words.add(edit.at.x, edit.at.y, edit.at.z);
      words.add(edit.make_solid);
      words.add(edit.make_free);
    }

  // What the lists hold.
  for_each_state_list([&](const char*, auto list) {
    const auto& items = this->*list;
    words.add(std::uint64_t{items.size()});
    for (const auto& item : items) add_item(words, item, tick);
  });

  // Edits of other roles than wall: nothing without them.
  if (edits)
    for (const EditBlock& edit : *edits) {
      if (!edit.has_roles()) continue;
      words.add(edit.at.x, edit.at.y, edit.at.z);
      words.add(edit.make_glass);
      words.add(edit.make_grille);
    }
  // The level, where its hash is known.
  if (level_hash != 0) words.add(level_hash);
  return words.hash();
}

std::optional<std::string> foreign_reason(const State& state, const State& own, const std::string& owner) {
  const std::string start = "the state is of ";
  if (state.layout != own.layout)
    return start + "a level with another layout than " + owner + "'s; load the same level";
  if (state.level_hash != own.level_hash)
    return start + "another level than " + owner + "'s; load the same triangles or voxels, in the same order";
  if (state.ticks_per_second != own.ticks_per_second)
    return start + "a world with " + std::to_string(state.ticks_per_second) + " ticks per second, but " +
           owner + " has " + std::to_string(own.ticks_per_second);
  if (state.masks != own.masks) return start + "a world with other masks than " + owner + "'s; load the same";
  return std::nullopt;
}

std::vector<Grenade> grenades_of(const State& state) {
  std::vector<Grenade> flying;
  const VoxelRuler ruler(state.layout);
  for (const Flight& f : state.flights) {
    const double fraction =
        static_cast<double>(state.tick - f.throw_tick) / (f.detonation_tick - f.throw_tick);
    const glm::dvec3 from = metres_from_position(f.from), to = metres_from_position(ruler.centre(f.landing));
    flying.push_back({glm::vec3(from + (to - from) * fraction), state.seconds(state.tick - f.throw_tick)});
  }
  return flying;
}

}  // namespace brume::sim
