#include "passes/raycast.hpp"

#include "brume_shaders.hpp"
#include "shared/gbuffer.h"

namespace brume::passes {
namespace {

constexpr VkFormat kIntervalFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kTargetFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

gpu::Image interval_image(gpu::Context& context, glm::uvec2 size_px) {
  gpu::ImageInfo info;
  info.format = kIntervalFormat;
  info.size = {size_px, 1};
  info.usage =
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return gpu::Image(context, info);
}

/// The draw of which only the front faces, or only the back faces, remain once back faces are culled.
shared::RaycastDraw draw_of(const planning::RaycastPlan::Box& box, bool back_faces) {
  return {box.volume, box.mirrored != back_faces ? 1u : 0u};
}

std::span<const std::byte> bytes_of(const shared::RaycastDraw& draw) {
  return std::as_bytes(std::span(&draw, 1));
}

}  // namespace

IntervalSurfaces::IntervalSurfaces(gpu::Context& context, glm::uvec2 size_px)
    : entries(interval_image(context, size_px)), exits(interval_image(context, size_px)) {}

RaycastPass::RaycastPass(gpu::Context& context, RaycastForm form, glm::uvec2 size_px)
    : nearest_(context, {VK_FILTER_NEAREST}) {
  gpu::grow(context, view_, sizeof(shared::RaycastView));
  gpu::grow(context, volumes_, shared::kMaxVolumes * sizeof(shared::RaycastVolume));
  gpu::GraphicsInfo info{&shaders::raycast_box_vert, nullptr, {}, VK_FORMAT_UNDEFINED};
  info.culls_back_faces = true;
  if (form == RaycastForm::two_pass) {
    info.fragment = &shaders::raycast_interval_frag;
    info.colours = {kIntervalFormat};
    interval_.emplace(context, info);
    two_pass_.emplace(context, shaders::raycast_two_pass_comp);
    surfaces_.emplace(context, size_px);
  } else {
    info.fragment = &shaders::raycast_single_frag;
    info.colours = {kTargetFormat};
    info.blend = gpu::Blend::medium;
    single_.emplace(context, info);
  }
}

void RaycastPass::record(gpu::Recorder& recorder, const Inputs& in, const planning::RaycastPlan& plan,
                         const gpu::Image& target) const {
  recorder.clear(target, {{0, 0, 0, 1}});
  if (plan.boxes.empty()) return;
  recorder.upload(view_, 0, std::as_bytes(std::span(&plan.view, 1)));
  recorder.upload(volumes_, 0, std::as_bytes(std::span(plan.volumes)));
  if (single_) return record_single_pass(recorder, in, plan, target);
  for (const planning::RaycastPlan::Box& box : plan.boxes) record_two_pass(recorder, in, box, target);
}

void RaycastPass::record_two_pass(gpu::Recorder& recorder, const Inputs& in,
                                  const planning::RaycastPlan::Box& box, const gpu::Image& target) const {
  draw_surface(recorder, draw_of(box, false), surfaces_->entries);
  draw_surface(recorder, draw_of(box, true), surfaces_->exits);
  recorder.bind(*two_pass_, {in.volumes.bindings()},
                {
                    {shared::kBindRaycastView, gpu::read(view_)},
                    {shared::kBindRaycastVolumes, gpu::read(volumes_)},
                    {shared::kBindDepth, gpu::sampled(in.depth, nearest_)},
                    {shared::kBindRayEntries, gpu::sampled(surfaces_->entries, nearest_)},
                    {shared::kBindRayExits, gpu::sampled(surfaces_->exits, nearest_)},
                    {shared::kBindRaycastTarget, gpu::read_write_stored(target)},
                },
                draw_of(box, false));
  recorder.dispatch_threads(*two_pass_, target.info().size.x, target.info().size.y);
}

/// Clears a surface and draws the faces into it.
void RaycastPass::draw_surface(gpu::Recorder& recorder, const shared::RaycastDraw& draw,
                               const gpu::Image& surface) const {
  recorder.prepare_for_draws({gpu::read(volumes_)});
  recorder.begin_rendering({{&surface}}, glm::uvec2(surface.info().size));
  recorder.bind_for_draws(*interval_, {{shared::kBindRaycastVolumes, gpu::read(volumes_)}});
  recorder.push(*interval_, bytes_of(draw));
  recorder.draw(shared::kBoxVertices);
  recorder.end_rendering();
}

void RaycastPass::record_single_pass(gpu::Recorder& recorder, const Inputs& in,
                                     const planning::RaycastPlan& plan, const gpu::Image& target) const {
  recorder.prepare_for_draws({gpu::read(view_), gpu::read(volumes_), gpu::sampled(in.depth, nearest_)});
  recorder.prepare_for_draws(*single_, {in.volumes.bindings()}, {});
  recorder.begin_rendering({{&target}, nullptr, VK_NULL_HANDLE, 1}, glm::uvec2(target.info().size));
  recorder.bind_for_draws(*single_, {in.volumes.bindings()},
                          {
                              {shared::kBindRaycastView, gpu::read(view_)},
                              {shared::kBindRaycastVolumes, gpu::read(volumes_)},
                              {shared::kBindDepth, gpu::sampled(in.depth, nearest_)},
                          });
  for (const planning::RaycastPlan::Box& box : plan.boxes) {
    // Around the eye there are no front faces; each ray leaves through one back face.
    recorder.push(*single_, bytes_of(draw_of(box, box.around_eye)));
    recorder.draw(shared::kBoxVertices);
  }
  recorder.end_rendering();
}

}  // namespace brume::passes
