#include "voxel/bit_grid.hpp"
