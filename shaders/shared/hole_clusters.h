// Culling of holes: a sample tests only holes that reach it, however many holes there are.
//
//   holes        PackedHole (hole.h), all holes of the frame
//   reaches      PackedReach (hole_reach.h), one per hole
//   coarse_tile_holes
//                per coarse tile of 4 x 4 tiles of 8 x 8 pixels a mask of the holes that may meet it, 32 per word
//   hole_lists   clusters for rays from the eye. First a word per tile: 0, the index of its chunk, or kTestAllHoles. A
//                chunk has for each of kHoleSlices slices of distance from the eye 0 or the index of its list, and the
//                index of the tile's next chunk, valid only where the word has kMoreChunks. A list: the holes that a
//                ray of the tile may meet in the slice, ascending, two of 16 bits per word, low half first;
//                kLastInSlice ends it
//   hole_cells   for rays to lights. A uint per slot, 0 or chunk + 1; from cells_at, per chunk 16^3 cells of half a
//                voxel, x + 16 (y + 16 z): the mean fraction of the smoke that the holes leave, as -log2 in steps of
//                1 / kHoleCellStep. Holes add up there, so their order does not matter
#ifndef BRUME_HOLE_CLUSTERS_H
#define BRUME_HOLE_CLUSTERS_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindHoles, 11u);
SHARED_BINDING(kBindHoleReaches, 12u);
SHARED_BINDING(kBindHoleMasks, 13u);
SHARED_BINDING(kBindHoleLists, 14u);
SHARED_BINDING(kBindHoleCells, 15u);
SHARED_BINDING(kBindCoarseTileHoles, 32u);
SHARED_BINDING(kBindHoleWordsTaken, 33u);
SHARED_BINDING(kBindHolePairs, 34u);
SHARED_BINDING(kBindHoleCounters, 35u);

/// How the march finds holes: there are none; by the clusters of its rays; or every sample tests all.
SHARED_CONST uint kHolesNone = 0u;
SHARED_CONST uint kHolesClustered = 1u;
SHARED_CONST uint kHolesAllTested = 2u;

/// Upper limit of the holes in a frame.
SHARED_CONST uint kMaxHoles = 16384u;
SHARED_CONST uint kHoleTilePixels = 8u;
SHARED_CONST uint kCoarseTileTiles = 4u;  // along an axis
SHARED_CONST uint kHoleSlices = 32u;
SHARED_CONST uint kChunkWords = kHoleSlices + 1u;
SHARED_CONST uint kMoreChunks = 0x80000000u;
SHARED_CONST uint kLastInSlice = 0x8000u;
/// A tile whose lists did not fit: its rays test all holes.
SHARED_CONST uint kTestAllHoles = 0xffffffffu;

SHARED_CONST int kHoleCellsPerVoxel = 2;
SHARED_CONST int kHoleCellsPerEdge = 16;  // of a brick
SHARED_CONST uint kHoleCellsPerChunk = 4096u;
SHARED_CONST float kHoleCellStep = 4096.0f;

struct HoleClusterLayout {
  uint count;
  uint tiles_across;
  uint entries_at;
  uint cells_at;
};
SHARED_SIZE(HoleClusterLayout, 16);

struct HoleListsParams {
  uint entry_capacity;
};
SHARED_SIZE(HoleListsParams, 4);

/// Parameters of the passes that fill the cells.
struct HoleCellsParams {
  uint slot_count;
  uint pair_capacity;
  uint block_capacity;
};
SHARED_SIZE(HoleCellsParams, 12);

/// Counters: pairs of a brick and a hole that reaches it, and bricks that any hole reaches.
struct HoleCounters {
  uint pairs;
  uint blocks;
};
SHARED_SIZE(HoleCounters, 8);

SHARED_END
#endif
