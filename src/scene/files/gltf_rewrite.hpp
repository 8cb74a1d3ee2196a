// Rewrites what glTF 2.0 and its extensions allow but tinygltf 2.7 refuses or does not know.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace brume::scene {

/// True for a buffer that EXT_meshopt_compression leaves without data: its views are decompressed instead.
bool is_fallback_buffer(const nlohmann::json& buffer);

/// Rewrites a document that checked_gltf_json returned; true if anything changed:
/// - data: URIs whose media type tinygltf does not know get one that it does; contents decide, not types.
/// - Fallback buffers get one byte.
/// - KHR_materials_pbrSpecularGlossiness becomes metallic-roughness without metal: diffuse is the base
/// colour.
/// - Skins without inverse bind matrices get -1 of them, which stands for none.
/// - Indices that Draco compresses get a buffer view. Do not read such accessors.
bool rewrite_for_tinygltf(nlohmann::json& document);

/// The GLB file with its JSON replaced. `glb` must hold the whole JSON chunk.
std::string glb_with_json(std::string_view glb, std::string json);

}  // namespace brume::scene
