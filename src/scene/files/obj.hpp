// Parser for Wavefront OBJ and MTL, validated line by line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// The triangles of one object and material, in the order of the file.
struct ObjPart {
  std::string object;    ///< Name given by `o` or `g`, whichever came last; empty before the first.
  std::string material;  ///< Name given by `usemtl`; empty before the first.
  std::string place;     ///< "file:line" where it begins.
  std::vector<std::uint32_t> indices;
};

/// The most parts that names of objects make: beyond, they are parts of their material alone.
inline constexpr std::size_t kMostObjObjects = 1024;

struct ObjLibrary {
  std::string file;   ///< Name given by `mtllib`.
  std::string place;  ///< "file:line".
};

struct ObjModel {
  std::vector<Vertex> vertices;  ///< Without tangents. v points down, unlike in the file.
  std::vector<ObjPart> parts;    ///< Each with at least one triangle.
  std::vector<ObjLibrary> libraries;
  bool has_colors = false;  ///< A position has a colour.
};

/// Reads positions with or without a colour (sRGB, as programs write it), texture coordinates, normals, faces
/// (any number of corners, negative indices too, of vertices above or below), usemtl, o, g and mtllib;
/// corners without a normal get their face's. Other statements of the format are ignored. An index of a
/// texture coordinate or a normal that does not exist counts as none, with one warning; unknown statements
/// give one each. The text is UTF-8, or UTF-16 with a byte order mark. Fails with bad_input and
/// name:line:column for a word in place of a number, a number that is not finite, an index of a position that
/// does not exist, or a face with fewer than 3 corners.
Result<ObjModel> parse_obj(std::string_view text, const std::string& name);

/// All parts as one mesh with tangents.
Mesh merged_mesh(ObjModel model, const std::string& name);
/// Each part as a mesh with tangents, with only the vertices that it uses.
std::vector<Mesh> part_meshes(const ObjModel& model);

/// An image that an MTL file names.
struct MtlMap {
  std::string file;   ///< Empty: none.
  std::string place;  ///< "file:line".
  /// From `-s` and `-o`, for u and v as the file has them, v up.
  glm::vec2 scale{1}, offset{0};
  bool clamps = false;  ///< From `-clamp on`.
};

/// A material of an MTL file.
struct MtlMaterial {
  std::string name;
  std::string folder;  ///< Folder of its MTL file relative to the scene, ending in a slash; may be empty.
  glm::vec3 diffuse{0.8f}, emission{0};
  float roughness = 0.8f, metallic = 0;
  float opacity = 1;
  MtlMap diffuse_map, normal_map, opacity_map;
};

/// Reads newmtl, Kd, Ke, Ns (as a roughness: alpha is sqrt(2 / (Ns + 2)), its root the roughness), Pr, Pm,
/// d, Tr (1 - d), map_Kd, map_d, norm, map_Bump, bump, of maps the options -s and -o. Other statements are
/// ignored. Same errors as parse_obj.
Result<std::vector<MtlMaterial>> parse_mtl(std::string_view text, const std::string& name);

/// A scene from one OBJ file: one object per name (`o`, `g`) and material, called by the name if there is
/// one. An opacity map becomes the alpha of the colour's image, cut out below 0.5 where it is not glass; the
/// scale and offset of the colour's image apply to the texture coordinates of the material's meshes. Roles:
/// the prefix of the object's or the material's name (role_of_prefix); else glass for an opacity below 0.5,
/// by role_of_alpha with an opacity map.
Result<Scene> parse_obj_scene(std::string_view text, const std::string& name, const SceneFiles& files,
                              ImageUse use = ImageUse::pictures);

}  // namespace brume::scene
