#include "passes/gbuffer.hpp"

#include <algorithm>

#include "brume_shaders.hpp"
#include "shared/frame.h"

namespace brume::passes {
namespace {

gpu::Image target_image(gpu::Context& context, glm::uvec2 size, VkFormat format,
                        VkImageUsageFlags attachment) {
  gpu::ImageInfo info;
  info.format = format;
  info.size = {size, 1};
  info.usage = attachment | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return gpu::Image(context, info);
}

constexpr VkFormat kFormats[] = {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT,
                                 VK_FORMAT_R16G16B16A16_SFLOAT};

/// Writes depth and, with a fragment shader, all targets.
gpu::GraphicsInfo pipeline_info(const gpu::ShaderCode& vertex, const gpu::ShaderCode* fragment) {
  gpu::GraphicsInfo info{&vertex, fragment, {}};
  if (fragment) info.colours = {std::begin(kFormats), std::end(kFormats)};
  return info;
}

/// Behind the depth of all surfaces, for what does not glow.
gpu::GraphicsInfo dull_info() {
  gpu::GraphicsInfo info = pipeline_info(shaders::gbuffer_vert, &shaders::gbuffer_dull_frag);
  info.colours.pop_back();
  info.writes_depth = false;
  return info;
}

bool is_cut(const Draw& draw) {
  return draw.alpha_cutoff > 0;
}

/// Neither cut by a texture nor glowing.
bool is_dull(const SceneResources& scene, const Draw& draw) {
  return !is_cut(draw) && scene.materials[draw.material].constants.emission == glm::vec3(0);
}

void draw_one(gpu::Recorder& recorder, const gpu::Pipeline& pipeline, const SceneResources& scene,
              const GBufferPass::VisibleDraw& visible) {
  const Draw& draw = *visible.draw;
  const auto constants = draw_constants(draw, scene.materials[draw.material].constants, visible.moves);
  recorder.push(pipeline, std::as_bytes(std::span(&constants, 1)));
  recorder.draw_indexed(scene.indices, draw.index_count, draw.first_index, draw.first_vertex);
}

}  // namespace

GBuffer::GBuffer(gpu::Context& context, glm::uvec2 size)
    : albedo_roughness(target_image(context, size, kFormats[0], VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)),
      normal_metallic(target_image(context, size, kFormats[1], VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)),
      emission(target_image(context, size, kFormats[2],
                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT)),
      depth(target_image(context, size, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT)) {}

GBuffer GBuffer::imported(gpu::Context& context, glm::uvec2 size) {
  GBuffer made;
  made.emission = target_image(context, size, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  made.depth = target_image(context, size, VK_FORMAT_R32_SFLOAT, VK_IMAGE_USAGE_STORAGE_BIT);
  return made;
}

void GBuffer::add_imported_normals(gpu::Context& context) {
  normal_metallic =
      target_image(context, glm::uvec2(depth.info().size), kFormats[1], VK_IMAGE_USAGE_STORAGE_BIT);
}

GBufferPass::DepthFirst::DepthFirst(gpu::Context& context)
    : depth(context, pipeline_info(shaders::gbuffer_vert, nullptr)),
      dull(context, dull_info()),
      clear(context, shaders::gbuffer_clear_comp) {}

GBufferPass::GBufferPass(gpu::Context& context) : GBufferPass(context, context.tuning().depth_first) {}

GBufferPass::GBufferPass(gpu::Context& context, bool depth_first)
    : pipeline_(context, pipeline_info(shaders::gbuffer_vert, &shaders::gbuffer_frag)),
      maps_(context, context.tuning().surface_anisotropy) {
  if (!depth_first) return;
  depth_first_.emplace(context);
}

void GBufferPass::draw_materials(gpu::Recorder& recorder, const gpu::GraphicsPipeline& pipeline,
                                 const SceneResources& scene, std::span<const VisibleDraw> draws,
                                 const gpu::Buffer& frame) const {
  std::uint32_t bound = scene::kNone;
  for (const VisibleDraw& visible : draws) {
    const MaterialImages& material = scene.materials[visible.draw->material];
    if (visible.draw->material != bound) {
      recorder.bind_for_draws(pipeline,
                              {
                                  {shared::kBindFrame, gpu::uniform(frame)},
                                  {shared::kBindVertices, gpu::read(scene.vertices)},
                                  {shared::kBindBaseColorMap, maps_.sampled(scene, material.base_color)},
                                  {shared::kBindNormalMap, maps_.sampled(scene, material.normal)},
                                  {shared::kBindRoughnessMap, maps_.sampled(scene, material.roughness)},
                              });
      bound = visible.draw->material;
    }
    draw_one(recorder, pipeline, scene, visible);
  }
}

void GBufferPass::record(gpu::Recorder& recorder, const SceneResources& scene, std::span<const Draw> moving,
                         HiddenObjects hidden, const planning::ViewFrustum& view, const gpu::Buffer& frame,
                         const GBuffer& target) const {
  std::vector<VisibleDraw> draws;
  for (const Draw& draw : scene.draws)
    if (view.may_intersect({draw.centre_world, draw.radius}) && !is_hidden(draw, hidden))
      draws.push_back({&draw, false});
  for (const Draw& draw : moving) draws.push_back({&draw, true});
  std::erase_if(draws, [](const VisibleDraw& visible) { return visible.draw->is_pane; });
  // In an order that every form has, for surfaces in the same place.
  const auto first_other = std::stable_partition(
      draws.begin(), draws.end(), [&](const VisibleDraw& visible) { return is_dull(scene, *visible.draw); });
  const std::span<VisibleDraw> others(first_other, draws.end());

  recorder.prepare_for_draws({gpu::uniform(frame), gpu::read(scene.vertices)});
  maps_.prepare_for_draws(recorder, scene);
  recorder.prepare_indices(scene.indices);
  const glm::uvec2 size(target.depth.info().size);
  gpu::Recorder::Attachments all{{&target.albedo_roughness, &target.normal_metallic, &target.emission},
                                 &target.depth};
  if (depth_first_) {
    const std::span<VisibleDraw> dull(draws.data(), draws.size() - others.size());
    draw_depth_first(recorder, scene, draws, dull, view, frame, target);
    if (others.empty()) return;
    all.keep = 0b111;
    all.keep_depth = true;
  }
  recorder.begin_rendering(all, size);
  draw_materials(recorder, pipeline_, scene, depth_first_ ? others : std::span(draws), frame);
  recorder.end_rendering();
}

/// The depth of all surfaces that no texture cuts, and the materials of the dull ones. No emission: where
/// there are few raster units, each byte of a target costs.
void GBufferPass::draw_depth_first(gpu::Recorder& recorder, const SceneResources& scene,
                                   std::span<const VisibleDraw> draws, std::span<const VisibleDraw> dull,
                                   const planning::ViewFrustum& view, const gpu::Buffer& frame,
                                   const GBuffer& target) const {
  const glm::uvec2 size(target.depth.info().size);
  recorder.bind(depth_first_->clear, {{shared::kBindEmission, gpu::stored(target.emission)}});
  recorder.dispatch_threads(depth_first_->clear, size.x, size.y);
  recorder.begin_rendering({{}, &target.depth}, size);
  draw_depth(recorder, scene, {draws.begin(), draws.end()}, view, frame);
  recorder.end_rendering();
  gpu::Recorder::Attachments attachments{{&target.albedo_roughness, &target.normal_metallic}, &target.depth};
  attachments.keep_depth = attachments.overwrite = true;
  recorder.begin_rendering(attachments, size);
  draw_materials(recorder, depth_first_->dull, scene, dull, frame);
  recorder.end_rendering();
}

/// The depth of all surfaces that no texture cuts, the nearest first.
void GBufferPass::draw_depth(gpu::Recorder& recorder, const SceneResources& scene,
                             std::vector<VisibleDraw> draws, const planning::ViewFrustum& view,
                             const gpu::Buffer& frame) const {
  const auto distance = [&](const VisibleDraw& visible) {
    return visible.moves ? 0 : view.distance_to({visible.draw->centre_world, visible.draw->radius});
  };
  std::ranges::stable_sort(draws, {}, distance);
  recorder.bind_for_draws(depth_first_->depth, {{shared::kBindFrame, gpu::uniform(frame)},
                                                {shared::kBindVertices, gpu::read(scene.vertices)}});
  for (const VisibleDraw& visible : draws)
    if (!is_cut(*visible.draw)) draw_one(recorder, depth_first_->depth, scene, visible);
}

}  // namespace brume::passes
