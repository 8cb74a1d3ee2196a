#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "core/log.hpp"
#include "scene/obj.hpp"
#include "scene/roles.hpp"
#include "scene/scene_builder.hpp"
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
    if (word == "map_d") read_map(material.opacity_map, material.opacity_place);
    if (word == "map_Kd") read_map(material.diffuse_map, material.diffuse_place);
    if (word == "norm" || word == "map_Bump" || word == "map_bump" || word == "bump")
      read_map(material.normal_map, material.normal_place);
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
  void read_map(std::string& file, std::string& place) {
    std::string_view rest = reader_.rest_of_line();
    const auto take_word = [&rest] {
      const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
      const std::string_view word = rest.substr(0, end);
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t", end), rest.size()));
      return word;
    };
    while (rest.starts_with('-')) {
      const std::string_view option = take_word();
      if (option == "-imfchan" || option == "-type" || option == "-colorspace") take_word();
      while (!rest.empty()) {
        const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
        if (word != "on" && word != "off" && !reader_.number_from(word, "an option")) break;
        take_word();
      }
    }
    file = rest;
    std::replace(file.begin(), file.end(), '\\', '/');
    place = reader_.line_place();
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
    return std::filesystem::path(path).lexically_normal().generic_string();
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

Material scene_material(const MtlMaterial& source, SceneBuilder& builder) {
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
  const auto image = [&](const std::string& file, const std::string& place, const char* stand_in) {
    return file.empty() ? kNone : builder.image_of_file(places_of(file, source.folder), place, stand_in);
  };
  material.base_color_image = image(source.diffuse_map, source.diffuse_place, "a magenta checker stands in");
  material.normal_image = image(source.normal_map, source.normal_place, "it is left out");
  if (builder.is_checker(material.normal_image)) material.normal_image = kNone;
  // Exporters write Kd 0 beside a map that is meant to be unscaled.
  if (material.base_color_image != kNone && material.base_color == glm::vec3(0))
    material.base_color = glm::vec3(1);
  return material;
}

/// Finds opacity maps, and warns once of each that is missing.
class OpacityMaps {
 public:
  explicit OpacityMaps(const SceneFiles& files) : files_(files) {}

  /// Whether the map of a material exists.
  bool has(const MtlMaterial& source) {
    const std::string& map = source.opacity_map;
    if (map.empty()) return false;
    if (find_one(files_, places_of(map, source.folder))) return true;
    // That of the colour is missed as such.
    if (map != source.diffuse_map && missing_.insert(source.folder + map).second)
      log_warning(source.opacity_place + ": the image " + in_quotes(map) + " " + why_not_found(map) +
                  "; the material counts as opaque");
    return false;
  }

 private:
  const SceneFiles& files_;
  std::set<std::string> missing_;
};

/// What a mesh of a material stops. An opacity map is read only where it is the image of the colour.
Role role_of(const MtlMaterial& source, const Material& material, const SceneBuilder& builder,
             const Mesh& mesh, OpacityMaps& opacity_maps) {
  if (source.opacity < 0.5f) return Role::glass;
  if (!opacity_maps.has(source)) return Role::wall;
  if (source.opacity_map != source.diffuse_map) return Role::grille;
  if (builder.is_checker(material.base_color_image)) return Role::wall;
  return role_of_alpha(mesh, {&builder.scene.images[material.base_color_image].pixels});
}

/// What of a file would be drawn in another way if it were supported.
void warn_of_ignored(const Libraries& materials, const std::string& name) {
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

Result<Scene> parse_obj_scene(std::string_view text, const std::string& name, const SceneFiles& files) {
  const auto model = parse_obj(text, name);
  if (!model) return model.failure();
  const auto materials = read_libraries(*model, files);
  if (!materials) return materials.failure();

  warn_of_ignored(*materials, name);

  SceneBuilder builder(files, name);
  OpacityMaps opacity_maps(files);
  std::vector<Mesh> meshes = part_meshes(*model);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const ObjPart& part = model->parts[i];

    // The material.
    const auto source = materials->by_name.find(part.material);
    Material material;
    if (source != materials->by_name.end()) {
      material = scene_material(source->second, builder);
    } else {
      material.name = part.material.empty() ? "default" : part.material;
      material.base_color = glm::vec3(model->has_colors ? 1.0f : 0.6f);
      // A file that does not exist has been reported.
      if (!part.material.empty() && materials->has_all_files)
        log_warning(part.place + ": no material is called " + in_quotes(part.material) + "; it is grey");
    }
    if (const auto role = role_of_prefix(part.material))
      material.role = *role;
    else if (source != materials->by_name.end())
      material.role = role_of(source->second, material, builder, meshes[i], opacity_maps);
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
