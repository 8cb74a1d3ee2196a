// Holes of the frame in rows of 16 bytes: six loads per hole, two for a wide open cylinder (shared/hole.h).
#ifndef PACKED_HOLES_GLSL
#define PACKED_HOLES_GLSL
#include "shared/hole.h"
#include "shared/hole_clusters.h"

layout(binding = kBindHoles) readonly buffer Holes { PackedHole packed_holes[]; };

Hole hole_at(uint i) { return unpack_hole(packed_holes[i]); }

#endif
