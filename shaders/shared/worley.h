// Tileable cellular noise.
#ifndef BRUME_WORLEY_H
#define BRUME_WORLEY_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST uint kWorleyGroup = 4u;

struct WorleyParams {
  uint size;          // texels per axis of the tile
  uint coarse_cells;  // cells per axis of the first octave of channel R; G has three times as many
  uint octaves;       // each with twice the cells and half the weight of the one before
  uint seed;
};
SHARED_SIZE(WorleyParams, 16);

SHARED_END
#endif
