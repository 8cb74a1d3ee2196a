// The mean of the frames of a picture.
#ifndef BRUME_AVERAGE_H
#define BRUME_AVERAGE_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindRadianceSum, 65u);

struct AverageConstants {
  uvec2 size_px;
  uint index;  // frames before this one
};
SHARED_SIZE(AverageConstants, 12);

SHARED_END
#endif
