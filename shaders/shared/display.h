// The last step of a frame: from radiance to what a screen shows.
#ifndef BRUME_DISPLAY_H
#define BRUME_DISPLAY_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindRadiance, 44u);
SHARED_BINDING(kBindDisplay, 45u);

struct DisplayParams {
  float dither;  // size of the noise that is added before rounding, in steps of 8 bits
};
SHARED_SIZE(DisplayParams, 4);

SHARED_END
#endif
