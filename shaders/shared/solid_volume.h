// Solid parts of the level on the device.
//
//   texels   a 3D texture, R: 1 in a free texel, 0 in a solid one; filtered linearly, the free fraction.
//   words    the same as bits: word x / 32 of row (y, z), rows in order of y, then z; bit x % 32 is 1 in a solid
//            texel. Bits beyond the end of a row are 0.
//
// In a level with too many voxels a texel covers a cube of them. It is solid when the solid voxels in it amount to at
// least half of a wall of one voxel across the texel.
#ifndef BRUME_SOLID_VOLUME_H
#define BRUME_SOLID_VOLUME_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindSolidTexels, 16u);

/// Placement of the texels.
struct SolidLayout {
  vec3 origin_world;  // low corner of texel (0, 0, 0) [m]
  float texel_size;   // [m]
  ivec3 size;         // texels
  uint padding SHARED_ZERO;
};
SHARED_SIZE(SolidLayout, 32);

/// Length at both ends of a ray segment between surfaces where solid texels are ignored [texels]: a texel's diagonal.
SHARED_CONST float kSolidEnds = 1.7320508f;

/// Words per row of texels.
SHARED_FUNCTION int solid_row_words(int texels_x) {
  return (texels_x + 31) / 32;
}

SHARED_END
#endif
