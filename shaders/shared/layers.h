// Layers of a picture, one over the other: premultiplied radiance and, in alpha, transmittance.
#ifndef BRUME_LAYERS_H
#define BRUME_LAYERS_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindOverLayer, 101u);
SHARED_BINDING(kBindUnderLayers, 102u);
SHARED_BINDING(kBindLayers, 118u);
SHARED_BINDING(kBindLayerDepth, 119u);

SHARED_END
#endif
