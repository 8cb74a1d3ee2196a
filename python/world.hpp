// The class World of the module.
#pragma once

#include <optional>
#include <string>

#include "python/smoke.hpp"
#include "scenario/events.hpp"

namespace brume::python {

/// When an event happens: at a time [s], at a tick, or at the present tick.
struct When {
  std::optional<double> time;
  std::optional<std::int64_t> tick;
};
/// [s]
struct SmokeLife {
  double bloom, hold, dissolve;
};
/// Metres, seconds, degrees.
struct HoleForm {
  double radius, reach, expand, stay, fade, roll;
  std::string shape;
  std::optional<std::uint32_t> mask;
};
/// Metres, metres per second, seconds; a fraction.
struct BlastForm {
  double radius, speed, remaining, refill_rim, refill_middle;
};

class World : public Smoke {
 public:
  World(Level level, float extinction, std::uint32_t ticks_per_second, const std::vector<py::array>& masks);

  Level level() const override { return level_; }

  void throw_smoke(const py::object& origin, const py::object& at, const When& when, std::uint32_t voxels,
                   const SmokeLife& life);
  void shoot(const py::object& origin, const py::object& toward, const When& when, const HoleForm& form);
  void blast(const py::object& at, const When& when, const BlastForm& form);
  void move_body(std::uint32_t body, const py::object& to, const When& when);
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
  /// Whether all events of a tick are in a state whose history is dropped.
  bool is_complete(std::uint32_t tick) const;
  std::uint32_t tick_of(std::optional<double> time, std::optional<std::int64_t> tick) const;
  template <typename Make>
  void append(const When& when, const Make& make);

  Level level_;
  smoke::MaskAtlas masks_;
  float extinction_;
  sim::World world_;
  bool is_restored_ = false;
  std::unique_ptr<smoke::Field> field_;  // null: to be made
};

void bind_world(py::module_& module);

}  // namespace brume::python
