// The level on the device: where it is solid.
//
//   texels   a 3D texture, R: 1 in a free texel, 0 in a solid one. Trilinear, it is the share that is free.
//   words    the same as bits: word x / 32 of row (y, z), rows one after the other, x fastest; bit x % 32 is 1
//            where it is solid. Bits beyond the end of a row are 0.
//
// A texel stands for a cube of voxels where a level has too many for one each. It is solid when at least half as
// many of its voxels are as a wall of one voxel across the texel takes.
#ifndef BRUME_SOLID_VOLUME_H
#define BRUME_SOLID_VOLUME_H
#include "shared/shim.h"
SHARED_BEGIN

/// Where the texels lie.
struct SolidLayout {
  vec3 origin_world;  // low corner of texel (0, 0, 0) [m]
  float texel_size;   // [m]
  ivec3 size;         // texels
};
SHARED_SIZE(SolidLayout, 28);

/// How much of both ends of a way from one surface to another does not count as blocked [texels]: a texel's longest way.
SHARED_CONST float kSolidEnds = 1.7320508f;

/// Words of a row of texels.
SHARED_FUNCTION int solid_row_words(int texels_x) {
  return (texels_x + 31) / 32;
}

SHARED_END
#endif
