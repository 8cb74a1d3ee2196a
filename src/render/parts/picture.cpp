#include "render/parts/picture.hpp"

#include "planning/device_camera.hpp"
#include "planning/device_lights.hpp"

namespace brume::render {
namespace {

bool has_debug_view(const FramePlan& plan) {
  return plan.input.debug.view != planning::DebugView::none;
}

passes::DebugSubject debug_subject(const FramePlan& plan) {
  const FrameInput& input = plan.input;
  return {input.debug.view, plan.view_slice, input.level.voxels, plan.smoke, input.smoke.state};
}

}  // namespace

void ParticlesPart::reserve(const FramePlan& plan) {
  if (plan.particles.empty()) return;
  if (!pass_) pass_.emplace(context_);
  pass_->reserve(plan.particles, plan.size_px, plan.input.debug.view == planning::DebugView::overdraw);
}

void ParticlesPart::record(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                           const SlicesPart& slices) const {
  if (plan.particles.empty()) return;
  const gpu::Scope timed(recorder, "particles");
  pass_->record(recorder, {in.frame, slices.image(), in.surfaces}, plan.particles, in.targets.radiance);
}

void ParticlesPart::record_overdraw(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                                    const SlicesPart& slices) const {
  recorder.clear(in.targets.radiance, {});
  if (plan.particles.empty()) return;
  pass_->record_overdraw(recorder, {in.frame, slices.image(), in.targets.gbuffer.depth}, plan.particles,
                         in.targets.radiance);
}

PicturePart::PicturePart(gpu::Context& context, glm::uvec2 size_px, const Options& options)
    : context_(context),
      size_px_(size_px),
      shading_displays_(context.tuning().shade_displays && !options.antialias && !options.has_panes),
      shade_pass_(context) {
  if (options.antialias) antialias_pass_.emplace(context, size_px);
  if (options.prepare_all)
    for (const bool voxel_shadows : {false, true})
      shade_pass_.reserve({.voxel_shadows = voxel_shadows, .display = shading_displays_});
}

void PicturePart::resize(glm::uvec2 size_px) {
  size_px_ = size_px;
  average_pass_.reset();
  if (antialias_pass_) antialias_pass_.emplace(context_, size_px);
}

passes::ShadePass::Needs PicturePart::shade_needs(const FramePlan& plan) const {
  return {.voxel_shadows = planning::has_voxel_shadows(plan.lights),
          .decals = !plan.decals.empty(),
          .display = shading_displays_ && plan.particles.empty() && plan.input.view.sample.count <= 1};
}

void PicturePart::reserve(const FramePlan& plan) {
  if (plan.input.view.sample.count > 1 && !average_pass_) average_pass_.emplace(context_, size_px_);
  if (has_debug_view(plan)) {
    if (!debug_view_) debug_view_.emplace(context_);
    debug_view_->reserve(debug_subject(plan), size_px_);
    return;
  }
  const passes::ShadePass::Needs needs = shade_needs(plan);
  shade_pass_.reserve(needs);
  if (!needs.display && !display_pass_) display_pass_.emplace(context_);
}

const gpu::Buffer* PicturePart::step_counters(const FramePlan& plan) const {
  return plan.input.debug.view == planning::DebugView::steps ? &debug_view_->counters() : nullptr;
}

bool PicturePart::record_shade(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                               const gpu::Image& layers, const gpu::Image* occlusion) const {
  const gpu::Scope timed(recorder, "shade");
  const passes::ShadePass::Needs needs = shade_needs(plan);
  const Targets& targets = in.targets;
  shade_pass_.record(recorder, needs,
                     {in.frame, in.scene, in.shadows, in.smoke_shadows, in.level, targets.gbuffer, layers,
                      in.blue_noise, occlusion},
                     {targets.radiance, targets.display});
  return needs.display;
}

void PicturePart::record_display(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                                 const gpu::Image& media) {
  const Targets& targets = in.targets;
  const planning::View& view = plan.input.view;
  if (view.sample.count > 1)
    scope(recorder, "average", [&] { average_pass_->record(recorder, targets.radiance, view.sample.index); });
  if (antialias_pass_)
    scope(recorder, "antialias", [&] {
      planning::ViewSample middle = view.sample;
      middle.pixel = {0, 0};
      antialias_pass_->record(recorder, {in.frame, in.surfaces, media, targets.radiance},
                              planning::device_camera(view.camera, size_px_, middle).clip_from_world,
                              view.sample.pixel, view.continues);
    });
  scope(recorder, "display", [&] {
    display_pass_->record(recorder, in.frame, in.blue_noise, radiance(targets), targets.display);
  });
}

void PicturePart::record_debug_view(gpu::Recorder& recorder, const FramePlan& plan,
                                    const FrameResources& in) {
  if (antialias_pass_) antialias_pass_->invalidate_past(recorder);
  debug_view_->record(
      recorder, debug_subject(plan),
      {in.frame, in.targets.gbuffer, in.surfaces, in.media.smoke, in.media.holes, in.targets.radiance},
      in.targets.display);
}

}  // namespace brume::render
