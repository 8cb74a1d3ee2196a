#include "scene/files/gltf_rewrite.hpp"

#include <tiny_gltf.h>

#include <cstring>

namespace brume::scene {
namespace {

using nlohmann::json;

constexpr std::string_view kAnyBytes = "data:application/octet-stream;base64,";
constexpr const char* kOneByte = "data:application/octet-stream;base64,AA==";
constexpr std::size_t kGlbHeaderBytes = 20;

bool rewrite_media_types(json& elements) {
  bool changed = false;
  for (json& element : elements) {
    const auto uri = element.find("uri");
    if (uri == element.end() || !uri->is_string()) continue;
    auto& text = uri->get_ref<std::string&>();
    constexpr std::string_view kEnd = ";base64,";
    const std::string_view start = std::string_view(text).substr(0, 256);
    const std::size_t end = start.find(kEnd);
    if (!start.starts_with("data:") || end == std::string_view::npos || tinygltf::IsDataURI(text)) continue;
    text.replace(0, end + kEnd.size(), kAnyBytes);
    changed = true;
  }
  return changed;
}

bool rewrite_draco_indices(json& document) {
  bool changed = false;
  for (const json& mesh : document.value("meshes", json::array())) {
    for (const json& primitive : mesh["primitives"]) {
      const json::json_pointer draco("/extensions/KHR_draco_mesh_compression/bufferView");
      if (!primitive.contains(draco) || !primitive.contains("indices")) continue;
      json& accessor = document["accessors"][primitive["indices"].get<std::size_t>()];
      if (accessor.contains("bufferView")) continue;
      accessor["bufferView"] = primitive.at(draco);
      changed = true;
    }
  }
  return changed;
}

bool rewrite_glossy_materials(json& document) {
  bool changed = false;
  if (!document.contains("materials")) return changed;
  const json::json_pointer extension("/extensions/KHR_materials_pbrSpecularGlossiness");
  for (json& material : document["materials"]) {
    // A file may have both for programs that know one of them: the base colour is then there.
    if (!material.contains(extension) || material.contains("pbrMetallicRoughness")) continue;
    const json& glossy = material.at(extension);
    json metallic{{"metallicFactor", 0}, {"roughnessFactor", 1 - glossy.value("glossinessFactor", 1.0)}};
    if (glossy.contains("diffuseFactor")) metallic["baseColorFactor"] = glossy["diffuseFactor"];
    if (glossy.contains("diffuseTexture")) metallic["baseColorTexture"] = glossy["diffuseTexture"];
    material["pbrMetallicRoughness"] = std::move(metallic);
    changed = true;
  }
  return changed;
}

bool rewrite_skins(json& document) {
  bool changed = false;
  if (!document.contains("skins")) return changed;
  for (json& skin : document["skins"]) {
    if (skin.contains("inverseBindMatrices")) continue;
    skin["inverseBindMatrices"] = -1;
    changed = true;
  }
  return changed;
}

void put_length(std::string& glb, std::size_t at, std::size_t value) {
  const auto length = static_cast<std::uint32_t>(value);
  std::memcpy(glb.data() + at, &length, sizeof length);
}

}  // namespace

bool is_fallback_buffer(const json& buffer) {
  const json::json_pointer flag("/extensions/EXT_meshopt_compression/fallback");
  return !buffer.contains("uri") && buffer.contains(flag) && buffer.at(flag) == true;
}

bool rewrite_for_tinygltf(json& document) {
  bool changed = false;
  if (document.contains("images")) changed = rewrite_media_types(document["images"]);
  if (document.contains("buffers")) {
    changed = rewrite_media_types(document["buffers"]) || changed;
    for (json& buffer : document["buffers"]) {
      if (!is_fallback_buffer(buffer)) continue;
      buffer["uri"] = kOneByte;
      buffer["byteLength"] = 1;
      changed = true;
    }
  }
  changed = rewrite_glossy_materials(document) || changed;
  changed = rewrite_skins(document) || changed;
  return rewrite_draco_indices(document) || changed;
}

std::string glb_with_json(std::string_view glb, std::string json) {
  std::uint32_t old_length = 0;
  std::memcpy(&old_length, glb.data() + 12, sizeof old_length);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string result(glb.substr(0, kGlbHeaderBytes));
  result += json;
  result += glb.substr(kGlbHeaderBytes + old_length);
  put_length(result, 8, result.size());
  put_length(result, 12, json.size());
  return result;
}

}  // namespace brume::scene
