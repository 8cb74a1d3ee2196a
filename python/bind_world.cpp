// World as Python sees it.
#include <pybind11/stl.h>

#include "python/world.hpp"

namespace brume::python {
namespace {

using namespace py::literals;
using Class = py::class_<World, Smoke, std::shared_ptr<World>>;
using Time = std::optional<double>;
using Tick = std::optional<std::int64_t>;

/// A shot of a cross-section; `mask` takes precedence.
sim::Shot shot_of(const std::string& shape, std::optional<std::uint32_t> mask) {
  if (shape != "cylinder" && shape != "box")
    refuse("shape", "expected 'cylinder' or 'box', got '" + shape + "'");
  sim::Shot shot;
  if (shape == "box") shot.shape = sim::HoleShape::box;
  if (mask) {
    shot.shape = sim::HoleShape::mask;
    shot.mask = *mask;
  }
  return shot;
}

void bind_smoke_events(Class& world) {
  world.def(
      "throw_smoke",
      [](World& w, const py::object& origin, const py::object& at, Time time, Tick tick, std::uint32_t voxels,
         double bloom, double hold, double dissolve) {
        w.append<sim::ThrowSmoke>(
            {time, tick}, {{{"from", vector_of("origin", origin)}, {"at", vector_of("at", at)}},
                           {{"voxels", voxels}, {"bloom", bloom}, {"hold", hold}, {"dissolve", dissolve}}});
      },
      "origin"_a, "at"_a, py::kw_only(), "time"_a = py::none(), "tick"_a = py::none(), "voxels"_a = 1800,
      "bloom"_a = 1.0, "hold"_a = 18.0, "dissolve"_a = 3.0,
      R"(Throws a smoke grenade from `origin` through `at`. It flies at 20 m/s to the first wall and goes off there.

origin, at: points [m], within 16384 m. Where both are the same point, it goes off there at once.
time, tick: when it is thrown, in seconds (the tick at or before) or as a tick; default: the present tick, right
    after restore the next one. An event in the past changes the past: the world rolls back and replays.
voxels: how many voxels it fills, 1 to 2^27.
bloom, hold, dissolve: times to full size, at full size, and until it is gone [s], rounded to ticks.

Raises ValueError for a number out of range; the world is then unchanged.)");
  world.def(
      "blast",
      [](World& w, const py::object& at, Time time, Tick tick, double radius, double speed, double remaining,
         double refill_rim, double refill_middle) {
        w.append<sim::Blast>({time, tick}, {{{"at", vector_of("at", at)}},
                                            {{"radius", radius},
                                             {"speed", speed},
                                             {"remaining", remaining},
                                             {"refill_rim", refill_rim},
                                             {"refill_middle", refill_middle}}});
      },
      "at"_a, py::kw_only(), "time"_a = py::none(), "tick"_a = py::none(), "radius"_a = 5.0, "speed"_a = 32.0,
      "remaining"_a = 0.02, "refill_rim"_a = 0.5, "refill_middle"_a = 5.0,
      R"(An explosion drives the smoke out of what is visible from it; the cavity refills from its rim.

at: point [m].
time, tick: as for throw_smoke.
radius: [m], 1 to 64 voxels.
speed: of the front [m/s], 1 to 16384.
remaining: fraction of the density that remains, 0 to 1.
refill_rim, refill_middle: times until the rim and the middle are full again [s].

Raises ValueError for a number out of range; the world is then unchanged.)");
}

void bind_other_events(Class& world) {
  world.def(
      "shoot",
      [](World& w, const py::object& origin, const py::object& toward, Time time, Tick tick, double radius,
         double reach, double expand, double stay, double fade, const std::string& shape, double roll,
         std::optional<std::uint32_t> mask) {
        w.append({time, tick},
                 {{{"from", vector_of("origin", origin)}, {"toward", vector_of("toward", toward)}},
                  {{"radius", radius},
                   {"reach", reach},
                   {"expand", expand},
                   {"stay", stay},
                   {"fade", fade},
                   {"roll", roll}}},
                 shot_of(shape, mask));
      },
      "origin"_a, "toward"_a, py::kw_only(), "time"_a = py::none(), "tick"_a = py::none(), "radius"_a = 0.2,
      "reach"_a = 0.25, "expand"_a = 0.05, "stay"_a = 1.0, "fade"_a = 0.35, "shape"_a = "cylinder",
      "roll"_a = 0.0, "mask"_a = py::none(),
      R"(A bullet bores a hole through the smoke of that tick, up to the first wall.

origin, toward: two points [m]: the muzzle, and a point on the bullet's path.
time, tick: as for throw_smoke.
radius: of the hole, half the edge of a box or mask [m].
reach, expand, stay, fade: times until the hole is bored to its end, is wide open, begins to close, and is
    closed [s], one after another.
shape: "cylinder" or "box".
roll: rotation of a box or mask, clockwise as the shooter sees it [degrees].
mask: number of an image of World(masks=...), which the hole has as its cross-section.

Raises ValueError for a number out of range; the world is then unchanged.)");
  world.def(
      "move_body",
      [](World& w, std::uint32_t body, const py::object& to, Time time, Tick tick) {
        w.append({time, tick}, {{{"to", vector_of("to", to)}}, {}}, sim::MoveBody{0, body});
      },
      "body"_a, "to"_a, py::kw_only(), "time"_a = py::none(), "tick"_a = py::none(),
      R"(A player or an object moves; its wake stirs the smoke of pictures.

body: your number for it, 0 to 2^32 - 1. Its first move places it.
to: point [m].
time, tick: as for throw_smoke.)");
  world.def(
      "set_solid",
      [](World& w, const py::object& low, const py::object& high, bool solid, Time time, Tick tick) {
        w.set_solid(low, high, solid, {time, tick});
      },
      "low"_a, "high"_a, "solid"_a = true, py::kw_only(), "time"_a = py::none(), "tick"_a = py::none(),
      R"(Makes a box of the level solid, or free: a door, a breach. Smoke flows on through what became free.

low, high: corners [m]; voxels whose centres lie between them change. At most 2^27 of them.
solid: what they become.
time, tick: as for throw_smoke.

Smoke ends at the faces of changed voxels. Raises ValueError for a box without a voxel of the level,
MemoryError for too many.)");
}

void bind_time(Class& world) {
  world
      .def("advance_to", &World::advance_to, "time"_a = py::none(), py::kw_only(), "tick"_a = py::none(),
           R"(Moves to the tick at or before a time [s], or to a tick; forwards, or back to earliest_tick.

Costs nothing where nothing begins or ends in between. Ctrl-C ends it, between two ticks. Raises ValueError for
a tick before earliest_tick or after 2^29.)")
      .def("step", &World::step, "ticks"_a = 1, "Moves forwards by some ticks.")
      .def_property_readonly(
          "earliest_tick",
          [](const World& w) {
            return w.read([](const sim::World& present) { return present.earliest_tick(); });
          },
          "The first tick that can be rolled back to.")
      .def("forget_before", &World::forget_before, "time"_a = py::none(), py::kw_only(),
           "tick"_a = py::none(),
           "Drops the history before a time [s] or tick, and refuses events before it from now on. A server "
           "calls "
           "it each tick.")
      .def(
          "save", &World::save,
          R"(The state of the present tick as bytes, a few hundred for a smoke. The level and later events are not
part of it.)")
      .def("restore", &World::restore, "state"_a,
           R"(Goes on from a state of save(), of a world of the same level, tick rate and masks.

Earlier ticks are dropped, later events stay. Raises ValueError for damaged bytes and for another world's.)")
      .def("__repr__", [](const World& w) {
        return w.read([](const sim::World& present) {
          return "World(tick=" + std::to_string(present.tick()) +
                 ", clouds=" + std::to_string(present.state().clouds.size()) +
                 ", holes=" + std::to_string(present.state().holes.size()) + ")";
        });
      });
}

}  // namespace

void bind_world(py::module_& module) {
  Class world(module, "World", R"(A simulated level: events in, the state of any tick out.

The same events give the same bits on every machine, whatever the order in which they became known and the
ticks that were visited.)");
  world.def(py::init<Level, float, std::uint32_t, const std::vector<py::array>&>(), "level"_a, py::kw_only(),
            "extinction"_a = 3.0f, "ticks_per_second"_a = 64, "masks"_a = py::tuple(),
            R"(level: its walls.
extinction: of full density, for queries [1/m], 0 to 10^6.
ticks_per_second: 1 to 1000.
masks: images that shots may cut out, arrays of uint8 of the shape (height, width): 255 removes all smoke.

Raises ValueError for a number out of range.)");
  bind_smoke_events(world);
  bind_other_events(world);
  bind_time(world);
}

}  // namespace brume::python
