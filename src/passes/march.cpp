#include "passes/march.hpp"

#include "brume_shaders.hpp"
#include "shared/gbuffer.h"
#include "shared/light_side.h"
#include "shared/noise.h"

namespace brume::passes {

namespace {

gpu::Image tile_image(gpu::Context& context, glm::uvec2 tiles) {
  return gpu::Image(context, gpu::storage_image(tiles, VK_FORMAT_R16G16B16A16_SFLOAT));
}

gpu::Buffer tile_buffer(gpu::Context& context, glm::uvec2 tiles, std::size_t head, std::size_t per_tile) {
  return {context, head + per_tile * tiles.x * tiles.y,
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
              VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT};
}

std::uint32_t counts_of(const MarchPass::Options& options) {
  return options.record_entries  ? shared::kCountEntries
         : options.count_steps   ? shared::kCountSteps
         : options.count_samples ? shared::kCountSamples
                                 : shared::kCountNothing;
}

}  // namespace

MarchTiles::MarchTiles(gpu::Context& context, glm::uvec2 size_px, std::uint32_t edge)
    : ends(tile_buffer(context, shared::tiles_of(size_px, edge), 0, sizeof(shared::RayEnds))),
      near(tile_image(context, shared::tiles_of(size_px, edge))),
      far(tile_image(context, shared::tiles_of(size_px, edge))),
      list(tile_buffer(context, shared::tiles_of(size_px, edge), sizeof(shared::MarchList),
                       sizeof(std::uint32_t))),
      scale(edge) {}

MarchPass::MarchPass(gpu::Context& context, const Options& options)
    : context_(context),
      options_(options),
      linear_(context, {}),
      repeat_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT}),
      repeat_mips_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT, true}),
      nearest_(context, {VK_FILTER_NEAREST}) {
  if (options.media != 0) reserve(options.media);
}

/// The kind of kHoles of march_main.glsl that frames with holes need.
std::uint32_t MarchPass::with_holes(std::uint32_t media) const {
  if ((media & shared::kMediaWithHoles) == 0) return shared::kHolesNone;
  return options_.brute_force_holes ? shared::kHolesAllTested : shared::kHolesClustered;
}

std::uint32_t MarchPass::holes_of(const Inputs& in) const {
  return in.media.holes.any ? with_holes(in.media.set) : shared::kHolesNone;
}

void MarchPass::reserve(std::uint32_t media, MarchRays rays) {
  const gpu::Tuning& tuning = context_.tuning();
  const bool several = (media & shared::kMediumSeveral) != 0;
  const gpu::ShaderCode& code = several ? shaders::march_several_comp : shaders::march_comp;

  // A frame marches pixels; or tiles, and then the pixels of listed tiles. It may have holes or none.
  for (const std::uint32_t kind : {shared::kRaysOfPixels, shared::kRaysOfTiles, shared::kRaysOfList}) {
    if (rays == (kind == shared::kRaysOfPixels ? MarchRays::of_tiles : MarchRays::of_pixels)) continue;
    for (const std::uint32_t holes : {shared::kHolesNone, with_holes(media)}) {
      if (pipelines_.contains({kind, holes, media})) continue;
      pipelines_.try_emplace({kind, holes, media}, context_, code,
                             std::vector{counts_of(options_), kind, holes, media, tuning.march_block_steps,
                                         tuning.split_march_by_holes ? 1u : 0u});
    }
  }
}

void MarchPass::dispatch(gpu::Recorder& recorder, std::uint32_t kind, const Inputs& in, const Rays& rays,
                         glm::uvec2 ray_count, const gpu::Buffer& counters) const {
  const auto dispatch_one = [&](std::uint32_t holes) {
    const gpu::ComputePipeline& pipeline = pipelines_.at({kind, holes, in.media.set});
    bind(recorder, pipeline, in, rays, counters);
    recorder.dispatch_threads(pipeline, ray_count.x, ray_count.y);
  };
  const std::uint32_t holes = holes_of(in);

  // Split: one pipeline marches the tiles that holes meet, the other one the rest (is_of_other_pipeline).
  if (holes != shared::kHolesClustered || !context_.tuning().split_march_by_holes) return dispatch_one(holes);
  recorder.concurrently([&] {
    dispatch_one(holes);
    dispatch_one(shared::kHolesNone);
  });
}

void MarchPass::record(gpu::Recorder& recorder, const Inputs& in, const gpu::Image& smoke,
                       const gpu::Buffer& counters) const {
  dispatch(recorder, shared::kRaysOfPixels, in, {in.frame, in.frame, smoke, smoke}, in.size_px, counters);
}

void MarchPass::record_tiles(gpu::Recorder& recorder, const Inputs& in, const MarchTiles& tiles,
                             const gpu::Buffer& counters) const {
  dispatch(recorder, shared::kRaysOfTiles, in, {tiles.ends, in.frame, tiles.near, tiles.far},
           shared::tiles_of(in.size_px, tiles.scale), counters);
}

void MarchPass::record_list(gpu::Recorder& recorder, const Inputs& in, const MarchTiles& tiles,
                            const gpu::Image& smoke, const gpu::Buffer& counters) const {
  const gpu::ComputePipeline& pipeline = pipelines_.at({shared::kRaysOfList, holes_of(in), in.media.set});
  bind(recorder, pipeline, in, {in.frame, tiles.list, smoke, smoke}, counters);
  recorder.dispatch_indirect(tiles.list);
}

void MarchPass::bind(gpu::Recorder& recorder, const gpu::ComputePipeline& pipeline, const Inputs& in,
                     const Rays& rays, const gpu::Buffer& counters) const {
  recorder.bind(pipeline, {in.media.bindings(), in.light.bindings(linear_)},
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindNoiseTile, gpu::sampled(in.noise, repeat_)},
                    {shared::kBindDetailTile, gpu::sampled(in.detail, repeat_mips_)},
                    {shared::kBindDepth, gpu::sampled(in.depth, nearest_)},
                    {shared::kBindBlueNoise, gpu::sampled(in.blue_noise, nearest_)},
                    {shared::kBindSmoke, gpu::stored(rays.smoke)},
                    {shared::kBindMarchCounters, gpu::read_write(counters)},
                    {shared::kBindRayEnds, gpu::read(rays.ends)},
                    {shared::kBindSmokeNear, gpu::stored(rays.near)},
                    {shared::kBindMarchList, gpu::read(rays.list)},
                });
}

}  // namespace brume::passes
