// Which holes reach where, so that nobody asks holes that are elsewhere, however many there are.
//
//   hole_tiles   for rays from the eye: per tile of 64 x 64 pixels one bit a hole, tile_words uints; bit i & 31 of
//                word i / 32 is set where a ray of the tile may meet hole i
//   hole_cells   for light: a uint per slot, 0 or block + 1; from cells_at on, per block of a brick 16^3 cells of half a
//                voxel, x + 16 (y + 16 z): what the holes leave of the smoke in it on average, as -log2 in steps of
//                1 / kHoleCellStep; sums of what each hole leaves, so that their order does not matter
#ifndef BRUME_OPEN_HOLES_H
#define BRUME_OPEN_HOLES_H
#include "shared/shim.h"
SHARED_BEGIN

/// How the march finds holes: there are none; by the lists of its rays; or every sample asks all.
SHARED_CONST uint kHolesNone = 0u;
SHARED_CONST uint kHolesListed = 1u;
SHARED_CONST uint kHolesAllAsked = 2u;

/// Most holes that are drawn at a time.
SHARED_CONST uint kMaxHoles = 16384u;
SHARED_CONST uint kHoleTilePixels = 64u;

SHARED_CONST int kHoleCellsPerVoxel = 2;
SHARED_CONST int kHoleCellsPerEdge = 16;  // of a brick
SHARED_CONST uint kHoleCellsPerBlock = 4096u;
SHARED_CONST float kHoleCellStep = 4096.0f;

struct OpenHolesFrame {
  uint count;
  uint tiles_across;
  uint tile_words;
  uint cells_at;
};
SHARED_SIZE(OpenHolesFrame, 16);

/// What the passes that make the cells need besides.
struct HoleCellsParams {
  uint slot_count;
  uint pair_capacity;
  uint block_capacity;
};
SHARED_SIZE(HoleCellsParams, 12);

/// What they count: pairs of a brick and a hole that reaches it, and bricks that any reaches.
struct HoleCellsCounters {
  uint pairs;
  uint blocks;
};
SHARED_SIZE(HoleCellsCounters, 8);

SHARED_END
#endif
