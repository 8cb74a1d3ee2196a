#include "python/smoke.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <mutex>
#include <vector>

#include "core/tasks.hpp"
#include "python/density.hpp"

namespace brume::python {
namespace {

/// Lines between two looks for Ctrl-C, per core: 50 ms, in which starting the threads does not count.
constexpr std::size_t kChunkOfCore = 1 << 16;
constexpr std::size_t kDrawnChunkOfCore = 1 << 9;
constexpr std::size_t kGatherGrain = 1 << 13;

glm::vec3 point_at(const Points& points, std::size_t i) {
  glm::vec3 point;
  std::memcpy(&point, points.data() + (points.is_single() ? 0 : 3 * i), sizeof point);
  return point;
}

double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

/// Calls query(sight). The first call notes the revision; later ones throw where it has changed since.
template <typename Query>
void Smoke::with_sight(std::optional<std::uint64_t>& revision, bool drawn, const Query& query) {
  std::shared_lock lock(mutex_);
  while (!is_current_) {
    lock.unlock();
    {
      const std::unique_lock alone(mutex_);
      if (!is_current_) field_ = &update_field();
      is_current_ = true;
    }
    lock.lock();
  }
  if (revision && *revision != revision_)
    throw Error(ErrorCode::internal, "another thread moved the smoke during the query");
  revision = revision_;
  query(*field_->sight(sight_look(drawn)));
}

/// Calls query(sight, segments, number of the first) for all lines, part by part; ends at Ctrl-C.
template <typename Query>
void Smoke::in_chunks(const Lines& lines, bool drawn, const Query& query) {
  released([&] {
    std::optional<std::uint64_t> revision;
    const std::size_t chunk = (drawn ? kDrawnChunkOfCore : kChunkOfCore) * thread_count();
    std::vector<smoke::Segment> segments(std::min(lines.count, chunk));
    for (std::size_t first = 0; first < lines.count; first += chunk) {
      const std::size_t count = std::min(chunk, lines.count - first);
      // Another thread may write to the arrays: the query reads a copy.
      parallel_for(count, kGatherGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          segments[i] = {point_at(lines.a, first + i), point_at(lines.b, first + i)};
      });
      with_sight(revision, drawn, [&](const smoke::Sight& sight) {
        query(sight, std::span<const smoke::Segment>(segments).first(count), first);
      });
      if (first + count < lines.count) stop_if_interrupted();
    }
  });
}

py::object Smoke::optical_depth(const py::object& a, const py::object& b, bool drawn) {
  const Lines lines = lines_of(a, "a", b, "b");
  py::array_t<float> result(lines.shape);
  float* const out = result.mutable_data();
  in_chunks(lines, drawn,
            [&](const smoke::Sight& sight, std::span<const smoke::Segment> segments, std::size_t first) {
              sight.optical_depths(segments, {out + first, segments.size()}).value_or_throw();
            });
  if (lines.is_single()) return py::float_(*out);
  return result;
}

py::object Smoke::visible(const py::object& a, const py::object& b, float threshold, bool drawn) {
  if (!(threshold >= 0)) refuse("threshold", "expected an optical depth of at least 0");
  const Lines lines = lines_of(a, "a", b, "b");
  py::array_t<bool> result(lines.shape);
  auto* const out = reinterpret_cast<std::uint8_t*>(result.mutable_data());
  in_chunks(lines, drawn,
            [&](const smoke::Sight& sight, std::span<const smoke::Segment> segments, std::size_t first) {
              sight.visible(segments, threshold, {out + first, segments.size()}).value_or_throw();
            });
  if (lines.is_single()) return py::bool_(*out != 0);
  return result;
}

py::tuple Smoke::sense(const py::object& origins, const py::object& directions, float max_distance) {
  const Lines lines = lines_of(origins, "origins", directions, "directions");
  py::array_t<float> distances(lines.shape), depths(lines.shape);
  float *const distance = distances.mutable_data(), *const depth = depths.mutable_data();
  std::vector<smoke::SensorRay> rays;
  std::vector<smoke::SensorSample> samples;
  in_chunks(lines, false,
            [&](const smoke::Sight& sight, std::span<const smoke::Segment> segments, std::size_t first) {
              rays.clear();
              for (const smoke::Segment& s : segments) rays.push_back({s.a_world, s.b_world, max_distance});
              samples.resize(rays.size());
              const auto white = [](const smoke::SightWall&) { return glm::vec3(1); };
              sight.sense(rays, white, samples).value_or_throw();
              for (std::size_t i = 0; i < samples.size(); ++i) {
                distance[first + i] = samples[i].surface ? samples[i].distance : INFINITY;
                depth[first + i] = samples[i].optical_depth;
              }
            });
  if (lines.is_single()) return py::make_tuple(*distance, *depth);
  return py::make_tuple(distances, depths);
}

double Smoke::time_optical_depth(const py::object& a, const py::object& b) {
  const Lines lines = lines_of(a, "a", b, "b");
  return released([&] {
    std::vector<smoke::Segment> segments(lines.count);
    for (std::size_t i = 0; i < lines.count; ++i) segments[i] = {point_at(lines.a, i), point_at(lines.b, i)};
    std::vector<float> depths(lines.count);
    double seconds = 0;
    std::optional<std::uint64_t> revision;
    with_sight(revision, false, [&](const smoke::Sight& sight) {
      const double start = processor_seconds();
      sight.optical_depths(segments, depths).value_or_throw();
      seconds = processor_seconds() - start;
    });
    return seconds;
  });
}

namespace {

using SmokeClass = py::class_<Smoke, std::shared_ptr<Smoke>>;

void bind_state(SmokeClass& smoke) {
  smoke.def_property_readonly("level", &Smoke::level, "The Level, without the changes since.")
      .def_property_readonly(
          "solid",
          [](const Smoke& s) {
            const voxel::BitGrid grid = s.read([](const sim::World& world) { return world.grid(); });
            return solid_array(grid);
          },
          "Which voxels are solid at this tick: a new array of bool, shape (x, y, z).")
      .def_property_readonly("extinction", &Smoke::extinction, "Extinction of full density [1/m].")
      .def_property_readonly(
          "tick", [](const Smoke& s) { return s.read([](const sim::World& world) { return world.tick(); }); },
          "The present tick.")
      .def_property_readonly(
          "ticks_per_second",
          [](const Smoke& s) {
            return s.read([](const sim::World& world) { return world.settings().ticks_per_second; });
          },
          "Ticks per second.")
      .def_property_readonly(
          "time",
          [](const Smoke& s) {
            return s.read([](const sim::World& world) {
              return static_cast<double>(world.tick()) / world.settings().ticks_per_second;
            });
          },
          "The time of the present tick [s].")
      .def_property_readonly(
          "state_hash",
          [](const Smoke& s) { return s.read([](const sim::World& world) { return world.state_hash(); }); },
          "Hash of the whole state, 64 bits: equal states have equal hashes on every machine. "
          "f\"{hash:016x}\" is what brume sim prints.")
      .def_property_readonly(
          "clouds",
          [](const Smoke& s) {
            return s.read([](const sim::World& world) { return world.state().clouds.size(); });
          },
          "Number of smokes that have gone off and are not gone.")
      .def_property_readonly(
          "flights",
          [](const Smoke& s) {
            return s.read([](const sim::World& world) { return world.state().flights.size(); });
          },
          "Number of grenades in the air.")
      .def_property_readonly(
          "holes",
          [](const Smoke& s) {
            return s.read([](const sim::World& world) { return world.state().holes.size(); });
          },
          "Number of holes that shots have made and that are not closed.");
}

void bind_queries(SmokeClass& smoke) {
  using namespace py::literals;
  smoke
      .def("optical_depth", &Smoke::optical_depth, "a"_a, "b"_a, "drawn"_a = false,
           R"(Optical depth of the smoke between points; exp(-depth) of the light passes. Walls do not matter.

a, b: points [m], shape (..., 3), both of the same shape or one of them (3,). Arrays of float32 in C order are
    read as they are, others are converted. Coordinates are finite and within 16384 m.
drawn: of the smoke as pictures show it, eroded by noise and with frayed rims, some hundred times as slowly.
Returns float32, shape (...); a float for two points of the shape (3,).

All events up to the present are part of it. The same bits for one line or among many, on
every machine. Uses all cores and runs without the interpreter lock; Ctrl-C ends it. Raises ValueError for
another shape or a point out of range, TypeError for what is no array of numbers.)")
      .def("visible", &Smoke::visible, "a"_a, "b"_a, "threshold"_a = 3.0f, "drawn"_a = false,
           R"(Whether b is visible from a: no wall between them, and not too much smoke.

Glass and grilles are no walls.

a, b: as for optical_depth. The voxels that a and b lie in do not hide them.
threshold: largest optical depth through which b is visible, at least 0; 3 lets 5 % of the light through,
    infinity means walls only.
drawn: as for optical_depth: whether a player sees through a rim.
Returns bool, shape (...); a bool for two points of the shape (3,). Faster than optical_depth.)")
      .def("sense", &Smoke::sense, "origins"_a, "directions"_a, "max_distance"_a = 100.0f,
           R"(What rays meet, as a depth camera measures it.

origins: points [m], shape (..., 3) or (3,), as for optical_depth.
directions: shape (..., 3) or (3,), any length but 0.
max_distance: [m], above 0, at most 32768.
Returns (distance, optical_depth), float32 of the shape (...): how far the first wall is [m], infinity
where none is within max_distance, and the optical depth up to there. The voxel of the origin does not count.)")
      .def("_density", &density_array, "low"_a, "high"_a, "as_steps"_a,
           "Densities of the voxels [low, high) as uint8 steps or float32: Smoke.density is its wrapper.")
      .def("_time_optical_depth", &Smoke::time_optical_depth, "a"_a, "b"_a,
           "Processor time [s] of optical_depth in C++ alone: for a test.");
}

}  // namespace

void bind_smoke(py::module_& module) {
  SmokeClass smoke(module, "Smoke",
                   R"(The smoke of a level at one tick, and queries of it: what World and Scenario share.

Positions are in metres, y points up. Any number of threads may query while none changes it.)");
  bind_state(smoke);
  bind_queries(smoke);
}

}  // namespace brume::python
