#include "passes/indirect_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "brume_shaders.hpp"
#include "shared/glow_field.h"
#include "shared/media.h"
#include "shared/noise.h"
#include "shared/sky_light.h"

namespace brume::passes {
namespace {

gpu::Image make_image(gpu::Context& context, VkFormat format, glm::uvec3 size) {
  return {context, gpu::storage_image_3d(size, format, VK_IMAGE_USAGE_TRANSFER_DST_BIT)};
}

/// What the pipelines of media differ by.
constexpr std::uint32_t kCellMedia = shared::kMediaPresent | shared::kMediaOfAlbedos;

template <typename T>
void upload_list(gpu::Recorder& recorder, const gpu::Buffer& buffer, std::span<const T> list) {
  if (!list.empty()) recorder.upload(buffer, 0, std::as_bytes(list));
}

/// Factor of bounce i of n: the roots of a Chebyshev polynomial over the eigenvalues of a bounce, from
/// kLowest, where light goes back and forth between facing walls, to kHighest. n bounces then leave about as
/// little to find as three times as many would (Varga 1962, "Matrix Iterative Analysis", Richardson's
/// method). Alternates small and large factors to keep every bounce in between bounded; the smallest comes
/// last.
float relaxation(std::uint32_t i, std::uint32_t n) {
  constexpr float kLowest = -0.4f, kHighest = 0.9f;
  if (n < 3) return 1;
  const std::uint32_t from_smallest = i + 1 == n ? 0 : i % 2 == 0 ? 1 + i / 2 : n - 1 - i / 2;
  const float angle =
      std::numbers::pi_v<float> * (static_cast<float>(from_smallest) + 0.5f) / static_cast<float>(n);
  return 1 / (1 - 0.5f * (kHighest + kLowest) + 0.5f * (kHighest - kLowest) * std::cos(angle));
}

}  // namespace

IndirectLightPass::IndirectLightPass(gpu::Context& context)
    : context_(context),
      patches_pass_(context, shaders::indirect_patches_comp),
      medium_light_pass_(context, shaders::indirect_medium_light_comp),
      patch_radiance_pass_(context, shaders::indirect_patch_radiance_comp),
      medium_source_pass_(context, shaders::indirect_medium_source_comp),
      smooth_pass_(context, shaders::indirect_smooth_comp),
      linear_(context, {}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}) {
  cube_ = make_image(context, VK_FORMAT_R16G16B16A16_SFLOAT, {1, 1, shared::kIndirectSlabs});
}

void IndirectLightPass::reserve_pipelines(std::uint32_t casters) {
  if (!medium_passes_.contains(casters & kCellMedia))
    medium_passes_.try_emplace(casters & kCellMedia, context_, shaders::indirect_medium_comp,
                               std::vector{casters & kCellMedia});
  for (const std::uint32_t media : {0u, 1u})
    if (const std::array key{media, small_emitters_}; !gather_passes_.contains(key))
      gather_passes_.try_emplace(key, context_, shaders::indirect_gather_comp,
                                 std::vector{media, small_emitters_});
}

void IndirectLightPass::reserve(const surfaces::LightCells& level, std::size_t most_lights,
                                std::uint32_t casters) {
  patch_count_ = static_cast<std::uint32_t>(level.patches.size());
  probe_count_ = static_cast<std::uint32_t>(level.probes.size());
  gpu::grow(context_, patches_, std::max<std::size_t>(patch_count_, 1) * sizeof(shared::SurfacePatch));
  gpu::grow(context_, irradiance_, std::max<std::size_t>(patch_count_, 1) * sizeof(glm::vec3));
  gpu::grow(context_, radiance_, std::max<std::size_t>(patch_count_, 1) * sizeof(glm::vec3));
  gpu::grow(context_, probes_, std::max<std::size_t>(probe_count_, 1) * sizeof(std::uint32_t));
  gpu::grow(context_, hits_,
            std::max<std::size_t>(probe_count_, 1) * shared::kProbeRays * sizeof(std::uint32_t));
  small_emitters_ = level.emitter_rays.empty() ? 0 : 1;
  reserve_pipelines(casters);
  gpu::grow(context_, emitter_samples_,
            std::max<std::size_t>(level.emitter_samples.size(), 1) * sizeof(shared::EmitterSample));
  gpu::grow(context_, emitter_rays_,
            std::max<std::size_t>(level.emitter_rays.size(), 1) * sizeof(shared::EmitterRay));
  gpu::grow(context_, lights_, std::max<std::size_t>(most_lights, 1) * sizeof(shared::Light));
  const glm::uvec3 size(level.layout.size), slabs(size.x, size.y, shared::kIndirectSlabs * size.z);
  if (cube_.info().size == slabs && medium_) return;
  // All of them or none: where memory was refused, another try makes all.
  std::array<gpu::Image, 6> made;
  for (std::size_t i = 0; i < made.size(); ++i)
    made[i] = make_image(context_, VK_FORMAT_R16G16B16A16_SFLOAT, i < 3 ? slabs : size);
  std::size_t next = 0;
  for (gpu::Image* image : {&cube_, &next_cube_, &noisy_cube_, &medium_, &medium_direct_, &medium_matter_})
    *image = std::move(made[next++]);
}

void IndirectLightPass::upload(gpu::Recorder& recorder, const surfaces::LightCells& level) const {
  upload_list<shared::SurfacePatch>(recorder, patches_, level.patches);
  upload_list<std::uint32_t>(recorder, probes_, level.probes);
  upload_list<std::uint32_t>(recorder, hits_, level.hits);
  upload_list<shared::EmitterSample>(recorder, emitter_samples_, level.emitter_samples);
  upload_list<shared::EmitterRay>(recorder, emitter_rays_, level.emitter_rays);
}

void IndirectLightPass::record(gpu::Recorder& recorder, const Inputs& in,
                               const planning::IndirectLightPlan& plan, const Box<int>& media) {
  const std::uint32_t end = plan.slices.first + plan.slices.count;
  for (std::uint32_t i = plan.slices.first; i < end;) {
    const std::uint32_t bounce = i / planning::kSlicesPerBounce, slice = i % planning::kSlicesPerBounce;
    if (i == 0) begin(recorder, in, plan.lights, media);
    if (slice == 0) record_sources(recorder, in);
    // Slices that come together are one dispatch.
    const std::uint32_t together = std::min(planning::kSlicesPerBounce - slice, end - i);
    record_gather(recorder, in, slice, together);
    i += together;
    if (i % planning::kSlicesPerBounce != 0) continue;
    record_smooth(recorder, in, relaxation(bounce, plan.bounces));
    if (bounce + 1 == plan.bounces) std::swap(cube_, next_cube_);
  }
}

/// The light of the lights, on patches and in media.
void IndirectLightPass::begin(gpu::Recorder& recorder, const Inputs& in,
                              std::span<const shared::Light> lights, const Box<int>& media) {
  params_ = {};
  if (!media.empty()) {
    params_.media_low = media.low;
    params_.media_high = media.high;
  }
  params_.patch_count = patch_count_;
  params_.probe_count = probe_count_;
  params_.light_count = static_cast<std::uint32_t>(lights.size());
  params_.g = in.g;
  upload_list(recorder, lights_, lights);
  recorder.clear(next_cube_, {});
  recorder.clear(noisy_cube_, {});
  if (has_media()) {
    recorder.clear(medium_, {});
    recorder.clear(medium_matter_, {});
    recorder.clear(medium_direct_, {});
    record_media(recorder, in);
  }
  dispatch_lit(recorder, in, patches_pass_, {patch_count_, 1, 1},
               gpu::BoundResource{shared::kBindSurfacePatches, gpu::read(patches_)},
               gpu::BoundResource{shared::kBindPatchIrradiance, gpu::write(irradiance_)});
}

template <typename... Own>
void IndirectLightPass::dispatch_lit(gpu::Recorder& recorder, const Inputs& in,
                                     const gpu::ComputePipeline& pipeline, glm::uvec3 threads, Own... own) {
  recorder.bind(pipeline, {in.media.bindings()},
                {{shared::kBindFrame, gpu::uniform(in.frame)},
                 {shared::kBindLights, gpu::read(lights_)},
                 {shared::kBindSun, gpu::uniform(in.shadows.sun)},
                 {shared::kBindShadowMaps, gpu::sampled(in.shadows.layers, compare_)},
                 {shared::kBindSunMap, gpu::sampled(in.shadows.sun_map, compare_)},
                 {shared::kBindSolidTexels, gpu::sampled(in.solid.texels(), linear_)},
                 {shared::kBindMediumMatter, gpu::sampled(medium_matter_, linear_)},
                 own...},
                params_);
  recorder.dispatch_threads(pipeline, threads.x, threads.y, threads.z);
}

void IndirectLightPass::record_media(gpu::Recorder& recorder, const Inputs& in) {
  const glm::uvec3 cells(params_.media_high - params_.media_low);
  const gpu::ComputePipeline& medium_pass = medium_passes_.at(in.media.set & kCellMedia);
  recorder.bind(medium_pass, {in.media.bindings()},
                {{shared::kBindFrame, gpu::uniform(in.frame)},
                 {shared::kBindNoiseTile, gpu::sampled(in.noise, linear_)},
                 {shared::kBindIndirectTarget, gpu::stored(medium_matter_)}},
                params_);
  recorder.dispatch_threads(medium_pass, cells.x, cells.y, cells.z);
  dispatch_lit(recorder, in, medium_light_pass_, {probe_count_, 1, 1},
               gpu::BoundResource{shared::kBindIndirectProbes, gpu::read(probes_)},
               gpu::BoundResource{shared::kBindIndirectHits, gpu::read(hits_)},
               gpu::BoundResource{shared::kBindGlowField, gpu::sampled(in.glow_field, linear_)},
               gpu::BoundResource{shared::kBindIndirectTarget, gpu::stored(medium_direct_)},
               gpu::BoundResource{shared::kBindIndirectCubeTarget, gpu::stored(noisy_cube_)});
}

/// What patches and media send out, of the light that is known so far.
void IndirectLightPass::record_sources(gpu::Recorder& recorder, const Inputs& in) {
  recorder.concurrently([&] {
    recorder.bind(patch_radiance_pass_,
                  {{shared::kBindFrame, gpu::uniform(in.frame)},
                   {shared::kBindIndirectCube, gpu::sampled(next_cube_, linear_)},
                   {shared::kBindSurfacePatches, gpu::read(patches_)},
                   {shared::kBindPatchIrradiance, gpu::read(irradiance_)},
                   {shared::kBindPatchRadiance, gpu::write(radiance_)}},
                  params_);
    recorder.dispatch_threads(patch_radiance_pass_, patch_count_);
    if (!has_media()) return;
    const glm::uvec3 cells(params_.media_high - params_.media_low);
    recorder.bind(medium_source_pass_,
                  {{shared::kBindFrame, gpu::uniform(in.frame)},
                   {shared::kBindIndirectCube, gpu::sampled(next_cube_, linear_)},
                   {shared::kBindMediumDirect, gpu::sampled(medium_direct_, linear_)},
                   {shared::kBindMediumMatter, gpu::sampled(medium_matter_, linear_)},
                   {shared::kBindIndirectTarget, gpu::stored(medium_)}},
                  params_);
    recorder.dispatch_threads(medium_source_pass_, cells.x, cells.y, cells.z);
  });
}

void IndirectLightPass::record_gather(gpu::Recorder& recorder, const Inputs& in, std::uint32_t slice,
                                      std::uint32_t count) {
  const std::uint64_t probes = probe_count_, all = planning::kSlicesPerBounce;
  params_.first_probe = static_cast<std::uint32_t>(probes * slice / all);
  params_.end_probe = static_cast<std::uint32_t>(probes * (slice + count) / all);
  if (params_.first_probe == params_.end_probe) return;
  const gpu::ComputePipeline& gather = gather_passes_.at({has_media() ? 1u : 0u, small_emitters_});
  recorder.bind(gather,
                {{shared::kBindFrame, gpu::uniform(in.frame)},
                 {shared::kBindIndirectProbes, gpu::read(probes_)},
                 {shared::kBindIndirectHits, gpu::read(hits_)},
                 {shared::kBindEmitterSamples, gpu::read(emitter_samples_)},
                 {shared::kBindEmitterRays, gpu::read(emitter_rays_)},
                 {shared::kBindPatchRadiance, gpu::read(radiance_)},
                 {shared::kBindIndirectMedium, gpu::sampled(medium_, linear_)},
                 {shared::kBindIndirectTarget, gpu::stored(noisy_cube_)}},
                params_);
  recorder.dispatch_threads(gather, params_.end_probe - params_.first_probe);
}

void IndirectLightPass::record_smooth(gpu::Recorder& recorder, const Inputs& in, float relaxation) {
  params_.relaxation = relaxation;
  recorder.bind(smooth_pass_,
                {{shared::kBindFrame, gpu::uniform(in.frame)},
                 {shared::kBindIndirectCube, gpu::sampled(noisy_cube_, linear_)},
                 {shared::kBindMediumMatter, gpu::sampled(medium_matter_, linear_)},
                 {shared::kBindIndirectTarget, gpu::read_write_stored(next_cube_)}},
                params_);
  const glm::uvec3 size = noisy_cube_.info().size;
  recorder.dispatch_threads(smooth_pass_, size.x * size.y * size.z / shared::kIndirectSlabs);
}

}  // namespace brume::passes
