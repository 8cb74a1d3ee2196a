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

shared::DrawConstants constants_of(const Draw& draw, const shared::MaterialConstants& material, bool moves) {
  const glm::mat4 rows = glm::transpose(draw.world_from_mesh);
  return {rows[0], rows[1], rows[2], material, moves ? 1.0f : 0.0f};
}

}  // namespace

GBuffer::GBuffer(gpu::Context& context, glm::uvec2 size)
    : albedo_roughness(target_image(context, size, kFormats[0], VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)),
      normal_metallic(target_image(context, size, kFormats[1], VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)),
      emission(target_image(context, size, kFormats[2], VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)),
      depth(target_image(context, size, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT)) {}

GBufferPass::GBufferPass(gpu::Context& context)
    : pipeline_(context,
                {&shaders::gbuffer_vert, &shaders::gbuffer_frag, {std::begin(kFormats), std::end(kFormats)}}),
      sampler_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT, true}) {}

void GBufferPass::record(gpu::Recorder& recorder, const SceneResources& scene, std::span<const Draw> moving,
                         HiddenObjects hidden, const planning::ViewFrustum& view, const gpu::Buffer& frame,
                         const GBuffer& target) const {
  recorder.prepare_for_draws({gpu::uniform(frame), gpu::read(scene.vertices)});
  for (const gpu::Image& image : scene.images) recorder.prepare_for_draws({gpu::sampled(image, sampler_)});
  recorder.prepare_indices(scene.indices);
  const glm::uvec2 size(target.depth.info().size);
  recorder.begin_rendering(
      {{&target.albedo_roughness, &target.normal_metallic, &target.emission}, &target.depth, {}}, size);
  std::uint32_t bound = scene::kNone;
  const auto draw_one = [&](const Draw& draw, bool moves) {
    const MaterialImages& material = scene.materials[draw.material];
    if (draw.material != bound) {
      recorder.bind_for_draws(
          pipeline_,
          {
              {shared::kBindFrame, gpu::uniform(frame)},
              {shared::kBindVertices, gpu::read(scene.vertices)},
              {shared::kBindBaseColorMap, gpu::sampled(scene.images[material.base_color], sampler_)},
              {shared::kBindNormalMap, gpu::sampled(scene.images[material.normal], sampler_)},
              {shared::kBindRoughnessMap, gpu::sampled(scene.images[material.roughness], sampler_)},
          });
      bound = draw.material;
    }
    const auto constants = constants_of(draw, material.constants, moves);
    recorder.push(pipeline_, std::as_bytes(std::span(&constants, 1)));
    recorder.draw_indexed(scene.indices, draw.index_count, draw.first_index, draw.first_vertex);
  };
  for (const Draw& draw : scene.draws)
    if (view.may_intersect({draw.centre_world, draw.radius}) && !is_hidden(draw, hidden))
      draw_one(draw, false);
  for (const Draw& draw : moving) draw_one(draw, true);
  recorder.end_rendering();
}

}  // namespace brume::passes
