// Packets: the classes Sender and Receiver of the module.
#pragma once

#include "python/calls.hpp"

namespace brume::python {

/// After bind_world.
void bind_wire(py::module_& module);

}  // namespace brume::python
