#include "passes/gbuffer.hpp"

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

/// Floors stay sharp towards the horizon; 16 looks the same. Without a GPU it would double the time of the pass.
float anisotropy_on(const gpu::Context& context) {
  return context.info().kind == "cpu" ? 1 : 8;
}

shared::DrawConstants constants_of(const Draw& draw, const shared::MaterialConstants& material, bool moves) {
  const glm::mat4 rows = glm::transpose(draw.world_from_mesh);
  return {rows[0], rows[1], rows[2], material, moves ? 1.0f : 0.0f};
}

/// Writes depth and, with a fragment shader, all targets.
gpu::GraphicsInfo pipeline_info(const gpu::ShaderCode& vertex, const gpu::ShaderCode* fragment) {
  gpu::GraphicsInfo info{&vertex, fragment, {}};
  if (fragment) info.colours = {std::begin(kFormats), std::end(kFormats)};
  return info;
}

bool is_cut(const shared::MaterialConstants& material) {
  return material.alpha_cutoff > 0;
}

void draw_one(gpu::Recorder& recorder, const gpu::Pipeline& pipeline, const SceneResources& scene,
              const GBufferPass::VisibleDraw& visible) {
  const Draw& draw = *visible.draw;
  const auto constants = constants_of(draw, scene.materials[draw.material].constants, visible.moves);
  recorder.push(pipeline, std::as_bytes(std::span(&constants, 1)));
  recorder.draw_indexed(scene.indices, draw.index_count, draw.first_index, draw.first_vertex);
}

}  // namespace

GBuffer::GBuffer(gpu::Context& context, glm::uvec2 size)
    : albedo_roughness(target_image(context, size, kFormats[0], VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)),
      normal_metallic(target_image(context, size, kFormats[1], VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)),
      emission(target_image(context, size, kFormats[2], VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)),
      depth(target_image(context, size, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT)) {}

GBufferPass::DepthFirst::DepthFirst(gpu::Context& context)
    : depth(context, pipeline_info(shaders::gbuffer_vert, nullptr)),
      background(context,
                 pipeline_info(shaders::gbuffer_background_vert, &shaders::gbuffer_background_frag)) {}

GBufferPass::GBufferPass(gpu::Context& context) : GBufferPass(context, context.info().kind != "cpu") {}

GBufferPass::GBufferPass(gpu::Context& context, bool depth_first)
    : pipeline_(context, pipeline_info(shaders::gbuffer_vert, &shaders::gbuffer_frag)),
      sampler_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT, true, false, anisotropy_on(context)}) {
  if (!depth_first) return;
  depth_first_.emplace(context);
}

void GBufferPass::draw_materials(gpu::Recorder& recorder, const SceneResources& scene,
                                 std::span<const VisibleDraw> draws, const gpu::Buffer& frame) const {
  std::uint32_t bound = scene::kNone;
  for (const VisibleDraw& visible : draws) {
    const MaterialImages& material = scene.materials[visible.draw->material];
    if (visible.draw->material != bound) {
      recorder.bind_for_draws(
          pipeline_,
          {
              {shared::kBindFrame, gpu::uniform(frame)},
              {shared::kBindVertices, gpu::read(scene.vertices)},
              {shared::kBindBaseColorMap, gpu::sampled(scene.images[material.base_color], sampler_)},
              {shared::kBindNormalMap, gpu::sampled(scene.images[material.normal], sampler_)},
              {shared::kBindRoughnessMap, gpu::sampled(scene.images[material.roughness], sampler_)},
          });
      bound = visible.draw->material;
    }
    draw_one(recorder, pipeline_, scene, visible);
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

  recorder.prepare_for_draws({gpu::uniform(frame), gpu::read(scene.vertices)});
  for (const gpu::Image& image : scene.images) recorder.prepare_for_draws({gpu::sampled(image, sampler_)});
  recorder.prepare_indices(scene.indices);
  const glm::uvec2 size(target.depth.info().size);
  gpu::Recorder::Attachments attachments{{}, &target.depth};
  if (depth_first_) {
    recorder.begin_rendering(attachments, size);
    draw_depth(recorder, scene, draws, frame);
    recorder.end_rendering();
    attachments.keep_depth = attachments.overwrite = true;
  }
  attachments.colours = {&target.albedo_roughness, &target.normal_metallic, &target.emission};
  recorder.begin_rendering(attachments, size);
  if (depth_first_) {
    // Instead of a clear, which would cost as much as another surface where there are few raster units.
    recorder.bind_for_draws(depth_first_->background, {});
    recorder.draw(3);
  }
  draw_materials(recorder, scene, draws, frame);
  recorder.end_rendering();
}

/// The depth of all surfaces that no texture cuts.
void GBufferPass::draw_depth(gpu::Recorder& recorder, const SceneResources& scene,
                             std::span<const VisibleDraw> draws, const gpu::Buffer& frame) const {
  recorder.bind_for_draws(depth_first_->depth, {{shared::kBindFrame, gpu::uniform(frame)},
                                                {shared::kBindVertices, gpu::read(scene.vertices)}});
  for (const VisibleDraw& visible : draws)
    if (!is_cut(scene.materials[visible.draw->material].constants))
      draw_one(recorder, depth_first_->depth, scene, visible);
}

}  // namespace brume::passes
