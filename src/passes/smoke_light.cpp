#include "passes/smoke_light.hpp"

#include <algorithm>
#include <bit>

#include "brume_shaders.hpp"
#include "shared/smoke_light.h"

namespace brume::passes {
namespace {

constexpr std::uint32_t kMaxSteps = 24;
// Bytes of light per ray at a time; more bricks are lit one part after the other.
constexpr std::size_t kRayBytes = std::size_t{64} << 20;
// Workgroups that share the work of a pass, however much it turns out to be.
constexpr std::uint32_t kGroups = 4096;

}  // namespace

SmokeLightPass::SmokeLightPass(gpu::Context& context)
    : context_(context),
      texels_pass_(context, shaders::light_texels_comp,
                   {gpu::kBuffer, gpu::kBuffer, gpu::kSampled, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
                   sizeof(shared::SmokeLightParams), {256, 1, 1}),
      rays_pass_(context, shaders::light_rays_comp,
                 {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kSampled, gpu::kBuffer,
                  gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kSampled},
                 sizeof(shared::SmokeLightParams), {64, 1, 1}),
      depth_pass_(
          context, shaders::light_depth_comp,
          {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kSampled, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer,
           gpu::kBuffer, gpu::kSampled, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
          sizeof(shared::SmokeLightParams), {64, 1, 1}),
      inscatter_pass_(context, shaders::inscatter_comp,
                      {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer,
                       gpu::kStored, gpu::kSampled, gpu::kSampled, gpu::kSampled, gpu::kSampled},
                      sizeof(shared::SmokeLightParams), {64, 1, 1}),
      linear_(context, {}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}),
      counters_(context, sizeof(shared::SmokeLightCounters),
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

void SmokeLightPass::reserve(std::uint32_t slot_count, std::uint32_t light_count) {
  rays_per_texel_ = light_count + shared::kSkyRays;
  const std::size_t slot_bytes =
      std::size_t{shared::kTexelsPerBrick} * rays_per_texel_ * sizeof(std::uint32_t);
  slots_at_once_ = static_cast<std::uint32_t>(std::max<std::size_t>(kRayBytes / slot_bytes, 1));
  const std::size_t slots = std::bit_ceil(std::max(std::min(slot_count, slots_at_once_), 1u));
  gpu::grow(context_, texels_, slots * shared::kTexelsPerBrick * sizeof(std::uint32_t));
  gpu::grow(context_, rays_, slots * slot_bytes);
  gpu::grow(context_, ray_light_, slots * slot_bytes);
}

void SmokeLightPass::record(gpu::Recorder& recorder, const Inputs& in) {
  for (std::uint32_t first = 0; first < in.smoke.seen; first += slots_at_once_)
    record_slots(recorder, in, first, std::min(slots_at_once_, in.smoke.seen - first));
}

void SmokeLightPass::record_slots(gpu::Recorder& recorder, const Inputs& in, std::uint32_t first,
                                  std::uint32_t count) {
  const shared::SmokeLightParams params{first, count, rays_per_texel_, kMaxSteps};
  recorder.fill(counters_, 0);
  recorder.bind(texels_pass_,
                {gpu::read(in.frame), gpu::read(in.smoke.slots), gpu::sampled(in.smoke.density, linear_),
                 gpu::write(texels_), gpu::read_write(counters_), gpu::read(in.smoke.cells)},
                params);
  recorder.dispatch_threads(texels_pass_, count * 256);
  recorder.bind(rays_pass_,
                {gpu::read(in.frame), gpu::read(in.smoke.slot_bricks), gpu::read(in.scene.lights),
                 gpu::read(in.shadows.sun), gpu::sampled(in.shadows.layers, compare_), gpu::read(texels_),
                 gpu::write(rays_), gpu::write(ray_light_), gpu::read_write(counters_),
                 gpu::sampled(in.level.solid.texels(), linear_)},
                params);
  recorder.dispatch_threads(rays_pass_, kGroups * 64);
  recorder.bind(depth_pass_,
                {gpu::read(in.frame), gpu::read(in.smoke.slot_bricks), gpu::read(in.smoke.pages),
                 gpu::sampled(in.smoke.density, linear_), gpu::read(in.smoke.cells),
                 gpu::read(in.smoke.boundary), gpu::read(in.smoke.corners), gpu::read(in.holes.cells),
                 gpu::sampled(in.smoke.share, linear_), gpu::read(in.scene.lights), gpu::read(texels_),
                 gpu::read(rays_), gpu::read_write(ray_light_), gpu::read(counters_)},
                params);
  recorder.dispatch_threads(depth_pass_, kGroups * 64);
  recorder.bind(
      inscatter_pass_,
      {gpu::read(in.frame), gpu::read(in.smoke.slot_bricks), gpu::read(in.scene.lights), gpu::read(texels_),
       gpu::read(ray_light_), gpu::read(counters_), gpu::stored(in.smoke.inscatter),
       gpu::sampled(in.level.sky.light(), linear_), gpu::sampled(in.level.solid.texels(), linear_),
       gpu::sampled(in.smoke.density, linear_), gpu::sampled(in.smoke.share, linear_)},
      params);
  recorder.dispatch_threads(inscatter_pass_, kGroups * 64);
}

}  // namespace brume::passes
