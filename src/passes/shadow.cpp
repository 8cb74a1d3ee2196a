#include "passes/shadow.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_D32_SFLOAT;
constexpr float kSunTexel = 0.05f;  ///< Edge of a texel of the sun's map, where memory allows [m].
/// Layers that are drawn in one submission: waiting for each would take longer than to draw it, and the
/// commands of all at once could take any memory.
constexpr std::size_t kLayersOfSubmission = 32;

std::uint32_t layer_count(const SceneResources& scene) {
  std::uint32_t count = 0;
  for (const shared::Light& light : scene.light_list) {
    if (light.shadow_layer == shared::kNoShadow || light.kind == shared::kLightDirectional) continue;
    count = std::max(count, light.shadow_layer + 6);
  }
  return count;
}

/// A light's face: reverse depth with the far plane at infinity.
glm::mat4 face_clip_from_world(const shared::Light& light, std::uint32_t face) {
  const glm::vec3 right = shared::cube_right(face), down = -shared::cube_up(face),
                  forward = shared::cube_forward(face);
  const glm::vec3 p = light.position_world;
  glm::mat4 rows(0);
  rows[0] = glm::vec4(right, -glm::dot(right, p));
  rows[1] = glm::vec4(down, -glm::dot(down, p));
  rows[2] = glm::vec4(0, 0, 0, shared::kShadowNear);
  rows[3] = glm::vec4(forward, -glm::dot(forward, p));
  return glm::transpose(rows);
}

float radius_of(const SceneResources& scene) {
  return std::max(1.0f, 0.5f * glm::length(scene.bounds_max - scene.bounds_min));
}

/// Whether anything can cast a shadow.
bool has_surfaces(const SceneResources& scene) {
  return glm::all(glm::lessThanEqual(scene.bounds_min, scene.bounds_max));
}

/// The whole scene along a direction: depth 1 at the near side, 0 at the far side.
glm::mat4 sun_view(const SceneResources& scene, glm::vec3 direction) {
  // All points in the middle of the map, at the far side.
  if (!has_surfaces(scene)) return glm::mat4(glm::vec4(0), glm::vec4(0), glm::vec4(0), glm::vec4(0, 0, 0, 1));
  const glm::vec3 centre = 0.5f * (scene.bounds_min + scene.bounds_max);
  const float radius = radius_of(scene);
  const glm::vec3 helper = std::abs(direction.y) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(direction, helper)), down = glm::cross(direction, right);
  glm::mat4 rows(0);
  rows[0] = glm::vec4(right, -glm::dot(right, centre)) / radius;
  rows[1] = glm::vec4(down, -glm::dot(down, centre)) / radius;
  rows[2] = glm::vec4(-direction, glm::dot(direction, centre) + radius) / (2 * radius);
  rows[3] = glm::vec4(0, 0, 0, 1);
  return glm::transpose(rows);
}

/// Whether a bounding sphere may be visible from a light in one face of its cube, within its range.
bool face_sees(const shared::Light& light, std::uint32_t face, const Draw& draw) {
  const glm::vec3 d = draw.centre_world - light.position_world;
  if (glm::length(d) > light.range + draw.radius) return false;
  const float along = glm::dot(d, shared::cube_forward(face));
  const float aside =
      std::max(std::abs(glm::dot(d, shared::cube_right(face))), std::abs(glm::dot(d, shared::cube_up(face))));
  return aside - along <= 1.4143f * draw.radius;  // outside of a 45 degree plane by more than the radius
}

}  // namespace

std::uint32_t shadow_size(std::uint32_t layers) {
  return layers <= 64 ? 512 : layers <= 400 ? 256 : 128;
}

std::uint32_t sun_map_size(float radius) {
  return std::bit_ceil(
      static_cast<std::uint32_t>(std::ceil(std::clamp(2 * radius / kSunTexel, 512.0f, 4096.0f))));
}

// Surfaces are pushed away from the light by so many texels of their slope. A comparison of 2 x 2 texels
// needs two where they slope along both axes of the map; with fine texels one is enough, as lookups are 7 cm
// off the surface (lib/surface_lights.glsl).
ShadowPass::ShadowPass(gpu::Context& context)
    : pipelines_(make_pipelines(context, 2)),
      fine_pipelines_(make_pipelines(context, 1)),
      maps_(context, 1) {}

ShadowPass::Pipelines ShadowPass::make_pipelines(gpu::Context& context, float slope) {
  return {{context, {&shaders::shadow_vert, nullptr, {}, kFormat, slope, 0}},
          {context, {&shaders::shadow_cut_vert, &shaders::shadow_cut_frag, {}, kFormat, slope, 0}}};
}

ShadowMaps ShadowPass::make_maps(gpu::Context& context, const SceneResources& scene) const {
  ShadowMaps maps;
  const std::uint32_t layers = layer_count(scene);
  gpu::ImageInfo info;
  info.format = kFormat;
  info.size = {glm::uvec2(layers > 0 ? shadow_size(layers) : 1), 1};
  info.layers = std::max(layers, 2u);  // an array, whatever the lights
  info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  maps.layers = gpu::Image(context, info);
  info.layers = 1;
  info.size = glm::uvec3(1);
  maps.sun = gpu::Buffer(context, sizeof(shared::ShadowView),
                         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  for (const shared::Light& light : scene.light_list) {
    if (light.kind != shared::kLightDirectional || light.shadow_layer == shared::kNoShadow) continue;
    maps.sun_clip_from_world = sun_view(scene, light.direction);
    if (has_surfaces(scene)) info.size = {glm::uvec2(sun_map_size(radius_of(scene))), 1};
  }
  maps.sun_map = gpu::Image(context, info);
  return maps;
}

void ShadowPass::record(gpu::Context& context, gpu::CommandStream& stream, const SceneResources& scene,
                        HiddenObjects hidden, const ShadowMaps& maps) const {
  stream.run([&](gpu::Recorder& recorder) {
    const shared::ShadowView sun{maps.sun_clip_from_world, glm::inverse(maps.sun_clip_from_world)};
    recorder.upload(maps.sun, 0, std::as_bytes(std::span(&sun, 1)));
  });
  record_layers(context, stream, scene, hidden, maps, [](const Sees&) { return true; });
}

void ShadowPass::record_changed(gpu::Context& context, gpu::CommandStream& stream,
                                const SceneResources& scene, HiddenObjects hidden,
                                std::span<const std::uint32_t> changed, const ShadowMaps& maps) const {
  record_layers(context, stream, scene, hidden, maps, [&](const Sees& sees) {
    return std::any_of(scene.draws.begin(), scene.draws.end(),
                       [&](const Draw& draw) { return is_hidden(draw, changed) && sees(draw); });
  });
}

void ShadowPass::record_layers(gpu::Context& context, gpu::CommandStream& stream, const SceneResources& scene,
                               HiddenObjects hidden, const ShadowMaps& maps,
                               const std::function<bool(const Sees&)>& accepts) const {
  std::vector<Layer> layers;
  const auto add = [&](std::optional<std::uint32_t> index, const glm::mat4& clip_from_world,
                       const Sees& sees) {
    if (!accepts(sees)) return;
    Layer& layer = layers.emplace_back(Layer{index, clip_from_world});
    for (const Draw& draw : scene.draws)
      if (!draw.is_pane && !is_hidden(draw, hidden) && sees(draw))
        (draw.alpha_cutoff > 0 ? layer.cut : layer.whole).push_back(&draw);
  };
  for (const shared::Light& light : scene.light_list) {
    if (light.shadow_layer == shared::kNoShadow) continue;
    if (light.kind == shared::kLightDirectional) {
      add(std::nullopt, maps.sun_clip_from_world, [](const Draw&) { return true; });
      continue;
    }
    for (std::uint32_t face = 0; face < 6; ++face)
      add(light.shadow_layer + face, face_clip_from_world(light, face),
          [&](const Draw& draw) { return face_sees(light, face, draw); });
  }

  const float sun_texel = 2 * radius_of(scene) / static_cast<float>(maps.sun_map.info().size.x);
  const Pipelines& sun_pipelines = sun_texel <= 2 * kSunTexel ? fine_pipelines_ : pipelines_;

  // The views of a submission live until the device is done with it.
  std::vector<gpu::LayerView> views;
  for (std::size_t first = 0; first < layers.size(); first += kLayersOfSubmission) {
    const auto some = std::span(layers).subspan(first, std::min(kLayersOfSubmission, layers.size() - first));
    views.clear();
    for (const Layer& layer : some) views.emplace_back(context, maps.layers, layer.index.value_or(0));
    stream.run([&](gpu::Recorder& recorder) {
      for (std::size_t i = 0; i < some.size(); ++i) {
        if (some[i].index)
          record_layer(recorder, scene, some[i], pipelines_, maps.layers, views[i].handle());
        else
          record_layer(recorder, scene, some[i], sun_pipelines, maps.sun_map, maps.sun_map.view());
      }
    });
  }
}

void ShadowPass::record_layer(gpu::Recorder& recorder, const SceneResources& scene, const Layer& layer,
                              const Pipelines& pipelines, const gpu::Image& map, VkImageView view) const {
  const auto draw_one = [&](const gpu::GraphicsPipeline& pipeline, const Draw& draw) {
    const shared::ShadowDraw constants{layer.clip_from_world * draw.world_from_mesh, draw.alpha_cutoff};
    recorder.push(pipeline, std::as_bytes(std::span(&constants, 1)));
    recorder.draw_indexed(scene.indices, draw.index_count, draw.first_index, draw.first_vertex);
  };
  const auto map_of = [&](const Draw& draw) {
    return maps_.sampled(scene, scene.materials[draw.material].base_color);
  };
  recorder.prepare_for_draws({gpu::read(scene.vertices)});
  for (const Draw* const draw : layer.cut) recorder.prepare_for_draws({map_of(*draw)});
  recorder.prepare_indices(scene.indices);
  recorder.begin_rendering({{}, &map, view}, glm::uvec2(map.info().size));
  recorder.bind_for_draws(pipelines.whole, {{shared::kBindVertices, gpu::read(scene.vertices)}});
  for (const Draw* const draw : layer.whole) draw_one(pipelines.whole, *draw);
  for (const Draw* const draw : layer.cut) {
    recorder.bind_for_draws(pipelines.cut, {{shared::kBindVertices, gpu::read(scene.vertices)},
                                            {shared::kBindBaseColorMap, map_of(*draw)}});
    draw_one(pipelines.cut, *draw);
  }
  recorder.end_rendering();
}

}  // namespace brume::passes
