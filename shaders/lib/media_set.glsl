// Which media a pipeline is for. The includer defines the constant kMedia, their set (shared/media.h).
#ifndef MEDIA_SET_GLSL
#define MEDIA_SET_GLSL
#include "shared/media.h"

// Constants of the pipeline: a software rasteriser pays for branches that it does not take.
const bool kHasSmoke = (kMedia & kMediumSmoke) != 0u;
const bool kHasVolumes = (kMedia & kMediumVolumes) != 0u;
const bool kInParallelView = (kMedia & kRaysParallel) != 0u;

#endif
