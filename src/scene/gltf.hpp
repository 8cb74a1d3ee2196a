// glTF 2.0 and GLB.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/error.hpp"
#include "scene/files.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// Reads a .gltf or .glb: the default scene's nodes with meshes (triangles, strips, fans), metallic-roughness
/// materials, punctual lights, and the first perspective camera. Files that it names must lie below the
/// scene's folder.
/// - Missing normals become flat ones, missing tangents are computed. BLEND is cut out at alpha 0.5.
/// - Light intensities are taken as they are: candela as W/sr, lux as W/m^2; exposure does the rest.
/// - A light emits along its node's -z. The camera's target is the point of its axis nearest to the middle
///   of the scene, at least 1 m ahead.
/// - A node with extras {"brume_ignore": true}, or whose own or mesh's name begins with IGNORE_, is not
///   voxelized, nor are its children.
/// - The first node or mesh called Grenade becomes Scene::grenade.
/// - An emissive texture is replaced by its mean colour. Animation, skins, morph targets and points and
///   lines are not drawn.
/// Fails with bad_input ("file: path of the value: what was expected") for whatever is broken or needs an
/// extension that is not known.
Result<Scene> parse_gltf(std::span<const std::byte> bytes, const std::string& name, const SceneFiles& files);

}  // namespace brume::scene
