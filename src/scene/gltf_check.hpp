// A glTF document's JSON, checked before tinygltf sees it: tinygltf passes over values of a wrong type, cuts
// indices to 32 bits, reads images from unchecked ranges and recurses as deep as the file says.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace brume::scene {

/// Most bytes of a document's JSON.
constexpr std::uint64_t kMostGltfJson = 1ull << 26;

/// Parses the JSON and checks every value that the loader uses: its type, its range, and for an index that
/// the element exists; and that buffer views lie in their buffers. Throws brume::Error: "file: path of the
/// value: what was expected", syntax errors as "file:line:column: ...".
nlohmann::json checked_gltf_json(std::string_view text, const std::string& file);

}  // namespace brume::scene
