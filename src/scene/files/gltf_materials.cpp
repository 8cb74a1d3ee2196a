#include "scene/files/gltf_materials.hpp"

#include <algorithm>
#include <cmath>

#include "core/log.hpp"
#include "scene/color.hpp"
#include "scene/roles.hpp"

namespace brume::scene {
namespace {

/// How a material reads one of its textures.
struct TextureUse {
  int uv_set = 0;
  glm::mat3x2 image_from_uv{1, 0, 0, 1, 0, 0};
  bool operator==(const TextureUse&) const = default;
};

/// Translation * rotation * scale, as KHR_texture_transform defines them.
template <typename TextureInfo>
TextureUse texture_use(const TextureInfo& texture) {
  TextureUse use{texture.texCoord};
  const auto found = texture.extensions.find("KHR_texture_transform");
  if (found == texture.extensions.end()) return use;
  const tinygltf::Value& transform = found->second;
  const auto pair = [&](const char* member, double otherwise) {
    if (!transform.Has(member)) return glm::dvec2(otherwise);
    const tinygltf::Value& values = transform.Get(member);
    return glm::dvec2(values.Get(0).GetNumberAsDouble(), values.Get(1).GetNumberAsDouble());
  };
  const double angle = transform.Has("rotation") ? transform.Get("rotation").GetNumberAsDouble() : 0;
  const glm::dvec2 scale = pair("scale", 1), offset = pair("offset", 0);
  const double c = std::cos(angle), s = std::sin(angle);
  use.image_from_uv =
      glm::mat3x2(glm::dmat3x2(scale.x * c, -scale.x * s, scale.y * s, scale.y * c, offset.x, offset.y));
  if (transform.Has("texCoord")) use.uv_set = transform.Get("texCoord").GetNumberAsInt();
  return use;
}

}  // namespace

double transmission_of(const tinygltf::Material& material) {
  const auto found = material.extensions.find("KHR_materials_transmission");
  if (found == material.extensions.end() || !found->second.Has("transmissionFactor")) return 0;
  return found->second.Get("transmissionFactor").GetNumberAsDouble();
}

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
    const tinygltf::Material& source = document_.model().materials[at];
    const std::string place = document_.place("materials", at);
    material = convert(source, place);
    converted = texture_coordinates(source, place);
    if (material.name.empty()) material.name = "material " + std::to_string(index);
  }
  converted.index = static_cast<std::uint32_t>(builder_.scene.materials.size());
  builder_.scene.materials.push_back(std::move(material));
  return materials_[index] = converted;
}

Role GltfMaterials::role(std::uint32_t index, const Mesh& mesh) const {
  const Role by_light = builder_.scene.materials[index].role;
  const auto found = alphas_.find(index);
  if (found == alphas_.end()) return by_light;
  const AlphaSource& source = found->second;
  const Image* image = source.image == kNone ? nullptr : &builder_.scene.images[source.image];
  const Role by_alpha = role_of_alpha(mesh, {image, source.factor, source.cutoff});
  return by_alpha == Role::wall ? by_light : by_alpha;
}

std::optional<Role> GltfMaterials::role_of_extras(const tinygltf::Value& extras, const std::string& place) {
  if (!extras.Has("brume_role")) return std::nullopt;
  const tinygltf::Value& value = extras.Get("brume_role");
  const auto role = value.IsString() ? role_of_name(value.Get<std::string>()) : std::nullopt;
  if (!role && !warned_of_role_) {
    log_warning(place + ".extras.brume_role: is none of \"wall\", \"glass\", \"grille\", \"ghost\"");
    warned_of_role_ = true;
  }
  return role;
}

Material GltfMaterials::convert(const tinygltf::Material& source, const std::string& place) {
  const auto image = [&](const auto& texture, ImageUse use = ImageUse::pictures) {
    return texture.index < 0 ? kNone : image_of_texture(texture.index, use);
  };
  // A color that stands in for numbers would make no sense.
  const auto numbers = [&](const auto& texture) {
    const std::uint32_t found = image(texture);
    return builder_.is_checker(found) ? kNone : found;
  };
  const auto rgb = [](const std::vector<double>& c) { return glm::vec3(glm::dvec3(c[0], c[1], c[2])); };

  // Metallic-roughness factors and images.
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  Material material;
  material.name = source.name;
  material.base_color = rgb(pbr.baseColorFactor);
  material.roughness = static_cast<float>(pbr.roughnessFactor);
  material.metallic = static_cast<float>(pbr.metallicFactor);
  material.roughness_image = numbers(pbr.metallicRoughnessTexture);
  material.base_color_image =
      image(pbr.baseColorTexture, source.alphaMode == "OPAQUE" ? ImageUse::pictures : ImageUse::roles);
  material.normal_image = numbers(source.normalTexture);

  // Emission.
  material.emission = rgb(source.emissiveFactor);
  const auto strength = source.extensions.find("KHR_materials_emissive_strength");
  if (strength != source.extensions.end() && strength->second.Has("emissiveStrength"))
    material.emission *= static_cast<float>(strength->second.Get("emissiveStrength").GetNumberAsDouble());
  if (source.emissiveTexture.index >= 0 && material.emission != glm::vec3(0))
    material.emission *= mean_color(image(source.emissiveTexture));

  // What it stops, unless its alpha decides.
  const std::optional<Role> chosen = role_of_extras(source.extras, place);

  // Alpha cutoff: the renderer compares it with the texel only, so divide it by the factor.
  const std::string& mode = source.alphaMode;
  if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
    document_.fail(place + ".alphaMode", "is none of OPAQUE, MASK, BLEND");
  const double transmission = transmission_of(source);
  if (transmission >= 0.5) material.transmission = static_cast<float>(std::min(transmission, 1.0));
  if (mode == "BLEND") {
    material.blended = true;
    material.opacity = static_cast<float>(std::clamp(pbr.baseColorFactor[3], 0.0, 1.0));
    if (transmission < 0.5) material.transmission = 0;
  }
  if (mode != "OPAQUE") {
    const double cutoff = mode == "MASK" ? source.alphaCutoff : 0.5;
    material.alpha_cutoff = static_cast<float>(cutoff / std::max(pbr.baseColorFactor[3], 1e-6));
    const auto index = static_cast<std::uint32_t>(builder_.scene.materials.size());
    if (!chosen) alphas_[index] = {numbers(pbr.baseColorTexture), pbr.baseColorFactor[3], cutoff};
  }
  material.role = chosen.value_or(transmission >= 0.5 ? Role::glass : Role::wall);
  return material;
}

GltfMaterials::Converted GltfMaterials::texture_coordinates(const tinygltf::Material& source,
                                                            const std::string& place) const {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  std::vector<TextureUse> uses;
  if (pbr.baseColorTexture.index >= 0) uses.push_back(texture_use(pbr.baseColorTexture));
  if (source.normalTexture.index >= 0) uses.push_back(texture_use(source.normalTexture));
  if (pbr.metallicRoughnessTexture.index >= 0) uses.push_back(texture_use(pbr.metallicRoughnessTexture));
  if (uses.empty()) return {};

  // A vertex has one pair of coordinates, for the first image.
  for (const TextureUse& use : uses) {
    if (use == uses.front()) continue;
    log_warning(
        place +
        ": its textures differ in texCoord or KHR_texture_transform; those of the first apply to all");
    break;
  }
  return {kNone, uses.front().uv_set, uses.front().image_from_uv};
}

std::uint32_t GltfMaterials::image_of_texture(int index, ImageUse use) {
  const tinygltf::Texture& texture = document_.model().textures[static_cast<std::size_t>(index)];
  const auto webp = texture.extensions.find("EXT_texture_webp");
  const int source =
      webp == texture.extensions.end() ? texture.source : webp->second.Get("source").GetNumberAsInt();
  if (source < 0) {
    builder_.warn_of_image(use, document_.place("textures", static_cast<std::size_t>(index)) +
                                    ": has no PNG, JPEG or WebP source; " + kCheckerStandsIn);
    return builder_.checker_image();
  }
  const Wraps wraps = wraps_of_texture(texture);
  const std::pair key(source, wraps);
  if (const auto known = images_.find(key); known != images_.end()) return known->second;
  const tinygltf::Image& image = document_.model().images[static_cast<std::size_t>(source)];
  const std::string name = document_.place("images", static_cast<std::size_t>(source));
  return images_[key] =
             image.image.empty()
                 ? builder_.image_of_file({&image.uri, 1}, name, kCheckerStandsIn, use, wraps)
                 : builder_.image_of_bytes(std::as_bytes(std::span(image.image)), name, name, use, wraps);
}

Wraps GltfMaterials::wraps_of_texture(const tinygltf::Texture& texture) const {
  if (texture.sampler < 0) return {};
  const tinygltf::Sampler& sampler = document_.model().samplers[static_cast<std::size_t>(texture.sampler)];
  const auto wrap = [](int mode) {
    return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::clamp
           : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror
                                                           : Wrap::repeat;
  };
  return {wrap(sampler.wrapS), wrap(sampler.wrapT)};
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
