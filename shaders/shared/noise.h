// The tile of noise that smoke is eroded with.
#ifndef BRUME_NOISE_H
#define BRUME_NOISE_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST uint kNoiseGroup = 4u;

struct NoiseParams {
  uint size;          // texels per axis of the tile
  uint coarse_cells;  // cells per axis of the coarsest octave
  uint seed;
};
SHARED_SIZE(NoiseParams, 12);

SHARED_END
#endif
