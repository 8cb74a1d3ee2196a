// The extension module brume._brume: one file per subject binds its part.
#include "python/calls.hpp"
#include "python/grids.hpp"
#include "python/level.hpp"
#include "python/scenario.hpp"
#include "python/smoke.hpp"
#include "python/wire.hpp"
#include "python/world.hpp"

PYBIND11_MODULE(_brume, module) {
  module.doc() = "What the package brume is made of; import brume instead.";
  const pybind11::object name = module.attr("__name__");
  module.attr("__name__") = "brume";  // The module that classes and docstrings name.
  brume::python::init_calls();
  brume::python::bind_level(module);
  brume::python::bind_smoke(module);
  brume::python::bind_world(module);
  brume::python::bind_wire(module);
  brume::python::bind_scenario(module);
  brume::python::bind_grids(module);
  module.attr("__name__") = name;
}
