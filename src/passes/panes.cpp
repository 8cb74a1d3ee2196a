#include "passes/panes.hpp"

#include <algorithm>

#include "brume_shaders.hpp"
#include "shared/frame.h"
#include "shared/indirect_light.h"
#include "shared/layers.h"
#include "shared/resolve.h"

namespace brume::passes {
namespace {

/// What the pipelines differ by.
constexpr std::uint32_t kPaneMedia = shared::kMediaOfDepths;

gpu::GraphicsInfo pane_info(const gpu::ShaderCode& fragment, gpu::Blend blend) {
  gpu::GraphicsInfo info{&shaders::gbuffer_vert, &fragment, {VK_FORMAT_R16G16B16A16_SFLOAT}};
  info.blend = blend;
  info.writes_depth = false;
  return info;
}

/// From back to front, by the nearest points of their bounds: a pane within another comes before it. What
/// moves comes last.
std::vector<const Draw*> in_order(const VisiblePanes& panes) {
  std::vector<const Draw*> draws;
  for (const Draw& draw : panes.scene.draws)
    if (draw.is_pane && panes.view.may_intersect({draw.centre_world, draw.radius}) &&
        !is_hidden(draw, panes.hidden))
      draws.push_back(&draw);
  const auto nearest = [&](const Draw* draw) {
    return glm::dot(draw->centre_world, panes.forward) - glm::dot(draw->half_world, glm::abs(panes.forward));
  };
  std::ranges::stable_sort(draws, std::greater{}, nearest);
  for (const Draw& draw : panes.moving)
    if (draw.is_pane) draws.push_back(&draw);
  return draws;
}

// Without tanks neither is read.
const gpu::Image& layers_of(const PanePass::Inputs& in) {
  return in.tanks ? in.tanks->layers : in.smoke;
}
const gpu::Image& layer_depth_of(const PanePass::Inputs& in) {
  return in.tanks ? in.tanks->depth : in.smoke;
}

}  // namespace

PanePass::PanePass(gpu::Context& context)
    : context_(context),
      filter_(context, pane_info(shaders::panes_filter_frag, gpu::Blend::filter)),
      maps_(context, 1),
      nearest_(context, {VK_FILTER_NEAREST}),
      linear_(context, {}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}) {}

void PanePass::reserve(const Needs& needs) {
  const Needs own{needs.voxel_shadows, needs.media & kPaneMedia, needs.tanks};
  if (shine_.contains(own)) return;
  gpu::GraphicsInfo info = pane_info(shaders::panes_shine_frag, gpu::Blend::add);
  info.constants = {own.media, own.voxel_shadows ? 1u : 0u, own.tanks ? 1u : 0u};
  shine_.try_emplace(own, context_, info);
}

void PanePass::prepare(gpu::Recorder& recorder, const gpu::GraphicsPipeline& shine, const Inputs& in,
                       const SceneResources& scene) const {
  recorder.prepare_for_draws(
      {gpu::uniform(in.frame), gpu::read(scene.vertices), gpu::read(scene.lights),
       gpu::uniform(in.shadows.sun), gpu::sampled(in.shadows.layers, compare_),
       gpu::sampled(in.shadows.sun_map, compare_), gpu::sampled(in.smoke_shadows.atlas, linear_),
       gpu::read(in.smoke_shadows.faces), gpu::sampled(in.smoke, nearest_),
       gpu::sampled(layers_of(in), nearest_), gpu::sampled(layer_depth_of(in), nearest_),
       gpu::sampled(in.level.sky.light(), linear_), gpu::sampled(in.level.indirect_cube, linear_),
       gpu::sampled(in.level.solid.texels(), linear_)});
  recorder.prepare_for_draws(shine, {in.media.bindings()}, {});
  maps_.prepare_for_draws(recorder, scene);
  recorder.prepare_indices(scene.indices);
}

void PanePass::record(gpu::Recorder& recorder, const Needs& needs, const Inputs& in,
                      const VisiblePanes& panes, const gpu::Image& radiance) const {
  const std::vector<const Draw*> draws = in_order(panes);
  if (draws.empty()) return;
  const gpu::GraphicsPipeline& shine =
      shine_.at({needs.voxel_shadows, needs.media & kPaneMedia, needs.tanks});
  prepare(recorder, shine, in, panes.scene);
  gpu::Recorder::Attachments attachments{{&radiance}, &in.depth};
  attachments.keep = 0b1;
  attachments.keep_depth = true;
  recorder.begin_rendering(attachments, glm::uvec2(radiance.info().size));
  for (const Draw* const one : draws) draw(recorder, shine, in, panes.scene, *one);
  recorder.end_rendering();
}

void PanePass::draw(gpu::Recorder& recorder, const gpu::GraphicsPipeline& shine, const Inputs& in,
                    const SceneResources& scene, const Draw& draw) const {
  const MaterialImages& material = scene.materials[draw.material];
  const shared::DrawConstants constants = draw_constants(draw, material.constants, false);
  const auto draw_with = [&](const gpu::GraphicsPipeline& pipeline) {
    recorder.push(pipeline, std::as_bytes(std::span(&constants, 1)));
    recorder.draw_indexed(scene.indices, draw.index_count, draw.first_index, draw.first_vertex);
  };
  const auto base_color = maps_.sampled(scene, material.base_color),
             normal = maps_.sampled(scene, material.normal),
             roughness = maps_.sampled(scene, material.roughness);

  // What is behind, filtered by the pane; then what the pane itself sends, added.
  recorder.bind_for_draws(filter_, {
                                       {shared::kBindFrame, gpu::uniform(in.frame)},
                                       {shared::kBindVertices, gpu::read(scene.vertices)},
                                       {shared::kBindBaseColorMap, base_color},
                                       {shared::kBindNormalMap, normal},
                                   });
  draw_with(filter_);
  recorder.bind_for_draws(shine, {in.media.bindings()},
                          {
                              {shared::kBindFrame, gpu::uniform(in.frame)},
                              {shared::kBindVertices, gpu::read(scene.vertices)},
                              {shared::kBindBaseColorMap, base_color},
                              {shared::kBindNormalMap, normal},
                              {shared::kBindRoughnessMap, roughness},
                              {shared::kBindLights, gpu::read(scene.lights)},
                              {shared::kBindSun, gpu::uniform(in.shadows.sun)},
                              {shared::kBindShadowMaps, gpu::sampled(in.shadows.layers, compare_)},
                              {shared::kBindSunMap, gpu::sampled(in.shadows.sun_map, compare_)},
                              {shared::kBindSmokeShadows, gpu::sampled(in.smoke_shadows.atlas, linear_)},
                              {shared::kBindSmokeShadowFaces, gpu::read(in.smoke_shadows.faces)},
                              {shared::kBindSmoke, gpu::sampled(in.smoke, nearest_)},
                              {shared::kBindLayers, gpu::sampled(layers_of(in), nearest_)},
                              {shared::kBindLayerDepth, gpu::sampled(layer_depth_of(in), nearest_)},
                              {shared::kBindSkyLight, gpu::sampled(in.level.sky.light(), linear_)},
                              {shared::kBindIndirectCube, gpu::sampled(in.level.indirect_cube, linear_)},
                              {shared::kBindSolidTexels, gpu::sampled(in.level.solid.texels(), linear_)},
                          });
  draw_with(shine);
}

}  // namespace brume::passes
