// The level as indirect light knows it: cells, and the pieces of surface between free and solid ones.
#pragma once

#include <cstdint>
#include <vector>

#include "planning/frame_input.hpp"
#include "reference/surfaces.hpp"
#include "shared/indirect_light.h"

namespace brume::reference {

/// The most cells of a level; larger levels have cells of several voxels.
constexpr std::uint32_t kMaxLightCells = 1u << 17;

struct LightCells {
  shared::IndirectLayout layout{};            ///< Without its bounces.
  std::vector<std::uint32_t> cells;           ///< As shared/indirect_light.h has them.
  std::vector<shared::SurfacePatch> patches;  ///< In the order of their cells, then of their faces.
  std::vector<std::uint32_t> probes;          ///< Rising.
  std::vector<std::uint32_t> hits;            ///< Of the rays of all probes.
};

/// Voxels per edge of a cell: the smallest number for which a level has at most kMaxLightCells.
int voxels_per_light_cell(glm::ivec3 voxels);

/// The cells of a level with a grid. Patches are what rays from free cells meet in solid ones: the means of
/// four points each; a grey wall on the face where they meet nothing. Rays of probes meet the surfaces
/// themselves, not the cells, so that gaps narrower than a voxel let light through. The same for any number
/// of threads.
LightCells make_light_cells(const voxel::BitGrid& grid, const Surfaces& surfaces);

}  // namespace brume::reference
