// Grids as dictionaries of arrays, which brume/_grids.py makes its class Grid of.
#pragma once

#include "grids/grid.hpp"
#include "python/arrays.hpp"

namespace brume::python {

/// The smallest array around all voxels that are active or differ from the background.
py::dict dict_of(const grids::Grid& grid);

/// The same grid of a dictionary. Raises TypeError and ValueError for one that dict_of does not make.
grids::Grid grid_of(const py::dict& dict);

}  // namespace brume::python
