// Which holes reach where, so that nobody asks holes that are elsewhere, however many there are.
//
//   coarse_tile_holes   a mask of all holes for each tile of 4 x 4 groups of 8 x 8 pixels: those that may meet it, 32 a word
//   hole_lists   for rays from the eye, first a word for each group: 0, where its block is, or kTestAllHoles. A block has
//                for each of kHoleSlices slices of distance from the eye 0 or where its list is, and where the group's
//                next block is, asked only where the word has kMoreChunks. A list: the holes that a ray of the
//                group may meet there, rising, two of 16 bits a word, the lower first; kLastInSlice ends it
//   hole_cells   for light: a uint per slot, 0 or block + 1; from cells_at on, per block of a brick 16^3 cells of half a
//                voxel, x + 16 (y + 16 z): what the holes leave of the smoke in it on average, as -log2 in steps of
//                1 / kHoleCellStep; sums of what each hole leaves, so that their order does not matter
#ifndef BRUME_OPEN_HOLES_H
#define BRUME_OPEN_HOLES_H
#include "shared/shim.h"
SHARED_BEGIN

/// How the march finds holes: there are none; by the lists of its rays; or every sample asks all.
SHARED_CONST uint kHolesNone = 0u;
SHARED_CONST uint kHolesClustered = 1u;
SHARED_CONST uint kHolesAllTested = 2u;

/// Most holes that are drawn at a time.
SHARED_CONST uint kMaxHoles = 16384u;
SHARED_CONST uint kHoleTilePixels = 8u;
SHARED_CONST uint kCoarseTileTiles = 4u;  // along an axis
SHARED_CONST uint kHoleSlices = 32u;
SHARED_CONST uint kChunkWords = kHoleSlices + 1u;
SHARED_CONST uint kMoreChunks = 0x80000000u;
SHARED_CONST uint kLastInSlice = 0x8000u;
/// A group for which there was no room: its rays ask all holes.
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

/// What the passes that make the cells need besides.
struct HoleCellsParams {
  uint slot_count;
  uint pair_capacity;
  uint block_capacity;
};
SHARED_SIZE(HoleCellsParams, 12);

/// What is counted: pairs of a brick and a hole that reaches it, and bricks that any reaches.
struct HoleCounters {
  uint pairs;
  uint blocks;
};
SHARED_SIZE(HoleCounters, 8);

SHARED_END
#endif
