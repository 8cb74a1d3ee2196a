// The tone curve of a frame.
#ifndef TONE_GLSL
#define TONE_GLSL
#include "lib/frame.glsl"
#include "shared/tone.h"

vec3 tone_curve(vec3 colour) { return tone_curve(frame.tone, colour); }

#endif
