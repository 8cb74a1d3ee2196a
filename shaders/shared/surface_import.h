// Surfaces that a host drew, the media over them in the host's picture, and the media's shadows on them.
#ifndef BRUME_SURFACE_IMPORT_H
#define BRUME_SURFACE_IMPORT_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindHostDepth, 96u);
SHARED_BINDING(kBindImportedDepth, 97u);
SHARED_BINDING(kBindMediaLayer, 98u);
SHARED_BINDING(kBindSurfaceShadows, 99u);
SHARED_BINDING(kBindHostNormals, 100u);
SHARED_BINDING(kBindImportedNormals, 101u);
SHARED_BINDING(kBindLayerOcclusion, 102u);

/// A depth d of the host is affine in near_z / distance along the view axis or, in a parallel view, in its inverse.
struct SurfaceImportParams {
  uvec2 size_px;
  uvec2 origin_px;   // of the picture in the host's image
  float offset;      // of d
  float scale;       // (d - offset) scale is near_z / distance or its inverse
  float none;        // the host's depth where nothing was drawn
  uint is_parallel;
};
SHARED_SIZE(SurfaceImportParams, 32);

/// How a host stores normals: as they are; n as (n + 1) / 2; the upper half of an octahedron, and its lower half folded
/// over it, in x and y (Meyer et al. 2010, "On Floating-Point Normal Vectors"); that likewise from 0 to 1.
SHARED_CONST uint kNormalsSigned = 0u;
SHARED_CONST uint kNormalsUnsigned = 1u;
SHARED_CONST uint kNormalsOctahedral = 2u;
SHARED_CONST uint kNormalsOctahedralUnsigned = 3u;
SHARED_CONST uint kNormalsOfDepth = 4u;  // there are none

struct SurfaceNormalParams {
  uvec2 origin_px;      // of the picture in the host's image
  uint encoding;        // kNormals...
  uint of_view;         // 1: along right, up and against forward; 0: of the world
  uint alpha_receives;  // 1: surfaces of alpha 0 have no decals
};
SHARED_SIZE(SurfaceNormalParams, 20);

/// Lights whose shadows a host may ask for, and the number of none.
SHARED_CONST uint kMaxSurfaceShadows = 4u;
SHARED_CONST uint kNoLight = 0xffffffffu;

struct SurfaceShadowParams {
  uvec4 lights;  // numbers in the frame's lights
};
SHARED_SIZE(SurfaceShadowParams, 16);

struct MediaLayerParams {
  uvec2 origin_px;  // of the picture in the host's image
  float exposure;   // multiplies the media's radiance
  uint has_decals;  // 1: they darken the picture
};
SHARED_SIZE(MediaLayerParams, 16);

SHARED_END
#endif
