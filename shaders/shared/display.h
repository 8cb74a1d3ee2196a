// The last step of a frame: from radiance to what a screen shows.
#ifndef BRUME_DISPLAY_H
#define BRUME_DISPLAY_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindRadiance, 44u);
SHARED_BINDING(kBindDisplay, 45u);

SHARED_END
#endif
