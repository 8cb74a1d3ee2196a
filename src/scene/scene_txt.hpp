// Scene.txt: a line an object or a light.
#pragma once

#include <string>
#include <string_view>

#include "core/error.hpp"
#include "scene/files.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// Reads lines of words, separated by blanks or tabs; '#' begins a comment.
///   NAME  px py pz  rx ry rz  sx sy sz  [MATERIAL [ROUGHNESS]]
///   LIGHT_SOURCE  px py pz  r g b  POWER
/// An object takes the mesh Meshes/NAME.obj and the image Textures/MATERIAL_diffuse.png (or .jpg), each
/// read once, letter case ignored where the exact name is missing. world_from_mesh = T * S * Rx(-rx) *
/// Ry(-ry) * Rz(-rz) for column vectors, angles in radians. Names beginning with IGNORE_ are not voxelized;
/// the first object called Grenade becomes Scene::grenade. Without a material: light grey. Roughness
/// defaults to 0.8 and is at least 0.05: files write 0 where nobody chose a value.
/// A light is a point that gives off POWER watts evenly in all directions: intensity = rgb POWER / (4 pi).
Result<Scene> parse_scene_txt(std::string_view text, const std::string& name, const SceneFiles& files);

}  // namespace brume::scene
