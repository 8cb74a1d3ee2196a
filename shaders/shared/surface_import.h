// Surfaces that a host drew, the media over them in the host's picture, and the media's shadows on them.
#ifndef BRUME_SURFACE_IMPORT_H
#define BRUME_SURFACE_IMPORT_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindHostDepth, 96u);
SHARED_BINDING(kBindImportedDepth, 97u);
SHARED_BINDING(kBindMediaLayer, 98u);
SHARED_BINDING(kBindSurfaceShadows, 99u);

/// A depth of the host is d = offset + scale / distance along the view axis.
struct SurfaceImportParams {
  uvec2 size_px;
  float offset;
  float near_over_scale;  // near_z / scale: to reverse depth, by a multiplication
  float none;             // the host's depth where nothing was drawn
};
SHARED_SIZE(SurfaceImportParams, 20);

/// Lights whose shadows a host may ask for, and the number of none.
SHARED_CONST uint kMaxSurfaceShadows = 4u;
SHARED_CONST uint kNoLight = 0xffffffffu;

struct SurfaceShadowParams {
  uvec4 lights;  // numbers in the frame's lights
};
SHARED_SIZE(SurfaceShadowParams, 16);

/// What the media's radiance is multiplied by.
struct MediaLayerParams {
  float exposure;
};
SHARED_SIZE(MediaLayerParams, 4);

SHARED_END
#endif
