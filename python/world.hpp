// The class World of the module.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "python/smoke.hpp"
#include "scenario/events.hpp"
#include "sim/event_fields.hpp"

namespace brume::python {

/// When an event happens: at a time [s], at a tick, or at the present tick.
struct When {
  std::optional<double> time;
  std::optional<std::int64_t> tick;
};
/// Values of an event by the keys of sim/event_fields.hpp: metres, seconds, fractions, degrees.
struct EventValues {
  std::vector<std::pair<std::string_view, glm::dvec3>> positions;
  std::vector<std::pair<std::string_view, double>> numbers;
};

/// Sets the fields of an event that have values, in its steps: a visitor of sim/event_fields.hpp.
struct ValueSetter {
  const EventValues& values;
  std::uint32_t ticks_per_second;
  void operator()(const sim::PositionField& field, sim::Position& member) const;
  void operator()(const sim::NumberField& field, std::uint32_t& member) const;
  void operator()(const sim::ChoiceField&, const auto&) const {}
};

class World : public Smoke {
 public:
  World(Level level, float extinction, std::uint32_t ticks_per_second, const std::vector<py::array>& masks);

  Level level() const override { return level_; }

  /// Appends an event with these values; its other fields are as given.
  template <typename Event>
  void append(const When& when, const EventValues& values, Event event = {}) {
    sim::visit_fields(event, ValueSetter{values, world_.settings().ticks_per_second});
    append_event(when, event);
  }
  void set_solid(const py::object& low, const py::object& high, bool solid, const When& when);

  void advance_to(std::optional<double> time, std::optional<std::int64_t> tick);
  void step(std::uint32_t ticks);
  void forget_before(std::optional<double> time, std::optional<std::int64_t> tick);

  py::bytes save() const;
  void restore(const py::bytes& bytes);
  void restore_state(const sim::State& state);

 protected:
  const sim::World& world() const override { return world_; }
  const smoke::Field& update_field() override;
  smoke::SightLook sight_look(bool drawn) const override;

 private:
  std::uint32_t tick_of(std::optional<double> time, std::optional<std::int64_t> tick) const;
  void append_event(const When& when, sim::Event event);

  Level level_;
  smoke::MaskAtlas masks_;
  float extinction_;
  sim::World world_;
  std::unique_ptr<smoke::Field> field_;  // null: to be made
};

void bind_world(py::module_& module);

}  // namespace brume::python
