#include "render/smoke_frame.hpp"

#include <algorithm>

#include "passes/noise.hpp"
#include "smoke/noise_tile.hpp"

namespace brume::render {

using planning::FramePlan;

namespace {

gpu::Buffer make_counters(gpu::Context& context, std::size_t pixels) {
  return {context, (1 + pixels) * sizeof(std::uint32_t),
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
              VK_BUFFER_USAGE_TRANSFER_SRC_BIT};
}

}  // namespace

SmokeFrame::SmokeFrame(gpu::Context& context, gpu::CommandStream& stream, const SceneView& scene,
                       glm::uvec2 size_px, const SmokeFrameOptions& options)
    : context_(context),
      stream_(stream),
      size_px_(size_px),
      brute_force_holes_(options.brute_force_holes),
      record_entries_(options.record_entries),
      prepare_all_(options.prepare_all),
      smoke_upload_(context, options.reserved_bricks),
      volume_upload_(context),
      hole_clusters_(context, stream, options.masks ? *options.masks : smoke::MaskAtlas()),
      noise_(passes::make_noise_tile(context, smoke::kSmokeNoise.size)),
      detail_(passes::make_detail_tile(context)),
      noise_advection_pass_(context),
      shadow_pass_(context),
      light_pass_(context),
      fine_light_pass_(context),
      glow_field_pass_(context),
      volume_light_pass_(context),
      raycast_(options.raycast),
      march_pass_(context,
                  {options.count_samples, false, options.brute_force_holes, options.record_entries, 0}) {
  if (options.temporal) accumulate_pass_.emplace(context, size_px);
  resize(scene, size_px);
  set_march_scale(options.march_scale);
  if (prepare_all_) {
    make_noise();
    shadow_pass_.reserve(shared::kMediumSmoke);
  }
}

void SmokeFrame::make_noise() {
  if (has_noise_) return;
  const passes::NoisePass noise(context_);
  stream_.run([&](gpu::Recorder& recorder) {
    noise.record(recorder, noise_, smoke::kSmokeNoise);
    noise.record_detail(recorder, noise_, detail_);
  });
  has_noise_ = true;
}

void SmokeFrame::resize(const SceneView& scene, glm::uvec2 size_px) {
  size_px_ = size_px;
  counters_ = make_counters(context_, record_entries_ ? std::size_t{size_px.x} * size_px.y : 0);
  shadows_ = shadow_pass_.make_shadows(context_, size_px,
                                       scene.resources().light_list.size() + planning::kMaxFlashes);
  if (accumulate_pass_) accumulate_pass_.emplace(context_, size_px);
  if (raycast_) raycast_pass_.emplace(context_, *raycast_, size_px);
  set_march_scale(march_scale_);
}

void SmokeFrame::set_march_scale(std::uint32_t scale) {
  march_scale_ = scale;
  march_tiles_.reset();
  if (scale > 1) march_tiles_.emplace(context_, size_px_, scale);
  if ((scale > 1 || prepare_all_) && !resolve_pass_) resolve_pass_.emplace(context_);
}

void SmokeFrame::set_masks(const smoke::MaskAtlas& masks) {
  hole_clusters_.set_masks(context_, stream_, masks);
}

void SmokeFrame::trim(glm::ivec3 atlas_bricks) {
  const gpu::Memory::Unlimited shrinks(context_.memory());
  smoke_upload_.trim(atlas_bricks);
  noise_advection_pass_.trim();
  light_pass_.trim();
  fine_light_pass_.trim();
}

void SmokeFrame::reserve(FramePlan& plan, planning::PlanHistory& history) {
  const planning::FrameInput& input = plan.input;
  if (plan.smoke) {
    if (plan.smoke->slot_count() > 0) make_noise();
    smoke_upload_.reserve(*plan.smoke);
    noise_advection_pass_.reserve(plan.state(), *plan.smoke, plan.noise);
  }
  if (plan.volume_light.is_lit) {
    // Not short-circuited: both make room.
    const bool field_lost =
        glow_field_pass_.reserve(planning::volumes_in_view(plan.media), plan.media.casters);
    if (volume_light_pass_.reserve(plan.volume_light, plan.media.casters) || field_lost)
      plan.volume_light.update = true;
  }
  constexpr std::uint32_t kWithNoise = shared::kMediumDisturbed | shared::kMediumVolumeDetail;
  if ((plan.media.media & kWithNoise) != 0) make_noise();
  fine_light_pass_.reserve(plan.fine_light);
  hole_clusters_.reserve(plan.holes);
  shadow_pass_.reserve(plan.media.casters);
  const auto rays = prepare_all_        ? passes::MarchRays::all
                    : march_scale_ == 1 ? passes::MarchRays::of_pixels
                                        : passes::MarchRays::of_tiles;
  march_pass_.reserve(plan.media.media, rays);
  // With or without, whatever later frames choose.
  if (prepare_all_ && (plan.media.media & shared::kMediumSmoke) != 0) {
    march_pass_.reserve(plan.media.media ^ shared::kMediumFineShadows, rays);
    march_pass_.reserve(plan.media.media & ~(shared::kMediumFineShadows | shared::kMediumDetail), rays);
  }
  if (input.debug.view == planning::DebugView::steps) {
    if (!counting_march_)
      counting_march_.emplace(context_,
                              passes::MarchPass::Options{false, true, brute_force_holes_, false, 0});
    counting_march_->reserve(plan.media.media, rays);
  }
  while (!light_pass_.reserve(*plan.smoke_light, plan.media.casters))
    planning::replan_smoke_light(plan, history);
}

void SmokeFrame::record_upload(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  recorder.fill(march_of(in).counters, 0);
  if (plan.smoke) smoke_upload_.record(recorder, *plan.smoke);
  smoke_upload_.record_visibility(recorder, plan.visibility);
  volume_upload_.record(recorder, plan.input.volumes, plan.residency, plan.media.volumes,
                        plan.lit_media.volumes);
  hole_clusters_.upload(recorder, plan.holes);
  if (plan.smoke) noise_advection_pass_.upload(recorder, plan.noise);
  if (plan.smoke_shadows) passes::SmokeShadowPass::upload(recorder, *plan.smoke_shadows, shadows_);
  light_pass_.upload(recorder, *plan.smoke_light);
  fine_light_pass_.upload(recorder, plan.fine_light);
  if (march_tiles_) passes::ResolvePass::upload(recorder, *march_tiles_);
}

passes::SmokeLightPass::Inputs SmokeFrame::light_inputs(const FramePlan& plan,
                                                        const FrameResources& in) const {
  return {in.frame,         in.scene.resources(),           in.scene.shadows(), resources(), holes(),
          in.scene.level(), volume_upload_.lit_resources(), plan.media.casters};
}

void SmokeFrame::record_density(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  recorder.concurrently([&] {
    hole_clusters_.record_first(recorder, plan.holes, in.frame, resources());
    if (plan.smoke) noise_advection_pass_.record(recorder, plan.noise, {in.frame, resources(), noise_});
    const auto& parts = plan.smoke_light->parts;
    if (!parts.empty()) light_pass_.record_texel_lists(recorder, light_inputs(plan, in), parts.front());
  });
  recorder.concurrently([&] { hole_clusters_.record_second(recorder, plan.holes, in.frame, resources()); });
}

void SmokeFrame::record_shadows(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  if (!plan.smoke_shadows) return;
  const passes::VolumeResources volumes = volume_upload_.lit_resources();
  shadow_pass_.record(recorder,
                      {in.frame, in.scene.resources(), in.scene.shadows(), in.scene.level().solid,
                       resources(), holes(), volumes, plan.media.casters},
                      *plan.smoke_shadows, shadows_);
}

void SmokeFrame::record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  const auto& parts = plan.smoke_light->parts;
  const passes::SmokeLightPass::Inputs inputs = light_inputs(plan, in);
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
  fine_light_pass_.record(recorder, plan.fine_light, {in.frame, resources(), noise_});
}

template <typename Record>
void SmokeFrame::with_volume_light_inputs(const FramePlan& plan, const FrameResources& in, Record record) {
  const passes::VolumeResources volumes = volume_upload_.lit_resources();
  const passes::LevelLight level = in.scene.level();
  record(passes::VolumeLightPass::Inputs{in.frame, plan.media.casters, in.scene.resources(),
                                         in.scene.shadows(), level, resources(), holes(), volumes,
                                         glow_field()});
}

void SmokeFrame::record_glow(gpu::Recorder& recorder, const FramePlan& plan) const {
  if (!plan.volume_light.update) return;
  glow_field_pass_.record(
      recorder, {plan.media.casters, volume_upload_.lit_resources(), planning::volumes_in_view(plan.media)});
}

void SmokeFrame::record_volume_sweeps(gpu::Recorder& recorder, const FramePlan& plan,
                                      const FrameResources& in) {
  with_volume_light_inputs(plan, in, [&](const auto& inputs) {
    volume_light_pass_.record_sweeps(recorder, inputs, plan.volume_light);
  });
}

void SmokeFrame::record_volume_light(gpu::Recorder& recorder, const FramePlan& plan,
                                     const FrameResources& in) {
  with_volume_light_inputs(plan, in, [&](const auto& inputs) {
    volume_light_pass_.record_light(recorder, inputs, plan.volume_light);
  });
}

SmokeFrame::March SmokeFrame::march_of(const FrameResources& in) const {
  if (in.step_counters) return {*counting_march_, *in.step_counters};
  return {march_pass_, counters_};
}

passes::MarchPass::Inputs SmokeFrame::march_inputs(const FramePlan& plan, const FrameResources& in) const {
  return {.frame = in.frame,
          .media = plan.media.media,
          .smoke = resources(),
          .fine_light = fine_light_pass_.light(),
          .fine_pages = fine_light_pass_.pages(),
          .volumes = volume_upload_.resources(),
          .volume_light = volume_light_pass_.light(),
          .sun_depths = volume_light_pass_.sun_depths(),
          .noise = noise_,
          .detail = detail_,
          .depth = in.targets.gbuffer.depth,
          .blue_noise = in.blue_noise,
          .holes = holes()};
}

void SmokeFrame::record_raycast(gpu::Recorder& recorder, const FramePlan& plan,
                                const FrameResources& in) const {
  const shared::FrameMedia& media = plan.media.frame;
  const auto volumes = planning::volumes_in_view(plan.media);
  const float anisotropy = volumes.empty() ? 0 : volumes.front().instance.look.anisotropy;
  const glm::vec3 sky = shared::sky_shape(0) * plan.input.environment.sky.ambient;
  const planning::RaycastLight light{media.to_sun, media.sun_irradiance, sky,
                                     shared::phase_of_hg(anisotropy)};
  planning::RaycastSteps steps;
  steps.opaque_transmittance = std::min(steps.opaque_transmittance, media.opaque_transmittance);
  raycast_pass_->record(recorder, {volume_upload_.resources(), in.targets.gbuffer.depth},
                        planning::plan_raycast(plan.camera, size_px_, volumes, light, steps),
                        in.targets.media);
}

void SmokeFrame::record_march(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  if (raycast_pass_) return record_raycast(recorder, plan, in);
  const March march = march_of(in);
  if (!march_tiles_) {
    march.pass.record(recorder, march_inputs(plan, in), in.targets.media, march.counters);
    return;
  }
  resolve_pass_->record_ends(recorder, in.frame, in.targets.gbuffer.depth, *march_tiles_);
  march.pass.record_tiles(recorder, march_inputs(plan, in), *march_tiles_, march.counters);
}

void SmokeFrame::record_resolve(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  const March march = march_of(in);
  const Targets& targets = in.targets;
  // Neither fills the device, and both only read the rays.
  recorder.concurrently([&] {
    resolve_pass_->record_select(recorder, in.frame, targets.gbuffer.emission, *march_tiles_);
    resolve_pass_->record(recorder, in.frame, targets.gbuffer.depth, *march_tiles_, targets.media);
  });
  march.pass.record_list(recorder, march_inputs(plan, in), *march_tiles_, targets.media, march.counters);
}

void SmokeFrame::record_accumulate(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  accumulate_pass_->record(recorder, in.frame, plan.camera, in.targets.gbuffer.depth, in.targets.media,
                           plan.input.view.continues);
}

}  // namespace brume::render
