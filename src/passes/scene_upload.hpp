// The scene on the device: vertices, textures and lights, uploaded once.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "gpu/recorder.hpp"
#include "planning/frame_input.hpp"
#include "planning/opaque_limit.hpp"
#include "scene/scene.hpp"
#include "shared/gbuffer.h"
#include "shared/light.h"

namespace brume::passes {

/// One draw: a range of the index buffer with a material and a transform.
struct Draw {
  std::uint32_t first_index = 0, index_count = 0;
  std::int32_t first_vertex = 0;
  std::uint32_t material = 0;
  std::uint32_t object = scene::kNone;  ///< Index into Scene::objects.
  glm::mat4 world_from_mesh{1};
  glm::vec3 centre_world{0};  ///< Bounding sphere.
  float radius = 0;
  glm::vec3 half_world{0};  ///< Half of the edges of the bounding box.
  float alpha_cutoff = 0;   ///< scene::cutoff_of.
  bool is_pane = false;     ///< PanePass draws it: not in the G-buffer, casts no shadow.
};

/// `moves`: over the level.
shared::DrawConstants draw_constants(const Draw& draw, const shared::MaterialConstants& material, bool moves);

/// Objects that are not drawn, in ascending order.
using HiddenObjects = std::span<const std::uint32_t>;

inline bool is_hidden(const Draw& draw, HiddenObjects hidden) {
  return std::binary_search(hidden.begin(), hidden.end(), draw.object);
}

struct MaterialImages {
  shared::MaterialConstants constants;
  std::uint32_t base_color = 0, normal = 0, roughness = 0;  ///< Into SceneResources::images.
};

using planning::kMaxFlashes;  // capacity for temporary lights behind the scene's

struct SceneResources {
  gpu::Buffer vertices, indices, lights;
  std::vector<gpu::Image> images;   ///< The first three: white, flat normal, white.
  std::vector<scene::Wraps> wraps;  ///< By image.
  std::vector<MaterialImages> materials;
  std::vector<Draw> draws;                  ///< In order of material.
  Draw grenade;                             ///< Draws nothing where the scene has none.
  std::vector<shared::Light> light_list;    ///< The first ones in `lights`; temporary lights follow.
  bool has_panes = false;                   ///< Whether any of `draws` is one.
  std::vector<planning::Emitter> emitters;  ///< Bounds of the `draws` that emit.
  glm::vec3 bounds_min{0}, bounds_max{0};
};

/// Creates and uploads everything. Every index of the scene must be valid. Throws resource_limit.
SceneResources upload_scene(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene);
/// Other lights in the place of the scene's. Throws resource_limit.
void upload_lights(gpu::Context& context, gpu::CommandStream& stream, const std::vector<scene::Light>& lights,
                   SceneResources& scene);

}  // namespace brume::passes
