#include "passes/scene_upload.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "planning/device_lights.hpp"

namespace brume::passes {
namespace {

constexpr std::uint32_t kMaxShadowLayers = 2046;  // maxImageArrayLayers is at least 2048 where it matters

gpu::Image upload_image(gpu::Context& context, gpu::Recorder& recorder, const image::Image8& pixels,
                        bool srgb) {
  gpu::ImageInfo info = gpu::sampled_image({pixels.width, pixels.height},
                                           srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
                                           VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  info.mip_levels = static_cast<std::uint32_t>(std::bit_width(std::max(pixels.width, pixels.height)));
  gpu::Image image(context, info);
  const gpu::Recorder::Region all{std::as_bytes(std::span(pixels.rgba)), glm::ivec3(0), info.size};
  recorder.upload(image, {&all, 1});
  recorder.make_mip_levels(image);
  return image;
}

image::Image8 single_texel(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  return {1, 1, {r, g, b, 255}};
}

std::uint32_t unorm16_pair(float low, float high) {
  const auto unorm16 = [](float value) {
    return static_cast<std::uint32_t>(std::clamp(value, 0.0f, 1.0f) * 65535.0f + 0.5f);
  };
  return unorm16(low) | unorm16(high) << 16;
}

shared::Vertex device_vertex(const scene::Vertex& vertex) {
  const glm::vec4 rest = 1.0f - vertex.color;
  return {vertex.position,
          vertex.normal,
          vertex.tangent,
          vertex.uv,
          {unorm16_pair(rest.r, rest.g), unorm16_pair(rest.b, rest.a)}};
}

/// Meshes one after the other in shared buffers.
struct Geometry {
  std::vector<shared::Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<Draw> ranges;  // a mesh each
};

Geometry gather_geometry(const scene::Scene& scene) {
  Geometry geometry;
  for (const scene::Mesh& mesh : scene.meshes) {
    Draw range;
    range.first_index = static_cast<std::uint32_t>(geometry.indices.size());
    range.index_count = static_cast<std::uint32_t>(mesh.indices.size());
    range.first_vertex = static_cast<std::int32_t>(geometry.vertices.size());
    Box<float> bounds = kEmptyBox;
    for (const scene::Vertex& v : mesh.vertices) {
      geometry.vertices.push_back(device_vertex(v));
      bounds.low = glm::min(bounds.low, v.position);
      bounds.high = glm::max(bounds.high, v.position);
    }
    range.centre_world = bounds.empty() ? glm::vec3(0) : 0.5f * (bounds.low + bounds.high);
    range.half_world = bounds.empty() ? glm::vec3(0) : 0.5f * (bounds.high - bounds.low);
    range.radius = glm::length(range.half_world);
    geometry.indices.insert(geometry.indices.end(), mesh.indices.begin(), mesh.indices.end());
    geometry.ranges.push_back(range);
  }
  return geometry;
}

Draw place(const scene::Scene& scene, const Geometry& geometry, const scene::Object& object) {
  Draw draw = geometry.ranges[object.mesh];
  draw.material = object.material;
  draw.is_pane = scene::is_pane(object);
  draw.alpha_cutoff = scene::cutoff_of(object, scene.materials[object.material]);
  draw.world_from_mesh = object.world_from_mesh;
  draw.centre_world = glm::vec3(object.world_from_mesh * glm::vec4(draw.centre_world, 1));
  float scale = 0;
  for (int axis = 0; axis < 3; ++axis)
    scale = std::max(scale, glm::length(glm::vec3(object.world_from_mesh[axis])));
  draw.radius *= scale;
  const glm::mat3 linear(object.world_from_mesh);
  draw.half_world =
      glm::mat3(glm::abs(linear[0]), glm::abs(linear[1]), glm::abs(linear[2])) * draw.half_world;
  return draw;
}

template <typename T>
gpu::Buffer upload_list(gpu::Context& context, gpu::Recorder& recorder, const std::vector<T>& list,
                        VkBufferUsageFlags usage) {
  gpu::Buffer buffer(context, std::max<std::size_t>(list.size(), 1) * sizeof(T),
                     usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  recorder.upload(buffer, 0, std::as_bytes(std::span(list)));
  return buffer;
}

/// The scene's images and the three stand-ins, sRGB where a material uses them as a colour.
void upload_images(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene,
                   SceneResources& out) {
  std::vector<bool> is_colour(scene.images.size(), false);
  for (const scene::Material& material : scene.materials) {
    if (material.base_color_image != scene::kNone) is_colour[material.base_color_image] = true;
  }
  stream.run([&](gpu::Recorder& recorder) {
    for (const auto& texel :
         {single_texel(255, 255, 255), single_texel(128, 128, 255), single_texel(255, 255, 255)}) {
      out.images.push_back(upload_image(context, recorder, texel, false));
      out.wraps.emplace_back();
    }
  });
  // One submission an image: staging memory stays small.
  Progress job("upload", scene.images.size());
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    stream.run([&](gpu::Recorder& recorder) {
      out.images.push_back(upload_image(context, recorder, scene.images[i].pixels, is_colour[i]));
      out.wraps.push_back(scene.images[i].wraps);
    });
    job.advance();
  }
}

MaterialImages device_material(const scene::Material& material) {
  MaterialImages out;
  out.constants = {
      material.base_color,   material.roughness,
      material.emission,     material.metallic,
      material.alpha_cutoff, {material.opacity, material.transmission, material.blended ? 1.0f : 0.0f}};
  constexpr std::uint32_t kStandIns = 3;
  const auto index = [](std::uint32_t image, std::uint32_t stand_in) {
    return image == scene::kNone ? stand_in : image + kStandIns;
  };
  out.base_color = index(material.base_color_image, 0);
  out.normal = index(material.normal_image, 1);
  out.roughness = index(material.roughness_image, 2);
  return out;
}

}  // namespace

shared::DrawConstants draw_constants(const Draw& draw, const shared::MaterialConstants& material,
                                     bool moves) {
  const glm::mat4 rows = glm::transpose(draw.world_from_mesh);
  shared::DrawConstants constants{{rows[0], rows[1], rows[2]}, material, moves ? 1.0f : 0.0f};
  constants.material.alpha_cutoff = draw.alpha_cutoff;
  return constants;
}

void upload_lights(gpu::Context& context, gpu::CommandStream& stream, const std::vector<scene::Light>& lights,
                   SceneResources& scene) {
  scene.light_list =
      planning::device_lights(lights, std::min(kMaxShadowLayers, context.limits().maxImageArrayLayers));
  // With room for flashes.
  scene.lights = gpu::Buffer(context, (scene.light_list.size() + kMaxFlashes) * sizeof(shared::Light),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  stream.run([&](gpu::Recorder& recorder) {
    recorder.upload(scene.lights, 0, std::as_bytes(std::span(scene.light_list)));
  });
}

SceneResources upload_scene(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene) {
  SceneResources out;
  const Geometry geometry = gather_geometry(scene);
  upload_lights(context, stream, scene.lights, out);

  // Geometry and textures.
  stream.run([&](gpu::Recorder& recorder) {
    out.vertices = upload_list(context, recorder, geometry.vertices, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    out.indices = upload_list(context, recorder, geometry.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  });
  upload_images(context, stream, scene, out);
  for (const scene::Material& material : scene.materials) out.materials.push_back(device_material(material));

  // Draws in order of material, and which of them emit.
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i)
    out.draws.emplace_back(place(scene, geometry, scene.objects[i])).object = i;
  for (const Draw& draw : out.draws) {
    const glm::vec3& emission = scene.materials[draw.material].emission;
    if (const float brightest = std::max({emission.r, emission.g, emission.b}); brightest > 0)
      out.emitters.push_back({{draw.centre_world, draw.radius}, draw.object, brightest});
  }
  std::stable_sort(out.draws.begin(), out.draws.end(),
                   [](const Draw& a, const Draw& b) { return a.material < b.material; });
  out.has_panes = std::ranges::any_of(out.draws, &Draw::is_pane);
  if (scene.grenade) out.grenade = place(scene, geometry, *scene.grenade);
  const Box<float> bounds = scene::world_bounds(scene);
  out.bounds_min = bounds.low;
  out.bounds_max = bounds.high;
  return out;
}

}  // namespace brume::passes
