#include "render/parts/motion.hpp"

namespace brume::render {

void MotionPart::record(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                        const gpu::Buffer& entries) const {
  scope(recorder, "motion", [&] {
    pass_->record(recorder, {in.frame, in.surfaces, in.targets.media, entries, plan.size_px}, plan.past,
                  plan.input.view.sample.pixel);
  });
}

}  // namespace brume::render
