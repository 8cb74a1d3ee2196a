// Which holes reach where: what lets a sample of a ray meet only the holes around it, however many there are.
//
//   hole_grid    one uint buffer:
//                  [slot]                     block + 1 of the slot's brick; 0: no hole there; kHolesEverywhere
//                  [cells_at + 2 c]           first entry of cell c, and the number of its entries:
//                                             c = 4096 block + x + 16 (y + 16 z), a cell is half a voxel wide
//                  [entries_at + e]           a hole, rising within a cell
//
// The first `wide_count` holes are in no list: every sample asks them. They are those that reach too many cells.
#ifndef BRUME_HOLE_GRID_H
#define BRUME_HOLE_GRID_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST int kHoleCellsPerVoxel = 2;
SHARED_CONST int kHoleCellsPerEdge = 16;  // of a brick
SHARED_CONST uint kHoleCellsPerBlock = 4096u;
/// A slot for which there was no room: its samples ask all holes.
SHARED_CONST uint kHolesEverywhere = 0xffffffffu;

/// Where the parts of the grid lie.
struct HoleGridFrame {
  uint hole_count;
  uint wide_count;
  uint cells_at;
  uint entries_at;
};
SHARED_SIZE(HoleGridFrame, 16);

/// What the passes that make the grid need besides.
struct HoleGridParams {
  uint slot_count;
  uint pair_capacity;
  uint block_capacity;
};
SHARED_SIZE(HoleGridParams, 12);

/// What they count.
struct HoleGridCounters {
  uint pairs;
  uint blocks;
  uint entries;
};
SHARED_SIZE(HoleGridCounters, 12);

SHARED_END
#endif
