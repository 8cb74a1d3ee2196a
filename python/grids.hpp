// Files of volume grids: reading, writing and converting them.
#pragma once

#include "python/calls.hpp"

namespace brume::python {

void bind_grids(py::module_& module);

}  // namespace brume::python
