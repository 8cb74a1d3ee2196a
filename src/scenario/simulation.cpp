#include "scenario/simulation.hpp"

#include <algorithm>
#include <iterator>
#include <map>

#include "sim/level_edit.hpp"

namespace brume::scenario {
namespace {

std::vector<EventOrder> orders_of(std::span<const OrderedEvent> events) {
  std::vector<EventOrder> orders;
  orders.reserve(events.size());
  for (const OrderedEvent& event : events) orders.push_back(event.order);
  return orders;
}

}  // namespace

Simulation::Simulation(const Scenario& scenario, std::vector<LevelEvent> level_events)
    : level_events_(std::move(level_events)),
      world_(scenario.voxels.solids(),
             {.masks = scenario.masks.key(), .level_hash = scenario.voxels.level_hash()}),
      field_(scenario.voxels.solids(), scenario.voxels.planes, &scenario.masks) {}

Result<std::unique_ptr<Simulation>> Simulation::create(const Scenario& scenario) {
  auto changes = scenario::level_events(scenario);
  if (!changes) return changes.failure();
  BodyNumbers bodies;
  auto events =
      ordered_events(scenario.timeline, *changes, bodies,
                     {scenario.voxels.grid.layout(), scenario.timeline.smoke, scenario.shot_masks, scenario});
  if (!events) return events.failure();
  std::unique_ptr<Simulation> simulation(new Simulation(scenario, std::move(*changes)));
  if (auto done = simulation->add(std::move(*events), {}); !done) return done.failure();
  simulation->advance_to(0);
  return simulation;
}

void Simulation::advance_to(double seconds) {
  world_.advance_to(tick_at(seconds, world_.settings().ticks_per_second));
  follow_level();
  field_.update(world_);
}

std::vector<SmokeReport> Simulation::report_smokes(const Scenario& scenario) {
  return scenario::report_smokes(scenario, world_);
}

Result<void> Simulation::add(std::vector<OrderedEvent> events, std::vector<LevelEvent> changes) {
  if (!events.empty()) {
    // Merge the new events with the log from the first of them on.
    const auto log = world_.log();
    const EventOrder first{events.front().order.tick, EventKind{}, -1};
    const auto from =
        static_cast<std::size_t>(std::lower_bound(orders_.begin(), orders_.end(), first) - orders_.begin());
    std::vector<OrderedEvent> tail;
    tail.reserve(log.size() - from + events.size());
    for (std::size_t i = from; i < log.size(); ++i) tail.push_back({orders_[i], log[i]});
    const auto middle = static_cast<std::ptrdiff_t>(tail.size());
    std::move(events.begin(), events.end(), std::back_inserter(tail));
    std::inplace_merge(tail.begin(), tail.begin() + middle, tail.end(),
                       [](const OrderedEvent& a, const OrderedEvent& b) { return a.order < b.order; });

    // Replay from there.
    const std::vector<EventOrder> orders = orders_of(tail);
    if (auto done = world_.replace_from(first.tick, without_order(std::move(tail))); !done) return done;
    orders_.resize(from);
    orders_.insert(orders_.end(), orders.begin(), orders.end());
  }
  std::move(changes.begin(), changes.end(), std::back_inserter(level_events_));
  field_.forget_sights();
  next_level_.reset();
  return {};
}

Result<void> Simulation::replace(std::vector<OrderedEvent> events, std::vector<LevelEvent> changes,
                                 const sim::MaskKey& masks) {
  std::vector<EventOrder> orders = orders_of(events);
  std::vector<sim::Event> log = without_order(std::move(events));

  // The first tick at which the logs differ.
  const auto before = world_.log();
  const auto [was, is] = std::mismatch(before.begin(), before.end(), log.begin(), log.end());
  std::uint32_t first = sim::kMaxTick + 1;
  if (was != before.end()) first = sim::tick_of(*was);
  if (is != log.end()) first = std::min(first, sim::tick_of(*is));

  // Replay from that tick.
  const auto from = std::partition_point(
      log.begin(), log.end(), [&](const sim::Event& event) { return sim::tick_of(event) < first; });
  std::vector<sim::Event> tail(std::make_move_iterator(from), std::make_move_iterator(log.end()));
  if (auto done = world_.replace_from(first, std::move(tail), masks); !done) return done;
  orders_ = std::move(orders);
  field_.forget_sights();
  level_events_ = std::move(changes);
  in_effect_.reset();
  next_level_.reset();
  return {};
}

void Simulation::follow_level() {
  const std::size_t count = count_in_effect(level_events_, world_);
  if (count == in_effect_) return;
  in_effect_ = count;
  const auto present = std::span(level_events_).first(count);
  field_.set_patches(patches_of(present));

  hidden_objects_ = hidden_after(count);
  next_level_.reset();
}

/// The last of the first `events` decides whether an object is hidden.
std::vector<std::uint32_t> Simulation::hidden_after(std::size_t events) const {
  std::map<std::uint32_t, bool> hidden;
  for (std::size_t i = 0; i < events; ++i)
    for (const std::uint32_t object : level_events_[i].objects) hidden[object] = level_events_[i].hidden;
  std::vector<std::uint32_t> objects;
  for (const auto& [object, is_hidden] : hidden)
    if (is_hidden) objects.push_back(object);
  return objects;
}

std::shared_ptr<const planning::NextLevel> Simulation::next_level() const {
  const std::size_t present = count_in_effect(level_events_, world_);
  if (next_level_ || present == level_events_.size()) return next_level_;
  const auto tick_of = [&](const LevelEvent& event) {
    return tick_at(event.time, world_.settings().ticks_per_second);
  };
  // Changes of one tick happen at once.
  const voxel::Solids now = world_.solids();
  voxel::BitGrid grid = now.smoke;
  voxel::RoleGrids roles;
  if (&now.sight != &now.smoke) roles.sight = now.sight;
  std::size_t end = present;
  for (; end < level_events_.size() && tick_of(level_events_[end]) == tick_of(level_events_[present]); ++end)
    sim::apply_edits(grid, roles, level_events_[end].blocks);
  next_level_ = std::make_shared<const planning::NextLevel>(
      planning::NextLevel{roles.sight ? std::move(*roles.sight) : std::move(grid), hidden_after(end)});
  return next_level_;
}

}  // namespace brume::scenario
