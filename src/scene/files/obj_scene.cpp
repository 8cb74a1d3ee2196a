#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>

#include "core/log.hpp"
#include "core/utf8.hpp"
#include "scene/files/mesh_tools.hpp"
#include "scene/files/obj.hpp"
#include "scene/files/scene_builder.hpp"
#include "scene/roles.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

class MtlParser {
 public:
  MtlParser(std::string_view text, const std::string& name) : reader_(text, name) {}

  Result<std::vector<MtlMaterial>> parse() {
    while (reader_.next_line()) {
      const std::string_view word = reader_.next_word();
      if (word == "newmtl") {
        materials_.push_back({});
        materials_.back().name = reader_.rest_of_line();
      } else if (!materials_.empty()) {
        if (auto read = read_property(word, materials_.back()); !read) return read.failure();
      }
    }
    return std::move(materials_);
  }

 private:
  Result<void> read_property(std::string_view word, MtlMaterial& material) {
    if (word == "Kd") return read_color(material.diffuse);
    if (word == "Ke") return read_color(material.emission);
    if (word == "Pr") return read_number(material.roughness, 0, 1, "the roughness");
    if (word == "Pm") return read_number(material.metallic, 0, 1, "the metallic factor");
    if (word == "Ns") {
      float exponent = 0;
      if (auto read = read_number(exponent, 0, 1e6f, "the exponent"); !read) return read;
      material.roughness = std::sqrt(std::sqrt(2.0f / (exponent + 2.0f)));
    }
    if (word == "d" || word == "Tr") return read_opacity(word == "Tr", material.opacity);
    if (word == "map_d") material.opacity_map = read_map();
    if (word == "map_Kd") material.diffuse_map = read_map();
    if (word == "norm" || word == "map_Bump" || word == "map_bump" || word == "bump")
      material.normal_map = read_map();
    return {};
  }

  /// A single number applies to all three channels.
  Result<void> read_color(glm::vec3& color) {
    const auto red = reader_.number("red");
    if (!red) return red.failure();
    color = glm::vec3(std::clamp(*red, 0.0f, 1e6f));
    for (int channel = 1; channel < 3; ++channel) {
      const std::string_view word = reader_.next_word();
      if (word.empty() && channel == 1) return {};
      const auto number = reader_.number_from(word, channel == 1 ? "green" : "blue");
      if (!number) return number.failure();
      color[channel] = std::clamp(*number, 0.0f, 1e6f);
    }
    return {};
  }

  Result<void> read_number(float& value, float least, float most, const char* what) {
    const auto number = reader_.number(what);
    if (!number) return number.failure();
    value = std::clamp(*number, least, most);
    return {};
  }

  /// The number after "-halo", an option of `d`; what is none counts as opaque, as ever.
  Result<void> read_opacity(bool is_transparency, float& opacity) {
    std::string_view word = reader_.next_word();
    if (word == "-halo") word = reader_.next_word();
    const auto number = reader_.number_from(word, "the opacity");
    if (!number) return {};
    opacity = is_transparency ? 1 - *number : *number;
    return {};
  }

  /// The file name after options like "-bm 1.0": an option's values are the numbers and switches that follow
  /// it, or one word.
  MtlMap read_map() {
    MtlMap map;
    std::string_view rest = reader_.rest_of_line();
    const auto take_word = [&rest] {
      const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
      const std::string_view word = rest.substr(0, end);
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t", end), rest.size()));
      return word;
    };
    // Options have any number of values; the rest of the line is the name, which may have spaces.
    while (rest.starts_with('-')) {
      const std::string_view option = take_word();
      if (option == "-imfchan" || option == "-type" || option == "-colorspace") take_word();
      for (int axis = 0; !rest.empty(); ++axis) {
        const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
        const auto number = reader_.number_from(word, "an option");
        if (word != "on" && word != "off" && !number) break;
        if (number && axis < 2 && option == "-s") map.scale[axis] = *number;
        if (number && axis < 2 && option == "-o") map.offset[axis] = *number;
        if (option == "-clamp") map.clamps = word == "on";
        take_word();
      }
    }
    // Files from Windows.
    map.file = rest;
    std::replace(map.file.begin(), map.file.end(), '\\', '/');
    map.place = reader_.line_place();
    return map;
  }

  TextReader reader_;
  std::vector<MtlMaterial> materials_;
};

struct Libraries {
  std::map<std::string, MtlMaterial> by_name;
  bool has_all_files = true;
};

std::string folder_of(const std::string& file) {
  const std::size_t slash = file.rfind('/');
  return slash == std::string::npos ? "" : file.substr(0, slash + 1);
}

/// Where a file may be that another one in `folder` names: as it is written; from that folder; and, as paths
/// of other machines lead nowhere, its last part there and beside the scene.
std::vector<std::string> places_of(const std::string& name, const std::string& folder) {
  const auto normal = [](const std::string& path) {
    return to_path(path).lexically_normal().generic_string();
  };
  const std::string last = name.substr(folder_of(name).size());
  return {name, normal(folder + name), normal(name), folder + last, last};
}

std::optional<std::string> find_one(const SceneFiles& files, const std::vector<std::string>& places) {
  for (const std::string& place : places)
    if (auto found = files.find(place)) return found;
  return std::nullopt;
}

/// The files of a line, which may name several; a name may have spaces as well.
std::vector<std::string> library_files(const ObjLibrary& library, const SceneFiles& files) {
  std::string line = library.file;
  std::replace(line.begin(), line.end(), '\\', '/');
  if (const auto whole = find_one(files, places_of(line, ""))) return {*whole};
  std::vector<std::string> found, missing;
  std::istringstream words(line);
  for (std::string word; words >> word;)
    if (const auto one = find_one(files, places_of(word, "")))
      found.push_back(*one);
    else
      missing.push_back(word);
  if (!found.empty())
    for (const std::string& word : missing)
      log_warning(library.place + ": the material file " + in_quotes(word) + " " + why_not_found(word));
  return found;
}

Result<Libraries> read_libraries(const ObjModel& model, const SceneFiles& files) {
  Libraries materials;
  // Faces of a material that is in none of the files are grey, so a file that is missing ends nothing.
  for (const ObjLibrary& library : model.libraries) {
    if (library.file.empty()) {
      log_warning(library.place + ": expected the name of a material file after mtllib");
      continue;
    }
    const std::vector<std::string> found = library_files(library, files);
    if (found.empty()) {
      log_warning(library.place + ": the material file " + in_quotes(library.file) + " " +
                  why_not_found(library.file) + "; its materials are grey");
      materials.has_all_files = false;
    }
    for (const std::string& file : found) {
      const auto bytes = files.read(file);
      if (!bytes) return bytes.failure();
      auto parsed = parse_mtl({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file);
      if (!parsed) return parsed.failure();
      for (MtlMaterial& material : *parsed) {
        material.folder = folder_of(file);
        materials.by_name.try_emplace(material.name, std::move(material));
      }
    }
  }
  return materials;
}

/// The map whose scale and offset apply to the texture coordinates, of which there is one set.
const MtlMap& placing_map(const MtlMaterial& source) {
  for (const MtlMap* map : {&source.diffuse_map, &source.opacity_map, &source.normal_map})
    if (!map->file.empty()) return *map;
  return source.diffuse_map;
}

void place_texture(const MtlMap& map, Mesh& mesh) {
  if (map.scale == glm::vec2(1) && map.offset == glm::vec2(0)) return;
  constexpr float kMost = std::numeric_limits<float>::max();
  for (Vertex& vertex : mesh.vertices) {
    const glm::vec2 up(vertex.uv.x, 1 - vertex.uv.y);
    const glm::vec2 placed = glm::clamp(up * map.scale + map.offset, -kMost, kMost);
    vertex.uv = glm::vec2(placed.x, 1 - placed.y);
  }
  compute_tangents(mesh);  // A scale below 0 mirrors the image.
}

/// Gives a material the values of its opacity map as its alpha; false: it has none that exists.
Wraps wraps_of(const MtlMap& map) {
  return map.clamps ? Wraps{Wrap::clamp, Wrap::clamp} : Wraps();
}

bool add_opacity_map(const MtlMaterial& source, SceneBuilder& builder, Material& material) {
  const MtlMap& map = source.opacity_map;
  if (map.file.empty()) return false;
  if (map.file == source.diffuse_map.file) {
    if (builder.is_checker(material.base_color_image)) return false;  // It is missed as the colour.
  } else {
    const std::uint32_t image =
        builder.image_with_opacity(material.base_color_image, places_of(map.file, source.folder), map.place,
                                   wraps_of(source.diffuse_map.file.empty() ? map : source.diffuse_map));
    if (image == kNone) return false;
    material.base_color_image = image;
  }
  material.blended = true;
  material.transmission = 0;
  material.alpha_cutoff = 0.5f;
  return true;
}

Material scene_material(const MtlMaterial& source, SceneBuilder& builder, const Mesh& mesh) {
  Material material;
  material.name = source.name;
  material.base_color = source.diffuse;
  material.emission = source.emission;
  material.roughness = source.roughness;
  material.metallic = source.metallic;
  if (source.opacity < 0.5f) {
    material.opacity = source.opacity;
    material.transmission = 0;
  }
  const auto image = [&](const MtlMap& map, const char* stand_in, ImageUse use) {
    return map.file.empty() ? kNone
                            : builder.image_of_file(places_of(map.file, source.folder), map.place, stand_in,
                                                    use, wraps_of(map));
  };
  const bool is_alpha = source.opacity_map.file == source.diffuse_map.file;
  material.base_color_image =
      image(source.diffuse_map, kCheckerStandsIn, is_alpha ? ImageUse::roles : ImageUse::pictures);
  material.normal_image = image(source.normal_map, "it is left out", ImageUse::pictures);
  if (builder.is_checker(material.normal_image)) material.normal_image = kNone;
  // Exporters write Kd 0 beside a map that is meant to be unscaled.
  if (material.base_color_image != kNone && material.base_color == glm::vec3(0))
    material.base_color = glm::vec3(1);

  const bool has_alpha = add_opacity_map(source, builder, material);
  if (source.opacity < 0.5f)
    material.role = Role::glass;
  else if (has_alpha)
    material.role = role_of_alpha(mesh, {&builder.scene.images[material.base_color_image]});
  return material;
}

/// What of a file would be drawn in another way if it were supported.
void warn_of_ignored(const Libraries& materials, const std::string& name) {
  for (const auto& [material, source] : materials.by_name) {
    const MtlMap& placing = placing_map(source);
    for (const MtlMap* map : {&source.opacity_map, &source.normal_map})
      if (!map->file.empty() && (map->scale != placing.scale || map->offset != placing.offset))
        log_warning(map->place + ": the scale and offset of " + placing.place + " apply to this map, too");
  }
  for (const auto& entry : materials.by_name)
    if (entry.second.opacity >= 0.5f && entry.second.opacity < 1)
      return log_warning(name + ": not supported, and ignored: opacities from 0.5 on, as of the material " +
                         in_quotes(entry.first) + " (it is drawn opaque)");
}

}  // namespace

Result<std::vector<MtlMaterial>> parse_mtl(std::string_view text, const std::string& name) {
  if (is_utf16(text)) return parse_mtl(utf8_from_utf16(text), name);
  return MtlParser(text, name).parse();
}

Result<Scene> parse_obj_scene(std::string_view text, const std::string& name, const SceneFiles& files,
                              ImageUse use) {
  const auto model = parse_obj(text, name);
  if (!model) return model.failure();
  const auto materials = read_libraries(*model, files);
  if (!materials) return materials.failure();

  warn_of_ignored(*materials, name);

  SceneBuilder builder(files, name, use);
  std::vector<Mesh> meshes = part_meshes(*model);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const ObjPart& part = model->parts[i];

    // The material.
    const auto source = materials->by_name.find(part.material);
    Material material;
    if (source != materials->by_name.end()) {
      place_texture(placing_map(source->second), meshes[i]);
      material = scene_material(source->second, builder, meshes[i]);
    } else {
      material.name = part.material.empty() ? "default" : part.material;
      material.base_color = glm::vec3(model->has_colors ? 1.0f : 0.6f);
      // A file that does not exist has been reported.
      if (!part.material.empty() && materials->has_all_files)
        log_warning(part.place + ": no material is called " + in_quotes(part.material) + "; it is grey");
    }
    if (const auto role = role_of_prefix(part.material)) material.role = *role;
    const Role by_material = material.role;
    builder.scene.materials.push_back(std::move(material));

    // The object.
    const auto mesh = builder.add_mesh(std::move(meshes[i]));
    if (!mesh) return mesh.failure();
    Object object;
    object.name = !part.object.empty() ? part.object : !part.material.empty() ? part.material : "object";
    object.mesh = *mesh;
    object.material = static_cast<std::uint32_t>(builder.scene.materials.size() - 1);
    object.role = role_of_prefix(object.name).value_or(by_material);
    object.see_through = by_material == Role::glass;
    if (auto added = builder.add_object(std::move(object), part.place); !added) return added.failure();
  }
  return std::move(builder).finish();
}

}  // namespace brume::scene
