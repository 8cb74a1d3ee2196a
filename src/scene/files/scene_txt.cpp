#include "scene/files/scene_txt.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "core/log.hpp"
#include "scene/files/obj.hpp"
#include "scene/files/scene_builder.hpp"
#include "scene/roles.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

constexpr float kLeastRoughness = 0.05f;

/// T * S * Rx(-x) * Ry(-y) * Rz(-z). In double, rounded once.
glm::mat4 world_from_mesh(glm::vec3 position, glm::vec3 rotation, glm::vec3 scale) {
  glm::dmat4 matrix = glm::translate(glm::dmat4(1), glm::dvec3(position));
  matrix = glm::scale(matrix, glm::dvec3(scale));
  matrix = glm::rotate(matrix, -double{rotation.x}, glm::dvec3(1, 0, 0));
  matrix = glm::rotate(matrix, -double{rotation.y}, glm::dvec3(0, 1, 0));
  matrix = glm::rotate(matrix, -double{rotation.z}, glm::dvec3(0, 0, 1));
  return glm::mat4(matrix);
}

class SceneTxtParser {
 public:
  SceneTxtParser(std::string_view text, const std::string& name, const SceneFiles& files, ImageUse use)
      : reader_(text, name), files_(files), builder_(files, name, use) {}

  Result<Scene> parse() {
    while (reader_.next_line()) {
      const std::string_view word = reader_.next_word();
      if (word.empty()) continue;
      auto read = word == "LIGHT_SOURCE" ? read_light() : read_object(std::string(word));
      if (!read) return read.failure();
    }
    return std::move(builder_).finish();
  }

 private:
  Result<glm::vec3> read_vector(const char* const (&what)[3]) {
    glm::vec3 value(0);
    for (int axis = 0; axis < 3; ++axis) {
      const auto number = reader_.number(what[axis]);
      if (!number) return number.failure();
      value[axis] = *number;
    }
    return value;
  }

  Result<void> expect_end() {
    const std::string_view extra = reader_.next_word();
    if (extra.empty()) return {};
    return reader_.expected("the end of the line", extra);
  }

  Result<void> read_light() {
    const auto position = read_vector({"the light's x position", "its y position", "its z position"});
    if (!position) return position.failure();
    const auto color = read_vector({"the light's red", "its green", "its blue"});
    if (!color) return color.failure();
    const auto power = reader_.number("the light's power");
    if (!power) return power.failure();
    if (std::min({color->r, color->g, color->b, *power}) < 0) {
      return Failure{ErrorCode::bad_input,
                     reader_.line_place() + ": a light's colour and power must not be negative"};
    }
    if (auto end = expect_end(); !end) return end;

    Light light;
    light.position_world = *position;
    light.intensity = *color * (*power / static_cast<float>(4 * std::numbers::pi));
    const float largest = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
    const glm::vec3 reach = glm::abs(*position);
    if (!(largest < 1e30f) || std::max({reach.x, reach.y, reach.z}) > kFarthest) {
      return Failure{ErrorCode::bad_input,
                     reader_.line_place() + ": a light brighter than 1e30 or farther away than 10,000 km"};
    }
    builder_.scene.lights.push_back(light);
    return {};
  }

  Result<void> read_object(std::string name) {
    // The line's values.
    const auto position = read_vector({"the x position", "the y position", "the z position"});
    if (!position) return position.failure();
    const auto rotation = read_vector({"the x rotation", "the y rotation", "the z rotation"});
    if (!rotation) return rotation.failure();
    const auto scale = read_vector({"the x scale", "the y scale", "the z scale"});
    if (!scale) return scale.failure();
    const std::string material(reader_.next_word());
    float roughness = Material{}.roughness;
    if (const std::string_view word = material.empty() ? material : reader_.next_word(); !word.empty()) {
      const auto number = reader_.number_from(word, "the roughness");
      if (!number) return number.failure();
      roughness = *number;
    }
    if (auto end = expect_end(); !end) return end;

    // The object.
    const auto mesh = make_mesh(name);
    if (!mesh) return mesh.failure();
    Object object;
    object.mesh = *mesh;
    object.role = role_of_prefix(name).value_or(Role::wall);
    const bool clear = object.role == Role::glass && material.empty();
    object.material = clear ? glass() : make_material(material, std::clamp(roughness, kLeastRoughness, 1.0f));
    object.world_from_mesh = world_from_mesh(*position, *rotation, *scale);
    object.name = std::move(name);
    if (object.name != "Grenade") return builder_.add_object(std::move(object), reader_.line_place());
    if (!builder_.has_grenade()) return builder_.set_grenade(object, reader_.line_place());
    log_warning(reader_.line_place() + ": a second Grenade is ignored");
    return {};
  }

  Result<std::uint32_t> make_mesh(const std::string& name) {
    if (const auto known = meshes_.find(name); known != meshes_.end()) return known->second;
    const auto found = files_.find("Meshes/" + name + ".obj");
    if (!found) {
      log_warning(reader_.line_place() + ": the mesh " + in_quotes("Meshes/" + name + ".obj") +
                  " does not exist; a cube stands in");
      const auto cube = builder_.cube_mesh();
      if (cube) meshes_[name] = *cube;
      return cube;
    }
    const auto bytes = files_.read(*found);
    if (!bytes) return bytes.failure();
    auto model = parse_obj({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, *found);
    if (!model) return Failure{model.failure().code, reader_.line_place() + ": " + model.failure().message};
    const auto added = builder_.add_mesh(merged_mesh(std::move(*model), name));
    if (added) meshes_[name] = *added;
    return added;
  }

  /// Clear and smooth, but for the colours of vertices.
  std::uint32_t glass() {
    if (glass_ != kNone) return glass_;
    Material material;
    material.name = "glass";
    material.roughness = kLeastRoughness;
    builder_.scene.materials.push_back(std::move(material));
    return glass_ = static_cast<std::uint32_t>(builder_.scene.materials.size() - 1);
  }

  std::uint32_t make_material(const std::string& name, float roughness) {
    const auto key = std::pair(name, roughness);
    if (const auto known = materials_.find(key); known != materials_.end()) return known->second;
    Material material;
    material.name = name.empty() ? "default" : name;
    material.roughness = roughness;
    if (name.empty()) {
      material.base_color = glm::vec3(0.6f);
    } else {
      const std::string stem = "Textures/" + name + "_diffuse";
      const std::string names[] = {stem + ".png", stem + ".jpg"};
      material.base_color_image = builder_.image_of_file(names, reader_.line_place());
    }
    builder_.scene.materials.push_back(std::move(material));
    return materials_[key] = static_cast<std::uint32_t>(builder_.scene.materials.size() - 1);
  }

  TextReader reader_;
  const SceneFiles& files_;
  SceneBuilder builder_;
  std::map<std::string, std::uint32_t> meshes_;
  std::map<std::pair<std::string, float>, std::uint32_t> materials_;
  std::uint32_t glass_ = kNone;
};

}  // namespace

Result<Scene> parse_scene_txt(std::string_view text, const std::string& name, const SceneFiles& files,
                              ImageUse use) {
  if (is_utf16(text)) return parse_scene_txt(utf8_from_utf16(text), name, files, use);
  return SceneTxtParser(text, name, files, use).parse();
}

}  // namespace brume::scene
