// The level as indirect light knows it: free cells, and the pieces of surface between free and solid ones.
#pragma once

#include <cstdint>
#include <vector>

#include "planning/frame_input.hpp"
#include "shared/indirect_light.h"
#include "surfaces/surfaces.hpp"

namespace brume::surfaces {

/// The most cells of a level, and along an axis; larger levels have cells of several voxels.
constexpr std::uint32_t kMaxLightCells = 1u << 17;
constexpr int kMaxLightCellsPerAxis = 256;

/// What is uploaded of a level (shared/indirect_light.h).
struct LightCells {
  shared::IndirectLayout layout{};  ///< Without its bounces.
  std::vector<std::uint32_t> probes;
  std::vector<shared::SurfacePatch> patches;
  std::vector<std::uint32_t> hits;
  std::vector<shared::EmitterSample>
      emitter_samples;  ///< Empty: there are no small emitters, nor rays to them.
  std::vector<shared::EmitterRay> emitter_rays;
};

/// The cells of a level with a grid. Free are the cells of voxel::coarse_solid, but not those inside of
/// closed objects, from where most rays meet surfaces from behind. Patches are what rays from free cells meet
/// in solid ones: the means of four points each; a grey wall on the face where they meet nothing. Rays of
/// probes meet the surfaces themselves, not the cells, so that gaps narrower than a voxel let light through,
/// and pass what is not voxelized.
/// The same for any number of threads.
LightCells make_light_cells(const voxel::BitGrid& grid, const Surfaces& surfaces);

}  // namespace brume::surfaces
