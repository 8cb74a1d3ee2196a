// Light of what glows in a volume, in the volume itself (docs/guides/volumes.md): what arrives
// straight, along kSkyDirections rays through a cube of cells over the volume's bounds, and what has been scattered
// before, by the diffusion equation with a limit of flux.
//
//   matter    per cell rgb: radiance that a metre emits; a: extinction [1/m]
//   albedo    per cell rgb: single-scattering albedo
//   swept     per direction a cube along x, rgb: radiance that travels along it, times the direction's weight
//   cells     per level and cell a GlowCell
//   state     per level and cell rgb: mean radiance that has been scattered, while it is solved for
//   field     two cubes along x, per volume along z. rgb: mean radiance over all directions that arrives straight; that
//             has been scattered
//
// One volume after the other uses all but the field.
#ifndef BRUME_GLOW_FIELD_H
#define BRUME_GLOW_FIELD_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindGlowMatter, 107u);
SHARED_BINDING(kBindGlowAlbedo, 108u);
SHARED_BINDING(kBindGlowMatterTarget, 109u);
SHARED_BINDING(kBindGlowAlbedoTarget, 110u);
SHARED_BINDING(kBindGlowSwept, 111u);
SHARED_BINDING(kBindGlowState, 112u);
SHARED_BINDING(kBindGlowField, 113u);
SHARED_BINDING(kBindGlowFieldTarget, 114u);
SHARED_BINDING(kBindGlowCells, 115u);

/// Cubes of the field.
SHARED_CONST uint kGlowStraight = 0u;
SHARED_CONST uint kGlowScattered = 1u;
/// Cells of a volume's cube along an axis.
SHARED_CONST uint kGlowEdge = 32u;
/// Threads of a slice along each of its axes.
SHARED_CONST uint kGlowThreads = 16u;
/// Levels of cells, each of half as many along an axis. Each begins with the solution of the coarser one, so that light
/// spreads far in few iterations.
SHARED_CONST uint kGlowLevels = 3u;
/// Cells of all levels.
SHARED_CONST uint kGlowCells = 37376u;
/// The first cell of a level.
SHARED_FUNCTION uint first_glow_cell(uint level) {
  return level == 0u ? 0u : level == 1u ? 32768u : 36864u;
}
/// Times that all cells of a level are solved for.
SHARED_FUNCTION uint glow_iterations(uint level) {
  return level == 0u ? 8u : level == 1u ? 12u : 20u;
}

/// What diffusing light meets in a cell, per metre.
struct GlowCell {
  PackedVec3 transport;   // extinction less what is scattered straight on
  PackedVec3 absorption;
  PackedVec3 source;      // what arrives straight and is scattered
};
SHARED_SIZE(GlowCell, 36);

struct GlowFieldParams {
  uint volume;  // in view
  uint level;
  uint parity;  // of the coordinates' sum: the cells that are solved for first
  uint steps;   // how often; then the others, in turn. Above 1 where one workgroup solves for all
};
SHARED_SIZE(GlowFieldParams, 16);

SHARED_END
#endif
