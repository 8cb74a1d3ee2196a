#include "passes/resolve.hpp"

#include "brume_shaders.hpp"
#include "shared/gbuffer.h"
#include "shared/resolve.h"

namespace brume::passes {
ResolvePass::ResolvePass(gpu::Context& context)
    : ends_(context, shaders::ray_ends_comp),
      select_(context, shaders::march_select_comp),
      resolve_(context, shaders::resolve_comp),
      nearest_(context, {VK_FILTER_NEAREST}) {}

void ResolvePass::record_ends(gpu::Recorder& recorder, const Frame& frame, const gpu::Image& depth,
                              const MarchTiles& tiles) const {
  recorder.bind(ends_, {{shared::kBindFrame, gpu::uniform(frame.constants)},
                        {shared::kBindDepth, gpu::sampled(depth, nearest_)},
                        {shared::kBindRayEnds, gpu::write(tiles.ends)}});
  const glm::uvec2 count = shared::tiles_of(frame.size_px, tiles.scale);
  recorder.dispatch_threads(ends_, count.x, count.y);
}

void ResolvePass::upload(gpu::Recorder& recorder, const MarchTiles& tiles) {
  const shared::MarchList empty{{0, 0, 1}, 0};
  recorder.upload(tiles.list, 0, std::as_bytes(std::span(&empty, 1)));
}

void ResolvePass::record_select(gpu::Recorder& recorder, const Frame& frame, const gpu::Image& emission,
                                const MarchTiles& tiles) const {
  recorder.bind(select_, {
                             {shared::kBindFrame, gpu::uniform(frame.constants)},
                             {shared::kBindRayEnds, gpu::read(tiles.ends)},
                             {shared::kBindSmokeNear, gpu::sampled(tiles.near, nearest_)},
                             {shared::kBindSmokeFar, gpu::sampled(tiles.far, nearest_)},
                             {shared::kBindEmission, gpu::sampled(emission, nearest_)},
                             {shared::kBindMarchList, gpu::read_write(tiles.list)},
                         });
  const glm::uvec2 count = shared::tiles_of(frame.size_px, tiles.scale);
  recorder.dispatch_threads(select_, count.x, count.y);
}

void ResolvePass::record(gpu::Recorder& recorder, const Frame& frame, const gpu::Image& depth,
                         const MarchTiles& tiles, const gpu::Image& smoke) const {
  recorder.bind(resolve_, {
                              {shared::kBindFrame, gpu::uniform(frame.constants)},
                              {shared::kBindDepth, gpu::sampled(depth, nearest_)},
                              {shared::kBindRayEnds, gpu::read(tiles.ends)},
                              {shared::kBindSmokeNear, gpu::sampled(tiles.near, nearest_)},
                              {shared::kBindSmokeFar, gpu::sampled(tiles.far, nearest_)},
                              {shared::kBindSmoke, gpu::stored(smoke)},
                          });
  recorder.dispatch_threads(resolve_, frame.size_px.x, frame.size_px.y);
}

}  // namespace brume::passes
