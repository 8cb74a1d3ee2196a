// The smoke of a tick, and queries of it: what World and Scenario have in common.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <shared_mutex>

#include "python/arrays.hpp"
#include "python/level.hpp"
#include "sim/world.hpp"
#include "smoke/field.hpp"

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
      is_current_ = false;
      ++revision_;
      return change();
    });
  }
  float extinction() const { return sight_look(false).extinction; }

  py::object optical_depth(const py::object& a, const py::object& b, bool drawn);
  py::object visible(const py::object& a, const py::object& b, float threshold, bool drawn);
  py::tuple sense(const py::object& origins, const py::object& directions, float max_distance);

  /// Processor time [s] that Sight::optical_depths takes for lines that are prepared in advance.
  double time_optical_depth(const py::object& a, const py::object& b);

 protected:
  virtual const sim::World& world() const = 0;
  /// Brought to the world's tick. Called while nothing reads.
  virtual const smoke::Field& update_field() = 0;
  virtual smoke::SightLook sight_look(bool drawn) const = 0;

 private:
  template <typename Query>
  void with_sight(std::optional<std::uint64_t>& revision, bool drawn, const Query& query);
  template <typename Query>
  void in_chunks(const Lines& lines, bool drawn, const Query& query);

  mutable std::shared_mutex mutex_;
  std::uint64_t revision_ = 0;
  const smoke::Field* field_ = nullptr;
  bool is_current_ = false;  // the field is at the world's tick
};

void bind_smoke(py::module_& module);

}  // namespace brume::python
