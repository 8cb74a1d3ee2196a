#include "render/parts/smoke.hpp"

#include <algorithm>

namespace brume::render {

SmokePart::SmokePart(gpu::Context& context, gpu::CommandStream& stream, std::size_t most_lights,
                     glm::uvec2 size_px, const MediaOptions& options)
    : context_(context),
      stream_(stream),
      most_lights_(most_lights),
      upload_(context, options.reserved_bricks),
      hole_clusters_(context, stream, options.masks ? *options.masks : smoke::MaskAtlas()),
      noise_advection_pass_(context),
      shadow_pass_(context),
      light_pass_(context),
      fine_light_pass_(context) {
  resize(size_px);
  if (!options.prepare_all) return;
  for (const std::uint32_t casters : {0u, shared::kMediumSmoke}) shadow_pass_.reserve(casters);
  light_pass_.reserve_pipelines(shared::kMediumSmoke);
}

void SmokePart::resize(glm::uvec2 size_px) {
  shadows_ = shadow_pass_.make_shadows(context_, size_px, most_lights_);
}

void SmokePart::set_most_lights(std::size_t most_lights, glm::uvec2 size_px) {
  most_lights_ = most_lights;
  resize(size_px);
}

void SmokePart::set_masks(const smoke::MaskAtlas& masks) {
  hole_clusters_.set_masks(context_, stream_, masks);
}

void SmokePart::trim(glm::ivec3 atlas_bricks) {
  const gpu::Memory::Unlimited shrinks(context_.memory());
  upload_.trim(atlas_bricks);
  noise_advection_pass_.trim();
  light_pass_.trim();
  fine_light_pass_.trim();
}

void SmokePart::reserve(const FramePlan& plan) {
  if (plan.smoke) {
    upload_.reserve(*plan.smoke);
    noise_advection_pass_.reserve(plan.state(), *plan.smoke, plan.noise);
  }
  fine_light_pass_.reserve(plan.fine_light);
  hole_clusters_.reserve(plan.holes);
  shadow_pass_.reserve(plan.media.casters);
  light_pass_.reserve(*plan.smoke_light, plan.media.casters);
}

void SmokePart::upload(gpu::Recorder& recorder, const FramePlan& plan) {
  if (plan.smoke) upload_.record(recorder, *plan.smoke);
  upload_.record_visibility(recorder, plan.visibility);
  hole_clusters_.upload(recorder, plan.holes);
  if (plan.smoke) noise_advection_pass_.upload(recorder, plan.noise);
  if (plan.smoke_shadows) passes::SmokeShadowPass::upload(recorder, *plan.smoke_shadows, shadows_);
  light_pass_.upload(recorder, *plan.smoke_light);
  fine_light_pass_.upload(recorder, plan.fine_light);
}

passes::SmokeLightPass::Inputs SmokePart::light_inputs(const FrameResources& in) {
  return {in.frame, in.scene, in.shadows, in.level, in.lit_media};
}

void SmokePart::record_density(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  recorder.concurrently([&] {
    hole_clusters_.record_first(recorder, plan.holes, in.frame, resources());
    if (plan.smoke) noise_advection_pass_.record(recorder, plan.noise, {in.frame, resources(), in.noise});
    const auto& parts = plan.smoke_light->parts;
    if (!parts.empty()) light_pass_.record_texel_lists(recorder, light_inputs(in), parts.front());
  });
  recorder.concurrently([&] { hole_clusters_.record_second(recorder, plan.holes, in.frame, resources()); });
}

void SmokePart::record_shadows(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  if (!plan.smoke_shadows) return;
  shadow_pass_.record(recorder, {in.frame, in.scene, in.shadows, in.level.solid, in.lit_media},
                      *plan.smoke_shadows, shadows_);
}

void SmokePart::record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  const auto& parts = plan.smoke_light->parts;
  const passes::SmokeLightPass::Inputs inputs = light_inputs(in);
  for (std::size_t i = 0; i < std::max<std::size_t>(parts.size(), 1); ++i) {
    if (i > 0) light_pass_.record_texel_lists(recorder, inputs, parts[i]);
    // Neither fills the device, and neither reads what the other writes.
    recorder.concurrently([&] {
      if (i == 0) record_shadows(recorder, plan, in);
      if (i < parts.size()) light_pass_.record_rays(recorder, inputs, parts[i]);
    });
    if (i < parts.size())
      recorder.concurrently([&] { light_pass_.record_gathers(recorder, inputs, parts[i]); });
  }
  fine_light_pass_.record(recorder, plan.fine_light, {in.frame, resources(), in.noise});
}

}  // namespace brume::render
