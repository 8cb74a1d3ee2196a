// A glTF document's bytes: the GLB container, buffers, views, accessors. Every range is checked before it is
// read. Throws brume::Error; parse_gltf turns that into its Result.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/files.hpp"
#include "scene/gltf_json.hpp"

namespace brume::scene {

/// Most elements of an accessor without a buffer view: what it holds costs the file nothing.
constexpr std::uint64_t kMostZeroElements = 1ull << 22;

struct GltfContainer {
  std::string_view json;
  std::optional<std::span<const std::byte>> binary;  ///< The GLB's second chunk.
};

/// Tells .glb from .gltf by the first bytes, and splits the former.
GltfContainer split_gltf(std::span<const std::byte> bytes, const std::string& name);

class GltfBuffers {
 public:
  GltfBuffers(GltfValue document, const SceneFiles& files, std::optional<std::span<const std::byte>> binary);

  /// The bytes of a buffer view.
  std::span<const std::byte> view(std::uint64_t index, const GltfValue& asker);
  /// An accessor's elements as numbers, `components` each (integers scaled where the accessor says
  /// normalized). All finite.
  std::vector<float> floats(std::uint64_t accessor, std::size_t components, const GltfValue& asker);
  /// A scalar accessor of unsigned integers.
  std::vector<std::uint32_t> indices(std::uint64_t accessor, const GltfValue& asker);
  /// The bytes that a "uri" names: a data: URI or a file below the scene's folder.
  std::vector<std::byte> uri_bytes(const GltfValue& uri) const;

 private:
  struct Accessor {
    std::uint64_t count = 0;
    int component_type = 0;
    std::size_t components = 0;
    bool normalized = false;
    std::vector<std::byte> packed;  ///< The elements without gaps, sparse ones put in.
  };
  Accessor read_accessor(std::uint64_t index, const GltfValue& asker);
  void apply_sparse(Accessor& accessor, std::size_t element_size, const GltfValue& sparse);
  std::span<const std::byte> buffer(std::uint64_t index, const GltfValue& asker);

  GltfValue document_;
  const SceneFiles& files_;
  std::optional<std::span<const std::byte>> binary_;
  std::map<std::uint64_t, std::vector<std::byte>> loaded_;
};

/// The file that a "uri" names, decoded; empty for a data: URI. Fails when it is not below the scene's
/// folder.
std::string gltf_file_name(const GltfValue& uri);

/// The element `index` of the document's array `array`.
GltfValue gltf_element(const GltfValue& document, const char* array, std::uint64_t index,
                       const GltfValue& asker);

}  // namespace brume::scene
