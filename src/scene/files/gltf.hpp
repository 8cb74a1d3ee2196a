// Loader for glTF 2.0 and GLB.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/error.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// Reads a .gltf or .glb: the default scene's nodes with meshes (triangles, strips, fans), their vertex
/// colours, metallic-roughness materials, punctual lights, and the first perspective camera. Files it refers
/// to must lie below the scene's folder.
/// - Missing normals become flat normals, missing tangents are computed. BLEND becomes a pane (is_pane), or
///   a cutout at alpha 0.5 where it is not glass.
/// - Light intensities are not converted: candela count as W/sr, lux as W/m^2; exposure compensates.
/// - A light emits along its node's -z. The camera's target is the point on its axis nearest to the middle of
///   the scene, at least 1 m ahead.
/// - Roles: a node's extras {"brume_role": "glass"} or {"brume_ignore": true}, else its name's prefix
///   (role_of_prefix), for it and its children; else its mesh's prefix; else its material's: MASK and BLEND
///   by role_of_alpha, else glass by KHR_materials_transmission of at least 0.5.
/// - The first node or mesh called Grenade becomes Scene::grenade.
/// - Meshes may be compressed by Draco, meshoptimizer or quantization (KHR_draco_mesh_compression,
///   EXT_meshopt_compression, KHR_mesh_quantization), images may be WebP (EXT_texture_webp).
/// - Texture coordinates serve the material's first image, after its KHR_texture_transform.
/// - Images continue as their textures' samplers say; filters are the renderer's own.
/// - Meshes have the shape of their default morph weights, and of their skins with the joints as the nodes
///   place them.
/// - An emissive texture is replaced by its mean colour. Animations, points and lines are ignored.
/// Fails with bad_input ("file: path of the value: expectation") for invalid documents and for those that
/// require an unknown extension.
Result<Scene> parse_gltf(std::span<const std::byte> bytes, const std::string& name, const SceneFiles& files,
                         ImageUse use = ImageUse::pictures);

}  // namespace brume::scene
