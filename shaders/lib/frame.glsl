// Constants of the frame.
#ifndef FRAME_GLSL
#define FRAME_GLSL
#include "shared/frame.h"

layout(scalar, binding = kBindFrame) uniform Frame { FrameConstants frame; };

#endif
