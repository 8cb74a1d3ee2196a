// Enlarges the image of a window that is rendered with fewer pixels.
#ifndef BRUME_UPSCALE_H
#define BRUME_UPSCALE_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindUpscaleSource, 0u);
SHARED_BINDING(kBindUpscaleTarget, 1u);

struct UpscaleConstants {
  uvec2 source_px;
  uvec2 target_px;
};
SHARED_SIZE(UpscaleConstants, 16);

SHARED_END
#endif
