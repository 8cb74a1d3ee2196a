#include "render/parts/motion.hpp"

#include "planning/device_camera.hpp"

namespace brume::render {

void MotionPart::resize(glm::uvec2 size_px) {
  pass_.emplace(context_, size_px);
  pasts_.change(context_) = {};
}

void MotionPart::record(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                        const gpu::Buffer& entries) {
  const planning::View& view = plan.input.view;
  std::optional<glm::mat4>& past = recorder.change(pasts_)[view.index];
  if (!view.continues) past.reset();
  scope(recorder, "motion", [&] {
    pass_->record(recorder, {in.frame, in.surfaces, in.targets.media, entries, plan.size_px}, past,
                  view.sample.pixel);
  });
  past = planning::device_camera(view.camera, plan.size_px).clip_from_world;
}

}  // namespace brume::render
