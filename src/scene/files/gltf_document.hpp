// A glTF document read by tinygltf, and the contents of its accessors. Every index and buffer view in the
// model is valid (checked_gltf_json); accessors are validated here before they are read. Throws brume::Error,
// which parse_gltf converts to its Result.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scene/files/scene_files.hpp"

namespace brume::scene {

/// Maximum number of elements of an accessor without a buffer view, whose zeros take no space in the file.
constexpr std::uint64_t kMostZeroElements = 1ull << 22;

/// Maximum number of bytes of a document's decompressed buffer views.
constexpr std::uint64_t kMostDecompressedBytes = 1ull << 32;

/// The elements of an accessor without gaps, little-endian.
struct PackedElements {
  int component_type = 0;  ///< TINYGLTF_COMPONENT_TYPE_BYTE and so on.
  int components = 0;      ///< Per element, 1-4; of a MAT4 16.
  std::vector<std::byte> bytes;
};

class GltfDocument {
 public:
  /// Reads .gltf or .glb, distinguished by the first bytes, with its buffers and images (Image::image holds
  /// the encoded file; empty when it does not exist). Files must lie below the scene's folder.
  GltfDocument(std::span<const std::byte> bytes, std::string name, const SceneFiles& files);

  const tinygltf::Model& model() const { return model_; }
  /// "file: path[index]".
  std::string place(const char* path, std::size_t index) const;
  [[noreturn]] void fail(const std::string& place, const std::string& what) const;

  /// An accessor's elements as finite numbers, `components` each (16: a MAT4); normalized integers are
  /// scaled. `user` names the referring value in messages.
  std::vector<float> floats(int accessor, int components, const std::string& user) const;
  /// The same for elements that were stored elsewhere in place of the accessor's own.
  std::vector<float> floats(int accessor, const PackedElements& elements, int components,
                            const std::string& user) const;
  /// A scalar accessor of unsigned integers.
  std::vector<std::uint32_t> indices(int accessor, const std::string& user) const;
  /// The bytes of a buffer view, decompressed if it is compressed.
  std::span<const std::byte> view(int index) const;

 private:
  PackedElements packed(std::size_t accessor) const;
  std::span<const std::byte> decompressed(int view) const;
  void apply_sparse(const tinygltf::Accessor& accessor, std::size_t element_size, const std::string& place,
                    std::vector<std::byte>& packed) const;

  tinygltf::Model model_;
  std::string name_;
  mutable std::map<int, std::vector<std::byte>> decompressed_;  ///< Buffer views, each when first read.
  mutable std::uint64_t decompressed_bytes_ = 0;
};

}  // namespace brume::scene
