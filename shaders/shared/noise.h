// The tiling 3D noise that erodes smoke.
#ifndef BRUME_NOISE_H
#define BRUME_NOISE_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindNoiseTile, 21u);
SHARED_BINDING(kBindBlueNoise, 22u);
SHARED_BINDING(kBindDetailTile, 106u);

/// Texels per axis of the tile of detail (erosion.h).
SHARED_CONST uint kDetailTexels = 128u;

struct NoiseParams {
  uint size;          // texels per axis of the tile
  uint coarse_cells;  // per axis, of the coarsest octave
  uint seed;
};
SHARED_SIZE(NoiseParams, 12);

SHARED_END
#endif
