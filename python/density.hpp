// Densities as arrays.
#pragma once

#include "python/smoke.hpp"

namespace brume::python {

/// Densities at the centres of the voxels [low, high) (None: of the whole grid), shape (x, y, z): steps of
/// 1/255 as uint8, or float32 in [0, 1]; without holes.
py::array density_array(const Smoke& smoke, const py::object& low, const py::object& high, bool as_steps);

}  // namespace brume::python
