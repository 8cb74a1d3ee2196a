#include <algorithm>
#include <cmath>

#include "core/log.hpp"
#include "scene/gltf_parts.hpp"

namespace brume::scene {
namespace {

/// IEC 61966-2-1.
double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace

GltfMaterials::GltfMaterials(const GltfDocument& document, SceneBuilder& builder)
    : document_(document), builder_(builder) {}

GltfMaterials::Converted GltfMaterials::material(int index) {
  if (const auto known = materials_.find(index); known != materials_.end()) return known->second;
  Converted converted;
  Material material;
  material.name = "default";
  material.base_color = glm::vec3(0.6f);
  if (index >= 0) {
    const auto at = static_cast<std::size_t>(index);
    material = convert(document_.model().materials[at], document_.place("materials", at), converted.uv_set);
    if (material.name.empty()) material.name = "material " + std::to_string(index);
  }
  converted.index = static_cast<std::uint32_t>(builder_.scene.materials.size());
  builder_.scene.materials.push_back(std::move(material));
  return materials_[index] = converted;
}

Material GltfMaterials::convert(const tinygltf::Material& source, const std::string& place, int& uv_set) {
  const auto image = [&](const auto& texture, const char* name) {
    return texture.index < 0 ? kNone
                             : image_of_texture(texture.index, texture.extensions, place + "." + name);
  };
  const auto rgb = [](const std::vector<double>& c) { return glm::vec3(glm::dvec3(c[0], c[1], c[2])); };

  // Metallic-roughness factors and images.
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  Material material;
  material.name = source.name;
  material.base_color = rgb(pbr.baseColorFactor);
  material.roughness = static_cast<float>(pbr.roughnessFactor);
  material.metallic = static_cast<float>(pbr.metallicFactor);
  material.roughness_image = image(pbr.metallicRoughnessTexture, "metallicRoughnessTexture");
  material.base_color_image = image(pbr.baseColorTexture, "baseColorTexture");
  material.normal_image = image(source.normalTexture, "normalTexture");
  uv_set = material.base_color_image != kNone ? pbr.baseColorTexture.texCoord
           : material.normal_image != kNone   ? source.normalTexture.texCoord
                                              : pbr.metallicRoughnessTexture.texCoord;

  // Emission.
  material.emission = rgb(source.emissiveFactor);
  const auto strength = source.extensions.find("KHR_materials_emissive_strength");
  if (strength != source.extensions.end() && strength->second.Has("emissiveStrength"))
    material.emission *= static_cast<float>(strength->second.Get("emissiveStrength").GetNumberAsDouble());
  if (source.emissiveTexture.index >= 0 && material.emission != glm::vec3(0))
    material.emission *= mean_color(image(source.emissiveTexture, "emissiveTexture"));

  // Alpha cutoff: the renderer compares it with the texel only, so divide it by the factor.
  const std::string& mode = source.alphaMode;
  if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
    document_.fail(place + ".alphaMode", "is none of OPAQUE, MASK, BLEND");
  if (mode != "OPAQUE") {
    const double cutoff = mode == "MASK" ? source.alphaCutoff : 0.5;
    material.alpha_cutoff = static_cast<float>(cutoff / std::max(pbr.baseColorFactor[3], 1e-6));
  }
  return material;
}

std::uint32_t GltfMaterials::image_of_texture(int texture, const tinygltf::ExtensionMap& extensions,
                                              const std::string& place) {
  if (extensions.contains("KHR_texture_transform")) log_warning(place + ": texture transforms are ignored");
  const int source = document_.model().textures[static_cast<std::size_t>(texture)].source;
  if (source < 0) {
    log_warning(document_.place("textures", static_cast<std::size_t>(texture)) +
                ": has no PNG or JPEG source; a magenta checker stands in");
    return builder_.checker_image();
  }
  if (const auto known = images_.find(source); known != images_.end()) return known->second;
  const tinygltf::Image& image = document_.model().images[static_cast<std::size_t>(source)];
  const std::string name = document_.place("images", static_cast<std::size_t>(source));
  return images_[source] = image.image.empty()
                               ? builder_.image_of_file({&image.uri, 1}, name)
                               : builder_.image_of_bytes(std::as_bytes(std::span(image.image)), name, name);
}

glm::vec3 GltfMaterials::mean_color(std::uint32_t image) const {
  const image::Image8& pixels = builder_.scene.images[image].pixels;
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i + 3 < pixels.rgba.size(); i += 4) {
    for (int channel = 0; channel < 3; ++channel)
      sum[channel] += linear_from_srgb(pixels.rgba[i + static_cast<std::size_t>(channel)] / 255.0);
  }
  return glm::vec3(sum / std::max(1.0, static_cast<double>(pixels.rgba.size()) / 4));
}

}  // namespace brume::scene
