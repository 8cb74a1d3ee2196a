// The smoke of a tick, and queries of it: what World and Scenario have in common.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <utility>
#include <vector>

#include "python/arrays.hpp"
#include "python/level.hpp"
#include "sim/world.hpp"
#include "smoke/drawn_sight.hpp"
#include "smoke/holes.hpp"

namespace brume::python {

/// Any number of threads may query while none moves it. Its locks are taken without the interpreter lock.
class Smoke {
 public:
  Smoke() = default;
  Smoke(const Smoke&) = delete;
  virtual ~Smoke() = default;

  virtual Level level() const = 0;

  /// Calls read(world) while nothing changes it.
  template <typename Read>
  auto read(const Read& read) const {
    return released([&] {
      const std::shared_lock lock(mutex_);
      return read(world());
    });
  }
  /// Calls change() while nothing reads.
  template <typename Change>
  auto change(const Change& change) {
    return released([&] {
      const std::unique_lock lock(mutex_);
      sight_.reset();
      drawn_.reset();
      ++revision_;
      return change();
    });
  }
  float extinction() const { return sight_settings().extinction; }

  py::object optical_depth(const py::object& a, const py::object& b, bool drawn);
  py::object visible(const py::object& a, const py::object& b, float threshold, bool drawn);
  py::tuple sense(const py::object& origins, const py::object& directions, float max_distance);

  /// Processor time [s] that Sight::optical_depths takes for lines that are prepared in advance.
  double time_optical_depth(const py::object& a, const py::object& b);

 protected:
  virtual const sim::World& world() const = 0;
  virtual const smoke::SmokeVolume& volume() const = 0;
  /// Brings the volume to the world's tick.
  virtual void update_volume() = 0;
  virtual smoke::SightSettings sight_settings() const = 0;
  /// How it is drawn, and how long its noise takes to roll around once [s].
  virtual std::pair<shared::SmokeLook, double> drawn_look() const;

 private:
  template <typename Query>
  void with_sight(std::optional<std::uint64_t>& revision, bool drawn, const Query& query);
  void make_sight(bool drawn);
  template <typename Query>
  void in_chunks(const Lines& lines, bool drawn, const Query& query);

  mutable std::shared_mutex mutex_;
  std::uint64_t revision_ = 0;
  std::vector<shared::Hole> holes_;    // of the sight
  std::optional<smoke::Sight> sight_;  // none: to be made
  std::unique_ptr<const smoke::DrawnSight> drawn_;
};

void bind_smoke(py::module_& module);

}  // namespace brume::python
