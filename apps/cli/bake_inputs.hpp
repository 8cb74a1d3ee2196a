// What the commands that bake meshes read.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/command_line/json.hpp"
#include "core/box.hpp"
#include "scene/scene.hpp"
#include "voxel/triangle.hpp"

namespace brume::cli {

/// Reads --size, such as "64x64x32": each 1 to 16384; nullopt: an empty text. Throws Error (usage).
std::optional<glm::uvec3> parse_voxels(const std::string& text);

/// Reads --box, two corners [m]; nullopt: an empty text. Throws Error (usage).
std::optional<Box<double>> parse_box(const std::string& text);

/// The triangles of all objects, those that smoke ignores included.
std::vector<voxel::Triangle> triangles_of(const scene::Scene& scene);

/// The triangles of all objects of a name. Throws Error (usage) for `option` where the scene of this file has
/// none, with what was probably meant.
std::vector<voxel::Triangle> triangles_of_object(const scene::Scene& scene, const std::string& file,
                                                 const std::string& option, const std::string& name);

/// Around the corners of all triangles; empty without any.
Box<double> bounds_of(std::span<const voxel::Triangle> triangles);

/// {"low": [x, y, z], "high": [x, y, z]}
Json to_json(const Box<double>& box);

}  // namespace brume::cli
