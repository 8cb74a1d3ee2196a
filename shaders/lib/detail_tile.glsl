// The tile of detail of the noise (shaders/noise_detail.comp, shared/erosion.h).
#ifndef DETAIL_TILE_GLSL
#define DETAIL_TILE_GLSL
#include "shared/noise.h"

layout(binding = kBindDetailTile) uniform sampler3D detail_tile;

#endif
