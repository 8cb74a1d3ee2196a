#include "passes/particles.hpp"

#include <algorithm>
#include <bit>

#include "brume_shaders.hpp"
#include "shared/display.h"
#include "shared/frame.h"
#include "shared/gbuffer.h"

namespace brume::passes {
namespace {

shared::ParticleList list_of(std::span<const shared::ParticleSystem> systems) {
  shared::ParticleList list{};
  list.system_count = static_cast<std::uint32_t>(systems.size());
  for (const shared::ParticleSystem& system : systems) list.count += system.count;
  list.padded_count = std::max(std::bit_ceil(list.count), shared::kParticleBlock);
  return list;
}

/// Quads that only emit may be added in any order.
bool needs_order(std::span<const shared::ParticleSystem> systems) {
  return std::ranges::any_of(systems,
                             [](const shared::ParticleSystem& system) { return system.extinction > 0; });
}

gpu::GraphicsInfo quads_drawn_by(const gpu::ShaderCode& fragment, VkFormat target) {
  gpu::GraphicsInfo info{&shaders::particles_vert, &fragment, {target}, VK_FORMAT_UNDEFINED};
  info.blend = gpu::Blend::medium;
  return info;
}

constexpr std::uint32_t kQuadVertices = 6;
constexpr VkFormat kRadianceFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

/// Floats, where the device can blend them.
VkFormat layer_format(gpu::Context& context) {
  VkFormatProperties floats{};
  context.vk().GetPhysicalDeviceFormatProperties(context.info().handle, VK_FORMAT_R32G32B32A32_SFLOAT,
                                                 &floats);
  return floats.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT
             ? VK_FORMAT_R32G32B32A32_SFLOAT
             : kRadianceFormat;
}

gpu::Image layer_image(gpu::Context& context, VkFormat format, glm::uvec2 size_px) {
  return gpu::Image(
      context, gpu::sampled_image(size_px, format,
                                  VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
}

}  // namespace

ParticlePass::ParticlePass(gpu::Context& context)
    : context_(context),
      layer_format_(layer_format(context)),
      move_(context, shaders::particles_move_comp),
      sort_blocks_(context, shaders::particles_sort_comp, {1}),
      sort_step_(context, shaders::particles_sort_comp, {0}),
      compose_(context, shaders::particles_compose_comp),
      draw_(context, quads_drawn_by(shaders::particles_frag, layer_format_)),
      linear_(context, {}),
      nearest_(context, {VK_FILTER_NEAREST}) {
  gpu::grow(context, systems_, shared::kMaxParticleSystems * sizeof(shared::ParticleSystem));
}

void ParticlePass::reserve(std::span<const shared::ParticleSystem> systems, glm::uvec2 size_px,
                           bool counts_quads) {
  const shared::ParticleList list = list_of(systems);
  gpu::grow(context_, particles_, std::uint64_t{list.padded_count} * sizeof(shared::Particle));
  gpu::grow(context_, order_, std::uint64_t{list.padded_count} * sizeof(glm::uvec2));
  if (counts_quads && !count_)
    count_.emplace(context_, quads_drawn_by(shaders::particles_overdraw_frag, kRadianceFormat));
  if (!layer_ || layer_.info().size != glm::uvec3(size_px, 1))
    layer_ = layer_image(context_, layer_format_, size_px);
}

/// Uploads the systems, and lists their particles in the order of their quads.
shared::ParticleList ParticlePass::record_list(gpu::Recorder& recorder, const Inputs& in,
                                               std::span<const shared::ParticleSystem> systems) const {
  const shared::ParticleList list = list_of(systems);
  recorder.upload(systems_, 0, std::as_bytes(systems));
  recorder.bind(move_,
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindParticleSystems, gpu::read(systems_)},
                    {shared::kBindParticles, gpu::write(particles_)},
                    {shared::kBindParticleOrder, gpu::write(order_)},
                },
                list);
  recorder.dispatch_threads(move_, list.padded_count);
  if (needs_order(systems)) record_sort(recorder, list);
  return list;
}

void ParticlePass::record_sort(gpu::Recorder& recorder, shared::ParticleList list) const {
  constexpr std::uint32_t kSortThreads = 128;
  const auto run = [&](const gpu::ComputePipeline& pipeline, std::uint32_t threads) {
    recorder.bind(pipeline, {{shared::kBindParticleOrder, gpu::read_write(order_)}}, list);
    recorder.dispatch_threads(pipeline, threads);
  };
  const std::uint32_t blocks = list.padded_count / shared::kParticleBlock;
  list.first_span = 2;
  list.last_span = shared::kParticleBlock;
  run(sort_blocks_, blocks * kSortThreads);
  for (std::uint32_t span = 2 * shared::kParticleBlock; span <= list.padded_count; span *= 2) {
    list.first_span = list.last_span = span;
    for (list.stride = span / 2; list.stride >= shared::kParticleBlock; list.stride /= 2)
      run(sort_step_, list.padded_count / 2);
    run(sort_blocks_, blocks * kSortThreads);
  }
}

void ParticlePass::record_layer(gpu::Recorder& recorder, const Inputs& in, std::uint32_t particles) const {
  recorder.clear(layer_, {{0, 0, 0, 1}});
  recorder.prepare_for_draws({gpu::uniform(in.frame), gpu::read(systems_), gpu::read(particles_),
                              gpu::read(order_), gpu::sampled(in.slices, linear_),
                              gpu::sampled(in.depth, nearest_)});
  recorder.begin_rendering({{&layer_}, nullptr, VK_NULL_HANDLE, 1}, glm::uvec2(layer_.info().size));
  recorder.bind_for_draws(draw_, {
                                     {shared::kBindFrame, gpu::uniform(in.frame)},
                                     {shared::kBindParticleSystems, gpu::read(systems_)},
                                     {shared::kBindParticles, gpu::read(particles_)},
                                     {shared::kBindParticleOrder, gpu::read(order_)},
                                     {shared::kBindSliceTextures, gpu::sampled(in.slices, linear_)},
                                     {shared::kBindDepth, gpu::sampled(in.depth, nearest_)},
                                 });
  recorder.draw(kQuadVertices * particles);
  recorder.end_rendering();
}

void ParticlePass::record(gpu::Recorder& recorder, const Inputs& in,
                          std::span<const shared::ParticleSystem> systems, const gpu::Image& target) const {
  if (systems.empty()) return;
  record_layer(recorder, in, record_list(recorder, in, systems).count);
  recorder.bind(compose_, {
                              {shared::kBindParticleLayer, gpu::sampled(layer_, nearest_)},
                              {shared::kBindRadiance, gpu::read_write_stored(target)},
                          });
  recorder.dispatch_threads(compose_, target.info().size.x, target.info().size.y);
}

void ParticlePass::record_overdraw(gpu::Recorder& recorder, const Inputs& in,
                                   std::span<const shared::ParticleSystem> systems,
                                   const gpu::Image& target) const {
  if (systems.empty()) return;
  const shared::ParticleList list = record_list(recorder, in, systems);
  recorder.prepare_for_draws(
      {gpu::uniform(in.frame), gpu::read(systems_), gpu::read(particles_), gpu::read(order_)});
  recorder.begin_rendering({{&target}, nullptr, VK_NULL_HANDLE, 1}, glm::uvec2(target.info().size));
  recorder.bind_for_draws(*count_, {
                                       {shared::kBindFrame, gpu::uniform(in.frame)},
                                       {shared::kBindParticleSystems, gpu::read(systems_)},
                                       {shared::kBindParticles, gpu::read(particles_)},
                                       {shared::kBindParticleOrder, gpu::read(order_)},
                                   });
  recorder.draw(kQuadVertices * list.count);
  recorder.end_rendering();
}

}  // namespace brume::passes
