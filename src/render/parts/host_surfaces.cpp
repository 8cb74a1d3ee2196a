#include "render/parts/host_surfaces.hpp"

#include <algorithm>

#include "planning/device_lights.hpp"

namespace brume::render {

void HostSurfacesPart::reserve_normals(Targets& targets) {
  if (!normal_pass_) normal_pass_.emplace(context_);
  if (!targets.gbuffer.normal_metallic) targets.gbuffer.add_imported_normals(context_);
}

void HostSurfacesPart::reserve_shadows(glm::uvec2 size_px) {
  if (!shadow_pass_) shadow_pass_.emplace(context_);
  if (shadows_) return;
  shadows_ = gpu::Image(context_, gpu::storage_image(size_px, VK_FORMAT_R16G16B16A16_SFLOAT));
}

void HostSurfacesPart::record_depth(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                                    const HostSurfaces& surfaces) {
  bool& has_no_emission = recorder.change(has_no_emission_);
  if (!has_no_emission) recorder.clear(in.targets.gbuffer.emission, {});
  has_no_emission = true;
  import_pass_.record(recorder, surfaces.depth, {surfaces.origin_px, plan.size_px}, surfaces.range,
                      plan.camera.near_z, in.targets.gbuffer);
}

void HostSurfacesPart::record_normals(gpu::Recorder& recorder, const FramePlan& plan,
                                      const FrameResources& in, const HostSurfaces& surfaces) const {
  normal_pass_->record(recorder, in.frame, surfaces.normals, {surfaces.origin_px, plan.size_px},
                       in.targets.gbuffer);
}

void HostSurfacesPart::record_shadows(gpu::Recorder& recorder, const FramePlan& plan,
                                      const FrameResources& in, std::span<const std::uint32_t> lights) {
  const gpu::Scope timed(recorder, "shadows");
  shadow_pass_->record(
      recorder, {in.frame, in.scene.lights, in.shadows.sun, in.smoke_shadows, in.targets.gbuffer.depth},
      planning::planned_lights(plan.lights, in.scene.light_list, plan.input.environment.flashes, lights),
      plan.size_px, shadows_);
}

void HostSurfacesPart::record_layer(gpu::Recorder& recorder, const passes::MediaLayerPass::Layer& layer,
                                    const gpu::Image& picture, const passes::HostPart& part) const {
  const gpu::Scope timed(recorder, "layer");
  layer_pass_.record(recorder, layer, picture, part);
}

}  // namespace brume::render
