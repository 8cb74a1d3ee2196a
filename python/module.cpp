// The extension module brume._brume: one file per subject binds its part.
#include "python/calls.hpp"
#include "python/grids.hpp"
#include "python/level.hpp"
#include "python/scenario.hpp"
#include "python/smoke.hpp"
#include "python/wire.hpp"
#include "python/world.hpp"

namespace {

/// Class.__new__(Class) makes an object without __init__. Before such an object reaches a function, pybind11
/// gives it memory that nothing initializes: that raises TypeError instead.
void refuse_unmade_objects(const pybind11::module_& module) {
  for (const auto& [name, member] : module.attr("__dict__").cast<pybind11::dict>()) {
    if (!PyType_Check(member.ptr())) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(member.ptr());
    if (pybind11::detail::type_info* const info = pybind11::detail::get_type_info(type))
      info->operator_new = [](std::size_t) -> void* {
        throw pybind11::type_error("the object is not made: __init__ did not run");
      };
  }
}

}  // namespace

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
  refuse_unmade_objects(module);
}
