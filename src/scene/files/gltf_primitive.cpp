#include "scene/files/gltf_primitive.hpp"

#include <numeric>

#include "scene/files/scene_builder.hpp"

namespace brume::scene {
namespace {

/// The corners of separate triangles, from a list, a strip or a fan of corners.
std::vector<std::uint32_t> as_triangles(std::vector<std::uint32_t> corners, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return corners;
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    // Every second triangle of a strip has the opposite winding.
    const std::size_t swap = mode == TINYGLTF_MODE_TRIANGLE_STRIP ? i % 2 : 0;
    triangles.push_back(corners[mode == TINYGLTF_MODE_TRIANGLE_FAN ? 0 : i]);
    triangles.push_back(corners[i + 1 + swap]);
    triangles.push_back(corners[i + 2 - swap]);
  }
  return triangles;
}

}  // namespace

GltfPrimitive::GltfPrimitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                             std::string place)
    : document_(document), primitive_(primitive), place_(std::move(place)) {
  const auto extension = primitive_.extensions.find("KHR_draco_mesh_compression");
  if (extension != primitive_.extensions.end()) decode(extension->second);
}

void GltfPrimitive::decode(const tinygltf::Value& extension) {
  const std::string here = place_ + ".extensions.KHR_draco_mesh_compression";
  const auto accessor = [&](int index) -> const tinygltf::Accessor& {
    return document_.model().accessors[static_cast<std::size_t>(index)];
  };

  // The accessors declare what the mesh may hold.
  const std::uint64_t most_vertices =
      std::min<std::uint64_t>(accessor(primitive_.attributes.at("POSITION")).count, kMostVertices);
  const std::uint64_t most_corners =
      primitive_.indices < 0 ? most_vertices
                             : std::min<std::uint64_t>(accessor(primitive_.indices).count, kMostIndices);
  draco_ = decode_draco(document_.view(extension.Get("bufferView").GetNumberAsInt()), most_vertices,
                        most_corners, here);

  for (const std::string& name : extension.Get("attributes").Keys()) {
    const auto id = static_cast<std::uint32_t>(extension.Get("attributes").Get(name).GetNumberAsInt());
    if (!primitive_.attributes.contains(name))
      document_.fail(here + ".attributes." + name, "the primitive has no such attribute");
    if (!draco_->attributes.contains(id)) {
      document_.fail(here + ".attributes." + name,
                     "the Draco mesh has no attribute " + std::to_string(id) + " of a type that glTF knows");
    }
    draco_ids_[name] = id;
  }
}

const PackedElements* GltfPrimitive::compressed(const std::string& attribute) const {
  const auto id = draco_ids_.find(attribute);
  return id == draco_ids_.end() ? nullptr : &draco_->attributes.at(id->second);
}

int GltfPrimitive::components(const std::string& attribute) const {
  if (const PackedElements* elements = compressed(attribute)) return elements->components;
  const auto accessor = primitive_.attributes.find(attribute);
  if (accessor == primitive_.attributes.end()) return 0;
  const int type = document_.model().accessors[static_cast<std::size_t>(accessor->second)].type;
  return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
}

std::vector<float> GltfPrimitive::floats(const std::string& attribute, int components) const {
  const auto accessor = primitive_.attributes.find(attribute);
  if (accessor == primitive_.attributes.end()) return {};
  const std::string user = place_ + ".attributes." + attribute;
  if (const PackedElements* elements = compressed(attribute))
    return document_.floats(accessor->second, *elements, components, user);
  return document_.floats(accessor->second, components, user);
}

std::vector<std::uint32_t> GltfPrimitive::triangles(std::size_t vertices) const {
  std::vector<std::uint32_t> corners(vertices);
  if (draco_) {
    corners = draco_->corners;
  } else if (primitive_.indices >= 0) {
    corners = document_.indices(primitive_.indices, place_ + ".indices");
  } else {
    std::iota(corners.begin(), corners.end(), 0u);
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] < vertices) continue;
    document_.fail(place_ + ".indices", "index " + std::to_string(corners[i]) + " (number " +
                                            std::to_string(i) + ") is out of range: the primitive has " +
                                            std::to_string(vertices) + " vertices");
  }

  // Draco always stores a list.
  const int mode = draco_ ? TINYGLTF_MODE_TRIANGLES : primitive_.mode;
  if (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
    document_.fail(place_, "has " + std::to_string(corners.size()) + " corners; expected a multiple of 3");
  return as_triangles(std::move(corners), mode);
}

}  // namespace brume::scene
