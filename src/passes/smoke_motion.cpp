#include "passes/smoke_motion.hpp"

#include "brume_shaders.hpp"
#include "shared/frame.h"
#include "shared/gbuffer.h"
#include "shared/resolve.h"

namespace brume::passes {

SmokeMotionPass::SmokeMotionPass(gpu::Context& context, glm::uvec2 size_px)
    : pipeline_(context, shaders::smoke_motion_comp),
      nearest_(context, {VK_FILTER_NEAREST}),
      motion_(context, gpu::storage_image(size_px, VK_FORMAT_R16G16B16A16_SFLOAT)) {}

void SmokeMotionPass::record(gpu::Recorder& recorder, const Inputs& in,
                             const std::optional<planning::PastView>& past, glm::vec2 jitter_px) const {
  const planning::PastView to = past.value_or(planning::PastView());
  recorder.bind(pipeline_,
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindDepth, gpu::sampled(in.depth, nearest_)},
                    {shared::kBindSmoke, gpu::sampled(in.smoke, nearest_)},
                    {shared::kBindMotionEntries, gpu::read(in.entries)},
                    {shared::kBindSmokeMotion, gpu::stored(motion_)},
                },
                shared::SmokeMotionParams{to.unjittered_from_world, jitter_px, past ? 1u : 0u});
  recorder.dispatch_threads(pipeline_, in.size_px.x, in.size_px.y);
}

}  // namespace brume::passes
