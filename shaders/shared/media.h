// The media of a frame that a march goes through together.
#ifndef BRUME_MEDIA_H
#define BRUME_MEDIA_H
#include "shared/shim.h"
SHARED_BEGIN

/// Bits of a set of media.
SHARED_CONST uint kMediumSmoke = 1u;
SHARED_CONST uint kMediumVolumes = 2u;
SHARED_CONST uint kMediumHeat = 4u;  // of a volume: never without kMediumVolumes

SHARED_END
#endif
