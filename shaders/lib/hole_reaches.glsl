// Bounds of the frame's holes (shared/hole_reach.h).
#ifndef HOLE_REACHES_GLSL
#define HOLE_REACHES_GLSL
#include "shared/hole_clusters.h"
#include "shared/hole_reach.h"

layout(binding = kBindHoleReaches) readonly buffer Reaches { PackedReach packed_reaches[]; };

HoleReach reach_at(uint i) { return unpack_reach(packed_reaches[i]); }

#endif
