#include <algorithm>
#include <cmath>

#include "core/log.hpp"
#include "scene/gltf_parts.hpp"

namespace brume::scene {
namespace {

constexpr std::uint64_t kMostElements = 1u << 30;

/// IEC 61966-2-1.
double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace

GltfMaterials::GltfMaterials(GltfValue document, GltfBuffers& buffers, SceneBuilder& builder,
                             const SceneFiles& files)
    : document_(std::move(document)), buffers_(buffers), builder_(builder), files_(files) {}

GltfMaterials::Converted GltfMaterials::of_primitive(const GltfValue& primitive) {
  std::vector<Material>& materials = builder_.scene.materials;
  const auto reference = primitive.find("material");
  if (!reference) {
    if (default_ == kNone) {
      Material material;
      material.name = "default";
      material.base_color = glm::vec3(0.6f);
      default_ = static_cast<std::uint32_t>(materials.size());
      materials.push_back(std::move(material));
    }
    return {default_, 0};
  }
  const std::uint64_t index = reference->whole(kMostElements);
  if (const auto known = materials_.find(index); known != materials_.end()) return known->second;
  Converted converted;
  Material material = convert(gltf_element(document_, "materials", index, *reference), converted.uv_set);
  if (material.name.empty()) material.name = "material " + std::to_string(index);
  converted.index = static_cast<std::uint32_t>(materials.size());
  materials.push_back(std::move(material));
  return materials_[index] = converted;
}

Material GltfMaterials::convert(const GltfValue& description, std::uint64_t& uv_set) {
  Material material;
  material.name = description.text_or("name", "");
  material.roughness = 1;
  material.metallic = 1;
  double alpha = 1;
  std::uint64_t ignored_set = 0;
  if (const auto pbr = description.find("pbrMetallicRoughness")) {
    if (const auto factor = pbr->find("baseColorFactor")) {
      if (factor->size() != 4) factor->fail("expected 4 numbers, found " + std::to_string(factor->size()));
      for (int i = 0; i < 3; ++i)
        material.base_color[i] = static_cast<float>((*factor)[static_cast<std::size_t>(i)].number(0, 1));
      alpha = (*factor)[3].number(0, 1);
    }
    material.roughness = static_cast<float>(pbr->number_or("roughnessFactor", 1, 0, 1));
    material.metallic = static_cast<float>(pbr->number_or("metallicFactor", 1, 0, 1));
    if (const auto texture = pbr->find("metallicRoughnessTexture"))
      material.roughness_image = image_of_texture(*texture, uv_set);
    if (const auto texture = pbr->find("baseColorTexture"))
      material.base_color_image = image_of_texture(*texture, uv_set);
  }
  if (const auto texture = description.find("normalTexture"))
    material.normal_image =
        image_of_texture(*texture, material.base_color_image == kNone ? uv_set : ignored_set);

  material.emission = description.vec3_or("emissiveFactor", glm::vec3(0), 0, 1e6);
  if (const auto extensions = description.find("extensions")) {
    if (const auto strength = extensions->find("KHR_materials_emissive_strength"))
      material.emission *= static_cast<float>(strength->number_or("emissiveStrength", 1, 0, 1e6));
  }
  const auto emissive = description.find("emissiveTexture");
  if (emissive && material.emission != glm::vec3(0))
    material.emission *= mean_color(image_of_texture(*emissive, ignored_set));

  // The cutoff is compared with the texel alone: the factor moves to its side.
  const std::string mode = description.text_or("alphaMode", "OPAQUE");
  if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
    description.member("alphaMode").fail("is none of OPAQUE, MASK, BLEND");
  if (mode != "OPAQUE") {
    const double cutoff = mode == "MASK" ? description.number_or("alphaCutoff", 0.5, 0, 1e6) : 0.5;
    material.alpha_cutoff = static_cast<float>(cutoff / std::max(alpha, 1e-6));
  }
  return material;
}

std::uint32_t GltfMaterials::image_of_texture(const GltfValue& reference, std::uint64_t& uv_set) {
  if (const auto set = reference.find("texCoord")) uv_set = set->whole(64);
  if (const auto extensions = reference.find("extensions");
      extensions && extensions->find("KHR_texture_transform")) {
    log_warning(reference.place() + ": texture transforms are not applied");
  }
  const GltfValue index = reference.member("index");
  const GltfValue texture = gltf_element(document_, "textures", index.whole(kMostElements), index);
  const auto source = texture.find("source");
  if (!source) {
    log_warning(texture.place() + ": has no PNG or JPEG source; a magenta checker stands in");
    return builder_.checker_image();
  }
  const std::uint64_t image_index = source->whole(kMostElements);
  if (const auto known = images_.find(image_index); known != images_.end()) return known->second;

  const GltfValue image = gltf_element(document_, "images", image_index, *source);
  const std::string name = image.place();
  std::uint32_t converted = kNone;
  if (const auto view = image.find("bufferView")) {
    converted = builder_.image_of_bytes(buffers_.view(view->whole(kMostElements), *view), name, name);
  } else {
    const GltfValue uri = image.member("uri");
    const std::string file = gltf_file_name(uri);
    if (!file.empty() && !files_.find(file)) {
      converted = builder_.image_of_file({&file, 1}, name);
    } else {
      converted = builder_.image_of_bytes(buffers_.uri_bytes(uri), name, name);
    }
  }
  return images_[image_index] = converted;
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
