#include "passes/tank.hpp"

#include "brume_shaders.hpp"
#include "shared/average.h"
#include "shared/display.h"
#include "shared/noise.h"

namespace brume::passes {

TankSpheresPass::TankSpheresPass(gpu::Context& context)
    : context_(context), nearest_(context, {VK_FILTER_NEAREST}) {}

const gpu::ComputePipeline& TankSpheresPass::pipeline(const TankVolume& volume) {
  const std::uint32_t opaque = volume.is_opaque ? 1u : 0u, wide = volume.wide_ids ? 1u : 0u,
                      ids = volume.has_ids ? 1u : 0u;
  auto& made = pipelines_[4 * opaque + 2 * wide + ids];
  if (!made) made.emplace(context_, shaders::tank_spheres_comp, std::vector{opaque, wide, ids});
  return *made;
}

void TankSpheresPass::record(gpu::Recorder& recorder, const TankInputs& inputs, const TankTargets& targets,
                             const shared::TankSamples& samples, std::uint32_t rows) {
  const gpu::ComputePipeline& used = pipeline(inputs.volume);
  recorder.bind(used,
                {{shared::kBindTank, gpu::read(inputs.constants)},
                 {shared::kBindTankLights, gpu::read(inputs.lights)},
                 {shared::kBindPhotons, gpu::read(inputs.photons)},
                 {shared::kBindPhotonCells, gpu::read(inputs.photon_cells)},
                 {shared::kBindSpheres, gpu::read(inputs.volume.spheres)},
                 {shared::kBindSphereColors, gpu::read(inputs.volume.sphere_colors)},
                 {shared::kBindSphereBricks, gpu::read(inputs.volume.brick_ranges)},
                 {shared::kBindSphereList, gpu::read(inputs.volume.brick_spheres)},
                 {shared::kBindVoxelIds, gpu::sampled(inputs.volume.ids, nearest_)},
                 {shared::kBindBlueNoise, gpu::sampled(inputs.blue_noise, nearest_)},
                 {shared::kBindRadianceSum, gpu::read_write_stored(targets.sum)},
                 {shared::kBindRadiance, gpu::stored(targets.radiance)}},
                samples);
  recorder.dispatch_threads(used, targets.sum.info().size.x, rows);
}

TankVoxelsPass::TankVoxelsPass(gpu::Context& context)
    : pipeline_(context, shaders::tank_voxels_comp), nearest_(context, {VK_FILTER_NEAREST}) {}

void TankVoxelsPass::record(gpu::Recorder& recorder, const TankInputs& inputs, const gpu::Image& voxel_light,
                            const TankTargets& targets, const shared::TankSamples& samples,
                            std::uint32_t rows) const {
  recorder.bind(pipeline_,
                {{shared::kBindTank, gpu::read(inputs.constants)},
                 {shared::kBindSphereBricks, gpu::read(inputs.volume.brick_ranges)},
                 {shared::kBindVoxelColors, gpu::sampled(inputs.volume.colors, nearest_)},
                 {shared::kBindVoxelLight, gpu::sampled(voxel_light, nearest_)},
                 {shared::kBindBlueNoise, gpu::sampled(inputs.blue_noise, nearest_)},
                 {shared::kBindRadianceSum, gpu::read_write_stored(targets.sum)},
                 {shared::kBindRadiance, gpu::stored(targets.radiance)}},
                samples);
  recorder.dispatch_threads(pipeline_, targets.sum.info().size.x, rows);
}

}  // namespace brume::passes
