#include "render/parts/march.hpp"

#include <algorithm>

#include "passes/noise.hpp"
#include "planning/raycast_plan.hpp"
#include "smoke/noise_tile.hpp"

namespace brume::render {
namespace {

gpu::Buffer make_counters(gpu::Context& context, std::size_t pixels) {
  return {context, (1 + pixels) * sizeof(std::uint32_t),
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
              VK_BUFFER_USAGE_TRANSFER_SRC_BIT};
}

passes::MarchPass::Inputs march_inputs(const FramePlan& plan, const FrameResources& in) {
  return {.frame = in.frame,
          .media = in.media,
          .light = in.media_light,
          .noise = in.noise,
          .detail = in.detail,
          .depth = in.surfaces,
          .blue_noise = in.blue_noise,
          .size_px = plan.size_px};
}

}  // namespace

MarchPart::MarchPart(gpu::Context& context, gpu::CommandStream& stream, glm::uvec2 size_px,
                     const MediaOptions& options)
    : context_(context),
      stream_(stream),
      options_(options),
      size_px_(size_px),
      noise_(passes::make_noise_tile(context, smoke::kSmokeNoise.size)),
      detail_(passes::make_detail_tile(context)),
      march_pass_(context,
                  {options.count_samples, false, options.brute_force_holes, options.record_entries, 0}) {
  if (options.temporal) reserve_accumulation(0);
  resize(size_px);
  set_march_scale(options.march_scale);
  if (options.prepare_all) prepare();
}

/// What frames with smoke need, and those without.
void MarchPart::prepare() {
  make_noise();
  march_pass_.reserve(0, passes::MarchRays::all);
  for (const std::uint32_t media : planning::media_of_all_qualities(shared::kMediumSmoke))
    march_pass_.reserve(media, passes::MarchRays::all);
}

void MarchPart::make_noise() {
  if (has_noise_) return;
  const passes::NoisePass noise(context_);
  stream_.run([&](gpu::Recorder& recorder) {
    noise.record(recorder, noise_, smoke::kSmokeNoise);
    noise.record_detail(recorder, noise_, detail_);
  });
  has_noise_ = true;
}

void MarchPart::resize(glm::uvec2 size_px) {
  size_px_ = size_px;
  counters_ = make_counters(context_, options_.record_entries ? std::size_t{size_px.x} * size_px.y : 0);
  for (auto& accumulation : accumulations_)
    if (accumulation) accumulation.emplace(context_, size_px);
  if (options_.raycast) raycast_pass_.emplace(context_, *options_.raycast, size_px);
  set_march_scale(march_scale_);
}

void MarchPart::set_march_scale(std::uint32_t scale) {
  march_scale_ = scale;
  tiles_.reset();
  if (scale > 1) tiles_.emplace(context_, size_px_, scale);
  if ((scale > 1 || options_.prepare_all) && !resolve_pass_) resolve_pass_.emplace(context_);
}

void MarchPart::reserve_accumulation(std::uint32_t view) {
  // Images of the frame's size are never refused.
  const gpu::Memory::Unlimited always(context_.memory());
  if (!accumulations_[view]) accumulations_[view].emplace(context_, size_px_);
}

void MarchPart::reserve(const FramePlan& plan) {
  if (is_accumulated()) reserve_accumulation(plan.input.view.index);
  const std::uint32_t media = plan.media.media;
  if (plan.media.needs_noise) make_noise();

  // The rays of the frame.
  const auto rays = options_.prepare_all ? passes::MarchRays::all
                    : march_scale_ == 1  ? passes::MarchRays::of_pixels
                                         : passes::MarchRays::of_tiles;
  march_pass_.reserve(media, rays);
  if (plan.input.debug.view == planning::DebugView::steps) {
    if (!counting_march_)
      counting_march_.emplace(
          context_, passes::MarchPass::Options{
                        .count_steps = true, .brute_force_holes = options_.brute_force_holes, .media = 0});
    counting_march_->reserve(media, rays);
  }

  // With or without, whatever later frames choose.
  if (!options_.prepare_all) return;
  for (const std::uint32_t other : planning::media_of_all_qualities(media)) march_pass_.reserve(other, rays);
}

void MarchPart::upload(gpu::Recorder& recorder, const FrameResources& in) {
  recorder.fill(march_of(in).counters, 0);
  if (tiles_) passes::ResolvePass::upload(recorder, *tiles_);
}

MarchPart::March MarchPart::march_of(const FrameResources& in) const {
  if (in.step_counters) return {*counting_march_, *in.step_counters};
  return {march_pass_, counters_};
}

void MarchPart::record_raycast(gpu::Recorder& recorder, const FramePlan& plan,
                               const FrameResources& in) const {
  const shared::FrameMedia& media = plan.media.frame;
  const auto volumes = planning::volumes_in_view(plan.media);
  const float anisotropy = volumes.empty() ? 0 : volumes.front().instance.look.anisotropy;
  const glm::vec3 sky = shared::sky_shape(0) * plan.input.environment.sky.ambient;
  const planning::RaycastLight light{media.to_sun, media.sun_irradiance, sky,
                                     shared::phase_of_hg(anisotropy)};
  planning::RaycastSteps steps;
  steps.opaque_transmittance = std::min(steps.opaque_transmittance, media.opaque_transmittance);
  raycast_pass_->record(recorder, {in.media.volumes, in.surfaces},
                        planning::plan_raycast(plan.camera, size_px_, volumes, light, steps),
                        in.targets.media);
}

void MarchPart::record(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  const March march = march_of(in);
  const Targets& targets = in.targets;
  const passes::MarchPass::Inputs inputs = march_inputs(plan, in);
  const passes::ResolvePass::Frame frame{in.frame, plan.size_px};

  // One ray a pixel, or one a tile.
  scope(recorder, "march", [&] {
    if (raycast_pass_) return record_raycast(recorder, plan, in);
    if (!tiles_) return march.pass.record(recorder, inputs, targets.media, march.counters);
    resolve_pass_->record_ends(recorder, frame, in.surfaces, *tiles_);
    march.pass.record_tiles(recorder, inputs, *tiles_, march.counters);
  });
  if (!tiles_) return;

  // From the rays of tiles to every pixel.
  scope(recorder, "resolve", [&] {
    // Neither fills the device, and both only read the rays.
    recorder.concurrently([&] {
      resolve_pass_->record_select(recorder, frame, targets.gbuffer.emission, *tiles_);
      resolve_pass_->record(recorder, frame, in.surfaces, *tiles_, targets.media);
    });
    march.pass.record_list(recorder, inputs, *tiles_, targets.media, march.counters);
  });
}

void MarchPart::record_accumulate(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  if (!is_accumulated()) return;
  const std::uint32_t view = plan.input.view.index;
  recorder.change(shown_view_) = view;
  scope(recorder, "accumulate", [&] {
    accumulations_[view]->record(recorder, in.frame, plan.size_px, in.surfaces, in.targets.media,
                                 plan.history());
  });
}

}  // namespace brume::render
