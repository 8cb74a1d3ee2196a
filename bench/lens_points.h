// What bench/lens_points.comp is given.
#ifndef BRUME_LENS_POINTS_H
#define BRUME_LENS_POINTS_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindLensSums, 32u);

struct LensPointsParams {
  uint points;  // of each thread
  uint blades;
};
SHARED_SIZE(LensPointsParams, 8);

SHARED_END
#endif
