// Validates a glTF document's JSON before tinygltf reads it: tinygltf ignores values of a wrong type,
// truncates indices to 32 bits, reads images from unchecked ranges and recurses without limit.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace brume::scene {

/// Maximum number of bytes of a document's JSON.
constexpr std::uint64_t kMostGltfJson = 1ull << 26;

/// Parses the JSON and checks every value that the loader uses: its type, its range, for an index that the
/// element exists, and that buffer views lie in their buffers. Throws brume::Error with "file: path of the
/// value: expectation", or "file:line:column: ..." for syntax errors.
nlohmann::json checked_gltf_json(std::string_view text, const std::string& file);

}  // namespace brume::scene
