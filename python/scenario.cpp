#include "python/scenario.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

#include "planning/smoke_look.hpp"
#include "scenario/tank.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/options.hpp"
#include "scene/text_reader.hpp"

namespace brume::python {
namespace {

namespace fs = std::filesystem;

std::shared_ptr<Scenario> load_source(const fs::path& path, std::optional<float> voxel_size,
                                      std::optional<float> scale, float aspect, const py::object& camera) {
  if (!(aspect > 0 && std::isfinite(aspect))) refuse("aspect", "expected a number above 0");
  if (voxel_size && !(*voxel_size >= 0.015625f && *voxel_size <= 64))
    refuse("voxel_size", "expected 1/64 to 64 m");
  if (scale && !(*scale >= 1e-6f && *scale <= 1e6f)) refuse("scale", "expected 1e-6 to 1e6");
  const std::optional<scene::Camera> from = camera_of(camera);
  return released([&] {
    if (fs::exists(path) && scenario::is_tank_input(path))
      throw Error(ErrorCode::bad_input, path.string() + ": is a tank of spheres; use the program brume");
    scenario::FirstViewOptions options;
    options.aspect = aspect;
    options.voxel = voxel_size;
    options.scale = scale;
    options.camera = from;
    if (!scenario::is_timeline(path) || !(voxel_size || scale)) {
      auto scenario = of_file(scenario::load_scenario(path, {}, options), path);
      return std::make_shared<Scenario>(std::shared_ptr<Loaded>(new Loaded{std::move(scenario), {}}));
    }
    scene::Timeline timeline = of_file(scene::load_timeline(path), path);
    if (voxel_size) timeline.grid.voxel = *voxel_size;
    if (scale) timeline.scale = *scale;
    auto scenario = scenario::make_scenario(std::move(timeline), {}).value_or_throw();
    return std::make_shared<Scenario>(std::shared_ptr<Loaded>(new Loaded{std::move(scenario), {}}));
  });
}

}  // namespace

Scenario::Scenario(std::shared_ptr<Loaded> loaded)
    : loaded_(std::move(loaded)),
      simulation_(scenario::Simulation::create(loaded_->scenario).value_or_throw()) {}

Level Scenario::level() const {
  return {{loaded_, &loaded_->scenario.voxels}};
}

smoke::SightLook Scenario::sight_look(bool drawn) const {
  const scenario::Scenario& shown = loaded_->scenario;
  return planning::sight_look(shown.timeline.smoke, shown.voxels.grid.layout().voxel_size, drawn);
}

void Scenario::advance_to(double seconds) {
  if (!(seconds >= 0 && seconds <= scene::kLatestTime))
    refuse("time", "expected 0 to 3600 s, got " + scene::shown(seconds));
  change([&] { simulation_->advance_to(seconds); });
  py::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void bind_scenario(py::module_& module) {
  using namespace py::literals;
  py::class_<Scenario, Smoke, std::shared_ptr<Scenario>>(
      module, "Scenario",
      "A timeline, a scene or a volume as load() reads it, at one time. Its ticks are 1/64 s, as those of "
      "brume sim.")
      .def("advance_to", &Scenario::advance_to, "time"_a,
           "Moves to the tick at or before a time [s], 0 to 3600, forwards or back. Raises ValueError.")
      .def_property_readonly(
          "duration", [](const Scenario& s) { return double{s.loaded()->scenario.timeline.duration}; },
          "The end of the timeline [s].")
      .def("__repr__", [](const Scenario& s) {
        return s.read([](const sim::World& world) {
          return "Scenario(tick=" + std::to_string(world.tick()) +
                 ", clouds=" + std::to_string(world.state().clouds.size()) +
                 ", holes=" + std::to_string(world.state().holes.size()) + ")";
        });
      });
  module.def(
      "load", &load_source, "path"_a, py::kw_only(), "voxel_size"_a = py::none(), "scale"_a = py::none(),
      "aspect"_a = 16.0f / 9.0f, "camera"_a = py::none(),
      R"(Loads a timeline (.toml), a scene (.glb, .gltf, .obj, .txt) or a volume (.vdb, .nvdb, .brv) as a Scenario.

voxel_size: edge length of a voxel [m], 1/64 to 64; default: the timeline's, or what fits the scene.
scale: metres per unit of the scene; default: the timeline's, or what fits.
aspect, camera: width / height of pictures, and where they are looked from (as in Renderer.draw): a scene without
    a timeline gets a smoke that fits them, and a camera where it has none.

Warnings of the files are UserWarnings. Raises FileNotFoundError, ValueError for a damaged file, with its place.)");
  bind_renderer(module);
}

}  // namespace brume::python
