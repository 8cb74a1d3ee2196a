#include "sim/world.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "core/progress.hpp"
#include "core/tasks.hpp"
#include "sim/event_fields.hpp"

namespace brume::sim {
namespace {

constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
/// Surfaces may show smoke this many voxels beyond those a cloud fills.
constexpr int kSmokeMargin = 2;
/// Minimum ticks between two checkpoints, and maximum number of checkpoints.
constexpr std::uint32_t kCheckpointTicks = 64;
constexpr std::size_t kMaxCheckpoints = 256;
/// From this many voxels on, a cloud is so slow to make that it is worth a checkpoint.
constexpr std::uint32_t kLargeCloud = 1u << 18;
/// From this many events on, advancing reports its progress.
constexpr std::uint64_t kEventsOfLongJob = 256;

/// Whether a large cloud was made in the tick of a state.
bool made_large_cloud(const State& state) {
  return std::any_of(state.clouds.begin(), state.clouds.end(), [&](const LiveCloud& live) {
    return live.cloud->origin().detonation_tick == state.tick && live.cloud->voxels().size() >= kLargeCloud;
  });
}

bool inside(glm::ivec3 v, glm::ivec3 low, glm::ivec3 high) {
  return glm::all(glm::greaterThanEqual(v, low)) && glm::all(glm::lessThanEqual(v, high));
}

// The tick at which an item of a state ends: a grenade detonates, a hole has fully closed.
std::uint32_t end_of(const Flight& flight, std::uint32_t) {
  return flight.detonation_tick;
}
std::uint32_t end_of(const LiveCloud& live, std::uint32_t) {
  return live.cloud->end_tick();
}
template <typename Field>
std::uint32_t end_of(const Live<Field>& live, std::uint32_t) {
  return live.field->end_tick();
}
std::uint32_t end_of(const Body&, std::uint32_t) {
  return kNever;
}
std::uint32_t end_of(const BulletHole& hole, std::uint32_t ticks_per_second) {
  const HoleTimingMs& t = hole.shot.timing;
  const std::uint64_t life = std::uint64_t{t.reach_far} + t.expand + t.stay_open + t.fade;
  const std::uint64_t ticks = (life * ticks_per_second + 999) / 1000;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(hole.shot.tick + ticks, kNever - 1));
}

Result<void> check_mask(const Event& event, const MaskKey& masks) {
  const auto* shot = std::get_if<Shot>(&event);
  if (!shot || shot->shape != HoleShape::mask || shot->mask < masks.count) return {};
  return Failure{ErrorCode::bad_input, "shot at tick " + std::to_string(shot->tick) + ": mask " +
                                           std::to_string(shot->mask) + " in a world with " +
                                           std::to_string(masks.count) + "; set WorldSettings::masks"};
}

/// Inserts an element into a list sorted by id.
template <typename T>
void insert_by_id(std::vector<T>& list, T element) {
  const auto place = std::upper_bound(list.begin(), list.end(), element.id,
                                      [](std::uint32_t id, const T& other) { return id < other.id; });
  list.insert(place, std::move(element));
}

/// Whether items of a state are the fields that events of a kind leave.
template <typename Kind, typename Item>
constexpr bool kHoldsFieldsOf = false;
template <typename Kind, typename Field>
constexpr bool kHoldsFieldsOf<Kind, Live<Field>> =
    std::is_same_v<decltype(std::declval<const Field&>().event()), const Kind&>;
template <typename Kind>
constexpr int count_field_lists() {
  int count = 0;
  for_each_state_list(
      [&]<typename Item>(const char*, std::vector<Item> State::*) { count += kHoldsFieldsOf<Kind, Item>; });
  return count;
}

}  // namespace

std::uint32_t next_end(const State& state) {
  std::uint32_t next = kNever;
  for_each_state_list([&](const char*, auto list) {
    for (const auto& item : state.*list) next = std::min(next, end_of(item, state.ticks_per_second));
  });
  for (const LiveCloud& live : state.clouds)
    if (const auto settle = live.cloud->settle_tick()) next = std::min(next, *settle);
  return next;
}

void remove_ended(State& state) {
  const std::uint32_t tick = state.tick;
  for_each_state_list([&]<typename Item>(const char*, std::vector<Item> State::*list) {
    if constexpr (!std::is_same_v<Item, Flight>)
      std::erase_if(state.*list,
                    [&](const auto& item) { return end_of(item, state.ticks_per_second) <= tick; });
  });
  for (LiveCloud& live : state.clouds)
    if (const auto settle = live.cloud->settle_tick(); settle && *settle <= tick)
      live.cloud = std::make_shared<const Cloud>(live.cloud->settled());
}

World::World(const voxel::Solids& level, const WorldSettings& settings)
    : level_(level), settings_(settings), ruler_(level.smoke.layout()) {
  if (settings.ticks_per_second < 1 || settings.ticks_per_second > 1000)
    throw Error(ErrorCode::bad_input,
                std::to_string(settings.ticks_per_second) + " ticks per second: expected 1 to 1000");
  state_.layout = level.smoke.layout();
  state_.ticks_per_second = settings.ticks_per_second;
  state_.masks = settings.masks;
  state_.level_hash = settings.level_hash;
  first_ = state_;
  next_end_ = kNever;
}

Result<void> World::append(Event event) {
  std::vector<Event> events;
  events.push_back(std::move(event));
  return append(std::move(events));
}

Result<void> World::append(std::vector<Event> events) {
  std::uint32_t first = kNever;
  for (const Event& event : events) first = std::min(first, tick_of(event));
  if (auto ok = check(events, first, settings_.masks); !ok) return ok;
  replace_log(first, log_.size(), std::move(events));
  return {};
}

Result<void> World::replace_from(std::uint32_t tick, std::vector<Event> events, const MaskKey& masks) {
  for (const Event& event : events)
    if (tick_of(event) < tick)
      return Failure{ErrorCode::bad_input, "event at tick " + std::to_string(tick_of(event)) +
                                               ": expected tick " + std::to_string(tick) + " or later"};
  if (auto ok = check(events, tick, masks); !ok) return ok;
  const auto from = std::lower_bound(log_.begin(), log_.end(), tick,
                                     [](const Event& e, std::uint32_t t) { return tick_of(e) < t; });
  if (masks != settings_.masks) {
    for (auto event = log_.begin(); event != from; ++event)
      if (auto ok = check_mask(*event, masks); !ok) return ok;
    set_masks(masks);
  }
  replace_log(tick, static_cast<std::size_t>(from - log_.begin()), std::move(events));
  return {};
}

/// States refer to masks by index only, so their keys can change in place.
void World::set_masks(const MaskKey& masks) {
  settings_.masks = state_.masks = first_.masks = masks;
  if (previous_) previous_->masks = masks;
  for (State& checkpoint : checkpoints_) checkpoint.masks = masks;
}

/// Whether `events` may be in the log. `first`: the first tick whose events change.
Result<void> World::check(std::span<const Event> events, std::uint32_t first, const MaskKey& masks) const {
  for (const Event& event : events) {
    if (auto ok = check_event(event, grid().layout()); !ok) return ok;
    if (auto ok = check_mask(event, masks); !ok) return ok;
  }
  if (first >= first_open_tick_) return {};
  return Failure{ErrorCode::bad_input, "event at tick " + std::to_string(first) + ": expected tick " +
                                           std::to_string(first_open_tick_) +
                                           " or later; earlier history was dropped"};
}

/// Replaces the log after its first `retained` events by `events`, all at or after tick `first`, and replays.
void World::replace_log(std::uint32_t first, std::size_t retained, std::vector<Event> events) {
  const std::uint32_t present = state_.tick;
  // Clouds of the ticks to replay are kept meanwhile, so that they need not be made again.
  std::vector<State> abandoned;
  if (first <= present) abandoned.push_back(state_);
  const auto kept = std::ranges::lower_bound(checkpoints_, first, {}, &State::tick);
  std::move(kept, checkpoints_.end(), std::back_inserter(abandoned));
  checkpoints_.erase(kept, checkpoints_.end());
  if (first <= present) go_back_before(first);
  const auto by_tick = [](const Event& a, const Event& b) { return tick_of(a) < tick_of(b); };
  const auto middle = static_cast<std::ptrdiff_t>(retained);
  log_.erase(log_.begin() + middle, log_.end());
  std::move(events.begin(), events.end(), std::back_inserter(log_));
  std::stable_sort(log_.begin() + middle, log_.end(), by_tick);
  std::inplace_merge(log_.begin(), log_.begin() + middle, log_.end(), by_tick);
  if (first <= present) advance_to(present);
}

void World::advance_to(std::uint32_t tick) {
  tick = std::max(tick, earliest_tick_);
  if (tick < state_.tick) go_back_before(tick + 1);
  go_forward_to(tick);
  const std::uint64_t events = events_until(tick);
  std::optional<Progress> job;
  if (events >= kEventsOfLongJob) job.emplace("simulate", events);
  for (;;) {
    const std::uint32_t event_tick = next_event_ < log_.size() ? tick_of(log_[next_event_]) : kNever;
    const std::uint32_t due = std::min(event_tick, next_end_);
    if (due > tick || due == kNever) break;
    const std::size_t before = next_event_;
    play_tick(due);
    if (job) job->advance(next_event_ - before);
  }
  state_.tick = tick;
}

/// The number of events in the log up to a tick that are not in state_ yet.
std::uint64_t World::events_until(std::uint32_t tick) const {
  const auto next = log_.begin() + static_cast<std::ptrdiff_t>(next_event_);
  const auto end = std::upper_bound(next, log_.end(), tick,
                                    [](std::uint32_t t, const Event& e) { return t < tick_of(e); });
  return static_cast<std::uint64_t>(end - next);
}

/// Skips to the last checkpoint at or before a tick, if it is later than state_, instead of simulating again.
void World::go_forward_to(std::uint32_t tick) {
  const auto after = std::upper_bound(checkpoints_.begin(), checkpoints_.end(), tick,
                                      [](std::uint32_t t, const State& state) { return t < state.tick; });
  if (after == checkpoints_.begin() || std::prev(after)->tick <= state_.tick) return;
  adopt(*std::prev(after), false);
}

/// Rolls back to the last retained state before a tick; keeps the present one where nothing has changed
/// since.
void World::go_back_before(std::uint32_t tick) {
  if (tick > changed_at_) {
    state_.tick = std::min(state_.tick, tick - 1);
    return;
  }

  // The latest of the previous state, the checkpoints and the first state.
  const auto after = std::lower_bound(checkpoints_.begin(), checkpoints_.end(), tick,
                                      [](const State& state, std::uint32_t t) { return state.tick < t; });
  const bool has_checkpoint = after != checkpoints_.begin();
  const bool is_previous =
      previous_ && previous_->tick < tick && (!has_checkpoint || std::prev(after)->tick < previous_->tick);
  const bool is_first = !has_checkpoint && !is_previous;
  adopt(is_previous ? *previous_ : is_first ? first_ : *std::prev(after), is_first);
}

/// Makes a retained state the present one.
void World::adopt(State target, bool is_first) {
  previous_.reset();
  level_.replace(target.edits);
  state_ = std::move(target);
  changed_at_ = state_.tick;

  // The next event to play. Events already in first_ are no longer in the log.
  next_event_ = 0;
  if (!is_first) next_event_ = static_cast<std::size_t>(events_until(state_.tick));
  next_end_ = next_end(state_);
}

Result<void> World::restore(const State& state) {
  if (auto reason = foreign_reason(state, state_, "this world"))
    return Failure{ErrorCode::bad_input, std::move(*reason)};
  if (next_end(state) <= state.tick)
    return Failure{ErrorCode::bad_input, "state: contains something that ended before its tick"};
  if (state.edits)
    if (auto ok = check_event(LevelEdit{0, *state.edits}, grid().layout()); !ok) return ok;

  // The state takes the place of all history before it.
  std::erase_if(log_, [&](const Event& event) { return tick_of(event) <= state.tick; });
  checkpoints_.clear();
  made_.clear();
  previous_.reset();
  level_.replace(state.edits);
  state_ = first_ = state;
  earliest_tick_ = state.tick;
  first_open_tick_ = state.tick + 1;
  changed_at_ = state.tick;
  next_event_ = 0;
  next_end_ = next_end(state_);
  return {};
}

void World::forget_before(std::uint32_t tick) {
  first_open_tick_ = std::max(first_open_tick_, tick);
  earliest_tick_ = std::max(earliest_tick_, std::min(tick, state_.tick));

  // The last checkpoint before `tick`, from which its events are applied, becomes the first state.
  const auto after =
      std::lower_bound(checkpoints_.begin(), checkpoints_.end(), std::min(tick, state_.tick + 1),
                       [](const State& state, std::uint32_t t) { return state.tick < t; });
  if (after == checkpoints_.begin()) return;
  first_ = *std::prev(after);
  checkpoints_.erase(checkpoints_.begin(), after);
  made_.forget_until(first_.tick);
  if (previous_ && previous_->tick < first_.tick) previous_.reset();

  // Its state includes the events up to its tick.
  const auto past = std::upper_bound(log_.begin(), log_.end(), first_.tick,
                                     [](std::uint32_t t, const Event& e) { return t < tick_of(e); });
  next_event_ -= static_cast<std::size_t>(past - log_.begin());
  log_.erase(log_.begin(), past);
}

template <>
void World::apply(const ThrowSmoke& event) {
  const auto landing = landing_voxel(solids().bodies, ruler_, event.from, event.at);
  if (!landing) return;
  const std::uint64_t units = ceil_distance(event.from, ruler_.centre(*landing));
  const std::uint64_t speed = std::uint64_t{kGrenadeMetresPerSecond} * kUnitsPerMetre;
  const auto ticks = static_cast<std::uint32_t>((units * settings_.ticks_per_second + speed - 1) / speed);
  state_.flights.push_back(
      {state_.events, event.from, *landing, event.tick, event.tick + ticks, event.smoke});
}

/// Turns the grenades that arrive at this tick into clouds.
void World::detonate() {
  std::vector<Flight> due;
  std::erase_if(state_.flights, [&](const Flight& flight) {
    if (flight.detonation_tick > state_.tick) return false;
    due.push_back(flight);
    return true;
  });
  std::vector<CloudRecipe> recipes(due.size());
  std::vector<std::shared_ptr<const Cloud>> clouds(due.size());
  parallel_for(due.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // The landing voxel may have become solid since the throw.
      const glm::ivec3 source = nearest_free_voxel(grid(), due[i].landing).value_or(due[i].landing);
      recipes[i] = {{source, due[i].smoke, due[i].detonation_tick}, nullptr, state_.tick, state_.edits};
      clouds[i] = made_.find(recipes[i]);
      if (!clouds[i]) clouds[i] = std::make_shared<const Cloud>(grid(), recipes[i].origin);
    }
  });
  for (std::size_t i = 0; i < due.size(); ++i) {
    made_.add(recipes[i], clouds[i]);
    if (!clouds[i]->voxels().empty()) insert_by_id(state_.clouds, LiveCloud{due[i].id, clouds[i]});
  }
}

/// Lets the clouds flow that an edit of the level touches.
void World::flow(std::uint32_t tick, const EditBlocks& of_smoke) {
  std::vector<std::shared_ptr<const Cloud>> flowed(state_.clouds.size());
  const auto recipe_of = [&](std::size_t i) {
    const std::shared_ptr<const Cloud>& cloud = state_.clouds[i].cloud;
    return CloudRecipe{cloud->origin(), cloud, tick, state_.edits};
  };
  parallel_for(state_.clouds.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::shared_ptr<const Cloud>& cloud = state_.clouds[i].cloud;
      if (!cloud->touched_by(of_smoke)) continue;
      flowed[i] = made_.find(recipe_of(i));
      if (!flowed[i]) flowed[i] = std::make_shared<const Cloud>(cloud->flowed(grid(), tick));
    }
  });
  for (std::size_t i = 0; i < flowed.size(); ++i) {
    if (!flowed[i]) continue;
    made_.add(recipe_of(i), flowed[i]);
    state_.clouds[i].cloud = std::move(flowed[i]);
  }
}

/// Depth of a shot's hole, 1/1024 m: up to where the shot leaves the last smoke, but no farther than halfway
/// through the first solid voxel after the first free one, which contains the wall. 0: it meets no smoke.
std::uint64_t World::hole_distance(const Shot& shot) const {
  // The voxels on the path, up to the wall.
  std::vector<WalkStep> path;
  glm::ivec3 low(voxel::kMaxAxis), high(-1);
  bool was_free = false;
  walk_ray(grid(), ruler_, shot.origin, shot.toward, [&](const WalkStep& step) {
    path.push_back(step);
    low = glm::min(low, step.voxel);
    high = glm::max(high, step.voxel);
    const bool solid = grid().solid(step.voxel);
    was_free |= !solid;
    return !was_free || !solid;
  });

  // The clouds whose bounds the path may cross.
  std::vector<const Cloud*> nearby;
  for (const LiveCloud& live : state_.clouds)
    if (glm::all(glm::lessThanEqual(low, live.cloud->high() + kSmokeMargin)) &&
        glm::all(glm::greaterThanEqual(high, live.cloud->low() - kSmokeMargin)))
      nearby.push_back(live.cloud.get());

  // The farthest exit from a voxel in smoke.
  const auto length = static_cast<__int128>(ceil_distance(shot.origin, shot.toward));
  const auto distance_at = [&](Fraction fraction) { return length * fraction.num / fraction.den; };
  __int128 far = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool in_smoke = std::any_of(nearby.begin(), nearby.end(), [&](const Cloud* cloud) {
      return inside(path[i].voxel, cloud->low() - kSmokeMargin, cloud->high() + kSmokeMargin);
    });
    if (!in_smoke) continue;
    far = distance_at(path[i].exit);
    const bool ends_in_wall = i + 1 == path.size() && i > 0 && grid().solid(path[i].voxel);
    if (ends_in_wall) far = (distance_at(path[i - 1].exit) + far) / 2;
  }
  return static_cast<std::uint64_t>(far);
}

template <>
void World::apply(const Shot& event) {
  BulletHole hole{state_.events, event, hole_distance(event)};
  if (hole.distance > 0) state_.holes.push_back(std::move(hole));
}

template <>
void World::apply(const MoveBody& event) {
  auto place = std::lower_bound(state_.bodies.begin(), state_.bodies.end(), event.body,
                                [](const Body& b, std::uint32_t body) { return b.body < body; });
  if (place == state_.bodies.end() || place->body != event.body)
    state_.bodies.insert(place, Body{event.body, event.to, event.to, event.tick, event.tick});
  else
    *place = {event.body, event.to, place->position, event.tick, place->tick};
}

template <>
void World::apply(const LevelEdit& event) {
  const EditBlocks changes = effective_edits(solids(), event.blocks);
  if (changes.empty()) return;
  // The changes that matter to smoke: a pane stops it already, so one that becomes a wall is none of them.
  EditBlocks of_smoke;
  for (const EditBlock& change : changes) of_smoke.push_back(change.of_smoke());
  of_smoke = effective_edits(grid(), of_smoke);
  level_.add(changes);
  state_.edits = level_.edits();
  flow(event.tick, of_smoke);
}

/// Adds the field that an event leaves to its list, unless it reaches nothing.
template <typename Kind>
void World::apply(const Kind& event) {
  static_assert(count_field_lists<Kind>() == 1, "neither an `apply` of its own nor a list of Live fields");
  for_each_state_list([&]<typename Item>(const char*, std::vector<Item> State::*list) {
    if constexpr (kHoldsFieldsOf<Kind, Item>) {
      using Field = typename decltype(Item::field)::element_type;
      auto field = std::make_shared<Field>(grid(), event, settings_.ticks_per_second);
      if (!field->reached().empty()) (state_.*list).push_back({state_.events, std::move(field)});
    }
  });
}

void World::play_tick(std::uint32_t tick) {
  // Events, detonations, ends.
  previous_ = state_;
  state_.tick = changed_at_ = tick;
  for (; next_event_ < log_.size() && tick_of(log_[next_event_]) == tick; ++next_event_) {
    std::visit([&](const auto& event) { apply(event); }, log_[next_event_]);
    ++state_.events;
  }
  detonate();
  remove_ended(state_);
  next_end_ = next_end(state_);

  // A checkpoint: kCheckpointTicks or more after the last one, or when a large cloud was made.
  const std::uint32_t last = checkpoints_.empty() ? 0 : checkpoints_.back().tick;
  const bool is_due = checkpoints_.empty() || tick >= last + kCheckpointTicks;
  const bool is_costly = tick > last && made_large_cloud(state_);
  if (!is_due && !is_costly) return;
  checkpoints_.push_back(state_);
  if (checkpoints_.size() <= kMaxCheckpoints) return;

  // When there are too many, drop every second one of the older half.
  std::size_t retained = 0;
  for (std::size_t i = 0; i < checkpoints_.size(); ++i)
    if (i >= kMaxCheckpoints / 2 || i % 2 == 0) checkpoints_[retained++] = std::move(checkpoints_[i]);
  checkpoints_.resize(retained);
}

}  // namespace brume::sim
