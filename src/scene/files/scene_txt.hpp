// Loader for Scene.txt: one object or light per line.
#pragma once

#include <string>
#include <string_view>

#include "core/error.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// Reads lines of words, separated by blanks or tabs; '#' begins a comment.
///   NAME  px py pz  rx ry rz  sx sy sz  [MATERIAL [ROUGHNESS]]
///   LIGHT_SOURCE  px py pz  r g b  POWER
/// An object uses the mesh Meshes/NAME.obj and the image Textures/MATERIAL_diffuse.png (or .jpg), each read
/// once, ignoring letter case if the exact name is missing. world_from_mesh = T * S * Rx(-rx) * Ry(-ry) *
/// Rz(-rz) for column vectors, angles in radians. Names have roles by their prefixes (role_of_prefix); the
/// first object called Grenade becomes Scene::grenade. Without a material: light grey, of
/// glass clear. Roughness defaults to
/// 0.8 and is clamped to at least 0.05, because files contain 0 as a placeholder. A light is a point that
/// emits POWER watts uniformly in all directions: intensity = rgb POWER / (4 pi).
Result<Scene> parse_scene_txt(std::string_view text, const std::string& name, const SceneFiles& files,
                              ImageUse use = ImageUse::pictures);

}  // namespace brume::scene
