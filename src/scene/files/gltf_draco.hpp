// Decodes meshes that are compressed by Draco (KHR_draco_mesh_compression).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scene/files/gltf_document.hpp"

namespace brume::scene {

struct DracoMesh {
  std::uint32_t vertices = 0;
  std::vector<std::uint32_t> corners;                  ///< Three a triangle, each below `vertices`.
  std::map<std::uint32_t, PackedElements> attributes;  ///< By the ids in the file; an element a vertex.
};

/// The bytes may be hostile: throws brume::Error with `place` for a damaged mesh, for one of another version
/// than 2.2, and, before memory is allocated for it, for one that declares more than `most_vertices`,
/// `most_corners` or than a stream of this length can hold. Attributes of types that glTF lacks are left out.
DracoMesh decode_draco(std::span<const std::byte> bytes, std::uint64_t most_vertices,
                       std::uint64_t most_corners, const std::string& place);

}  // namespace brume::scene
