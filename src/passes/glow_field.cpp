#include "passes/glow_field.hpp"

#include <algorithm>

#include "brume_shaders.hpp"
#include "shared/frame.h"
#include "shared/sky_light.h"

namespace brume::passes {
namespace {

/// What the pipelines of the cells differ by.
constexpr std::uint32_t kCellsMedia =
    shared::kMediaOfAlbedos | shared::kMediumVolumeDetail | shared::kMediumHeat | shared::kMediumMasks;
constexpr std::uint32_t kEdge = shared::kGlowEdge;

/// Cubes, `along_x` and `along_z` of them.
gpu::Image cubes(gpu::Context& context, std::uint32_t along_x, std::uint32_t along_z) {
  return gpu::Image(context, gpu::storage_image_3d({kEdge * along_x, kEdge, kEdge * along_z},
                                                   VK_FORMAT_R16G16B16A16_SFLOAT));
}

}  // namespace

GlowFieldPass::GlowFieldPass(gpu::Context& context)
    : context_(context),
      linear_(context, {}),
      sweep_pipeline_(context, shaders::glow_sweep_comp),
      gather_pipeline_(context, shaders::glow_gather_comp),
      coarsen_pipeline_(context, shaders::glow_coarsen_comp),
      refine_pipeline_(context, shaders::glow_refine_comp),
      diffuse_pipeline_(context, shaders::glow_diffuse_comp),
      store_pipeline_(context, shaders::glow_store_comp),
      field_(cubes(context, 1, 1)) {}

std::uint32_t GlowFieldPass::room() const {
  const glm::uvec3 size = field_.info().size;
  return size.x == 2 * kEdge ? size.z / kEdge : 0;
}

void GlowFieldPass::reserve(std::span<const planning::PlacedVolume> in_view, std::uint32_t casters) {
  if (std::ranges::none_of(in_view, [](const auto& volume) { return shared::glows(volume.instance); }))
    return;
  const std::uint32_t media = casters & kCellsMedia;
  if (!cells_pipelines_.contains(media))
    cells_pipelines_.try_emplace(media, context_, shaders::glow_cells_comp, std::vector{media});
  if (!swept_) {
    // All of them or none: where memory was refused, another try makes all.
    gpu::Image matter = cubes(context_, 1, 1), albedo = cubes(context_, 1, 1);
    gpu::Buffer cells(context_, VkDeviceSize{shared::kGlowCells} * sizeof(shared::GlowCell),
                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    gpu::Buffer state(context_, VkDeviceSize{shared::kGlowCells} * sizeof(glm::vec3),
                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    swept_ = cubes(context_, shared::kSkyDirections, 1);
    matter_ = std::move(matter);
    albedo_ = std::move(albedo);
    cells_ = std::move(cells);
    state_ = std::move(state);
  }
  const auto count = static_cast<std::uint32_t>(in_view.size());
  if (room() < count) field_ = cubes(context_, 2, count);
}

void GlowFieldPass::record(gpu::Recorder& recorder, const Inputs& in) const {
  for (std::uint32_t i = 0; i < in.in_view.size(); ++i)
    if (shared::glows(in.in_view[i].instance)) record_volume(recorder, in, i);
}

void GlowFieldPass::record_volume(gpu::Recorder& recorder, const Inputs& in, std::uint32_t volume) const {
  const shared::GlowFieldParams params{volume, 0, 0, 0};
  record_cells(recorder, in, params);
  recorder.bind(sweep_pipeline_, {in.volumes.bindings()},
                {
                    {shared::kBindGlowMatter, gpu::sampled(matter_, linear_)},
                    {shared::kBindGlowSwept, gpu::stored(swept_)},
                },
                params);
  recorder.dispatch_threads(sweep_pipeline_, shared::kGlowThreads * shared::kSkyDirections,
                            shared::kGlowThreads);
  recorder.bind(gather_pipeline_, {in.volumes.bindings()},
                {
                    {shared::kBindGlowMatter, gpu::sampled(matter_, linear_)},
                    {shared::kBindGlowAlbedo, gpu::sampled(albedo_, linear_)},
                    {shared::kBindGlowSwept, gpu::sampled(swept_, linear_)},
                    {shared::kBindGlowCells, gpu::write(cells_)},
                    {shared::kBindGlowFieldTarget, gpu::stored(field_)},
                },
                params);
  recorder.dispatch_threads(gather_pipeline_, kEdge, kEdge, kEdge);
  record_diffusion(recorder, in, volume);
}

void GlowFieldPass::record_cells(gpu::Recorder& recorder, const Inputs& in,
                                 const shared::GlowFieldParams& params) const {
  const gpu::ComputePipeline& pipeline = cells_pipelines_.at(in.casters & kCellsMedia);
  recorder.bind(pipeline, {in.volumes.bindings()},
                {
                    {shared::kBindGlowMatterTarget, gpu::stored(matter_)},
                    {shared::kBindGlowAlbedoTarget, gpu::stored(albedo_)},
                },
                params);
  recorder.dispatch_threads(pipeline, kEdge, kEdge, kEdge);
}

void GlowFieldPass::record_diffusion(gpu::Recorder& recorder, const Inputs& in, std::uint32_t volume) const {
  for (std::uint32_t level = 1; level < shared::kGlowLevels; ++level)
    record_coarsening(recorder, {volume, level, 0, 0});
  recorder.fill(state_, 0);
  for (std::uint32_t level = shared::kGlowLevels; level-- > 0;) {
    if (level + 1 < shared::kGlowLevels) record_refinement(recorder, {volume, level, 0, 0});
    record_level(recorder, in, volume, level);
  }
  recorder.bind(store_pipeline_,
                {
                    {shared::kBindGlowState, gpu::read(state_)},
                    {shared::kBindGlowFieldTarget, gpu::stored(field_)},
                },
                shared::GlowFieldParams{volume, 0, 0, 0});
  recorder.dispatch_threads(store_pipeline_, kEdge, kEdge, kEdge);
}

void GlowFieldPass::record_coarsening(gpu::Recorder& recorder, const shared::GlowFieldParams& params) const {
  recorder.bind(coarsen_pipeline_, {{shared::kBindGlowCells, gpu::read_write(cells_)}}, params);
  const std::uint32_t edge = kEdge >> params.level;
  recorder.dispatch_threads(coarsen_pipeline_, edge, edge, edge);
}

void GlowFieldPass::record_refinement(gpu::Recorder& recorder, const shared::GlowFieldParams& params) const {
  recorder.bind(refine_pipeline_, {{shared::kBindGlowState, gpu::read_write(state_)}}, params);
  const std::uint32_t edge = kEdge >> params.level;
  recorder.dispatch_threads(refine_pipeline_, edge, edge, edge);
}

void GlowFieldPass::record_level(gpu::Recorder& recorder, const Inputs& in, std::uint32_t volume,
                                 std::uint32_t level) const {
  const std::uint32_t edge = kEdge >> level, steps = 2 * shared::glow_iterations(level);
  // One workgroup holds the coarsest level, and synchronizes its steps itself.
  const std::uint32_t together = level + 1 == shared::kGlowLevels ? steps : 1;
  for (std::uint32_t step = 0; step < steps; step += together) {
    recorder.bind(diffuse_pipeline_, {in.volumes.bindings()},
                  {
                      {shared::kBindGlowCells, gpu::read(cells_)},
                      {shared::kBindGlowState, gpu::read_write(state_)},
                  },
                  shared::GlowFieldParams{volume, level, step & 1, together});
    recorder.dispatch_threads(diffuse_pipeline_, edge / 2, edge, edge);
  }
}

}  // namespace brume::passes
