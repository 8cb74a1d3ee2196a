// Decodes buffer views that are compressed by EXT_meshopt_compression.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace brume::scene {

/// The members of the extension, named as there.
struct MeshoptView {
  std::span<const std::byte> compressed;
  std::uint64_t count = 0, byte_stride = 0;
  std::string mode, filter;
};

/// The view's `count` elements of `byte_stride` bytes. The bytes may be hostile: throws brume::Error with
/// `place` for parameters that the extension forbids, for more elements than the bytes can hold, and for a
/// damaged stream. Indices in the result are not checked.
std::vector<std::byte> decode_meshopt(const MeshoptView& view, const std::string& place);

}  // namespace brume::scene
