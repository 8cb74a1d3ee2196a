#include "passes/tank.hpp"

#include "brume_shaders.hpp"
#include "shared/average.h"
#include "shared/display.h"
#include "shared/noise.h"

namespace brume::passes {
namespace {

/// Calls `bind` with the surfaces of a frame, where the tank is over them.
template <typename Bind>
void with_surfaces(const TankTargets& targets, Bind bind) {
  if (!targets.surfaces) return bind();
  bind(gpu::BoundResource{shared::kBindTankSurfaces, gpu::read_write_stored(*targets.surfaces)});
}

}  // namespace

TankSpheresPass::TankSpheresPass(gpu::Context& context)
    : context_(context), nearest_(context, {VK_FILTER_NEAREST}) {}

const gpu::ComputePipeline& TankSpheresPass::pipeline(const TankVolume& volume, bool over_surfaces) {
  const std::uint32_t opaque = volume.is_opaque ? 1u : 0u, wide = volume.wide_ids ? 1u : 0u,
                      ids = volume.has_ids ? 1u : 0u;
  auto& made = pipelines_[(over_surfaces ? 8 : 0) + 4 * opaque + 2 * wide + ids];
  if (!made)
    made.emplace(context_, over_surfaces ? shaders::tank_spheres_over_comp : shaders::tank_spheres_comp,
                 std::vector{opaque, wide, ids});
  return *made;
}

void TankSpheresPass::record(gpu::Recorder& recorder, const TankInputs& inputs, const TankTargets& targets,
                             const shared::TankSamples& samples, std::uint32_t rows) {
  const gpu::ComputePipeline& used = pipeline(inputs.volume, targets.surfaces != nullptr);
  const auto bind = [&](auto... surfaces) {
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
                   {shared::kBindRadiance, gpu::stored(targets.radiance)},
                   surfaces...},
                  samples);
  };
  with_surfaces(targets, bind);
  recorder.dispatch_threads(used, targets.sum.info().size.x, rows);
}

TankVoxelsPass::TankVoxelsPass(gpu::Context& context)
    : context_(context), nearest_(context, {VK_FILTER_NEAREST}) {}

const gpu::ComputePipeline& TankVoxelsPass::pipeline(bool over_surfaces) {
  auto& made = pipelines_[over_surfaces ? 1 : 0];
  if (!made)
    made.emplace(context_, over_surfaces ? shaders::tank_voxels_over_comp : shaders::tank_voxels_comp);
  return *made;
}

void TankVoxelsPass::record(gpu::Recorder& recorder, const TankInputs& inputs, const gpu::Image& voxel_light,
                            const TankTargets& targets, const shared::TankSamples& samples,
                            std::uint32_t rows) {
  const gpu::ComputePipeline& used = pipeline(targets.surfaces != nullptr);
  const auto bind = [&](auto... surfaces) {
    recorder.bind(used,
                  {{shared::kBindTank, gpu::read(inputs.constants)},
                   {shared::kBindSphereBricks, gpu::read(inputs.volume.brick_ranges)},
                   {shared::kBindVoxelColors, gpu::sampled(inputs.volume.colors, nearest_)},
                   {shared::kBindVoxelLight, gpu::sampled(voxel_light, nearest_)},
                   {shared::kBindBlueNoise, gpu::sampled(inputs.blue_noise, nearest_)},
                   {shared::kBindRadianceSum, gpu::read_write_stored(targets.sum)},
                   {shared::kBindRadiance, gpu::stored(targets.radiance)},
                   surfaces...},
                  samples);
  };
  with_surfaces(targets, bind);
  recorder.dispatch_threads(used, targets.sum.info().size.x, rows);
}

}  // namespace brume::passes
