// The tile of noise that erodes smoke and disturbs volumes (shaders/noise.comp).
#ifndef NOISE_TILE_GLSL
#define NOISE_TILE_GLSL
#include "shared/noise.h"

layout(binding = kBindNoiseTile) uniform sampler3D noise_tile;

#endif
