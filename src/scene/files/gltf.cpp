#include "scene/files/gltf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <span>
#include <utility>

#include "core/log.hpp"
#include "scene/files/gltf_materials.hpp"
#include "scene/files/gltf_meshes.hpp"
#include "scene/files/gltf_nodes.hpp"
#include "scene/roles.hpp"

namespace brume::scene {
namespace {

/// Whether an entry of extras is true, or 1, as some exporters write it.
bool is_true(const tinygltf::Value& extras, const char* key) {
  if (!extras.Has(key)) return false;
  const tinygltf::Value& value = extras.Get(key);
  return value.IsBool() ? value.Get<bool>() : value.IsNumber() && value.GetNumberAsDouble() == 1;
}

/// Converts candela and lux, in which glTF stores lights, to watts. KHR_lights_punctual names no spectrum;
/// this is the luminous efficacy at 555 nm, which Blender and most engines use.
constexpr double kLumensPerWatt = 683;

/// The node's -z direction in world space.
glm::vec3 forward(const glm::dmat4& world_from_node) {
  const glm::dvec3 direction = -glm::dvec3(world_from_node[2]);
  const double length = glm::length(direction);
  return length > 1e-30 && length < 1e30 ? glm::vec3(direction / length) : glm::vec3(0, 0, -1);
}

/// What of a file would be drawn in another way if it were supported, in words; empty: nothing.
std::string ignored_features(const tinygltf::Model& model) {
  constexpr double kMostClearRoughness = 0.3;
  bool unlit = false, frosted = false, faint = false, blended = false;
  // Find what is drawn otherwise than the file says.
  for (const tinygltf::Material& material : model.materials) {
    unlit = unlit || material.extensions.contains("KHR_materials_unlit");
    const double transmission = transmission_of(material);
    faint = faint || (transmission > 0 && transmission < 0.5);
    frosted = frosted || (material.extensions.contains("KHR_materials_transmission") &&
                          material.pbrMetallicRoughness.roughnessFactor > kMostClearRoughness);
    const std::vector<double>& color = material.pbrMetallicRoughness.baseColorFactor;
    blended =
        blended || (material.alphaMode == "BLEND" && color.size() == 4 && color[3] >= 0.5 && color[3] < 1);
  }
  const bool orthographic = std::ranges::any_of(
      model.cameras, [](const tinygltf::Camera& camera) { return camera.type == "orthographic"; });
  // Name each once.
  std::string text;
  const auto add = [&](bool any, const char* words) {
    if (any) text += (text.empty() ? "" : "; ") + std::string(words);
  };
  add(faint, "KHR_materials_transmission below 0.5 (it is drawn opaque)");
  add(frosted, "rough KHR_materials_transmission (what is behind the glass is sharp)");
  add(blended, "blending from an alpha of 0.5 on (it is drawn opaque)");
  add(orthographic, "orthographic cameras (views are perspective)");
  add(unlit, "KHR_materials_unlit (it is lit)");
  return text;
}

class GltfLoader {
 public:
  GltfLoader(const GltfDocument& document, const SceneFiles& files, const std::string& name, ImageUse use)
      : document_(document),
        model_(document.model()),
        name_(name),
        builder_(files, name, use),
        materials_(document, builder_),
        meshes_(document, materials_, builder_) {}

  Result<Scene> load() {
    if (const std::string ignored = ignored_features(model_); !ignored.empty())
      log_warning(name_ + ": not supported, and ignored: " + ignored);
    walk(root_nodes());
    auto scene = std::move(builder_).finish();
    if (scene && scene->camera) aim_at_middle(*scene);
    return scene;
  }

 private:
  /// State that a node passes on to its children.
  struct Visit {
    int node = 0;
    glm::dmat4 world_from_parent{1};
    std::optional<Role> role = {};  ///< Role of the nearest node that has one.
    bool is_grenade = false;
  };

  std::vector<Visit> root_nodes() const {
    std::vector<Visit> roots;
    if (!model_.scenes.empty()) {
      const int chosen = std::max(model_.defaultScene, 0);
      for (const int node : model_.scenes[static_cast<std::size_t>(chosen)].nodes) roots.push_back({node});
      return roots;
    }
    // Without scenes: every node without a parent.
    std::vector<bool> is_child(model_.nodes.size());
    for (const tinygltf::Node& node : model_.nodes) {
      for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
    }
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) roots.push_back({static_cast<int>(i)});
    }
    return roots;
  }

  /// Visits nodes in document order, without recursion, because files control the depth.
  void walk(std::vector<Visit> pending) {
    std::reverse(pending.begin(), pending.end());
    std::vector<bool> visited(model_.nodes.size());
    while (!pending.empty()) {
      Visit visit = pending.back();
      pending.pop_back();
      const auto at = static_cast<std::size_t>(visit.node);
      const std::string place = document_.place("nodes", at);
      if (visited[at])
        document_.fail(place, "is reached twice; expected a tree, where a node has one parent");
      visited[at] = true;

      const tinygltf::Node& node = model_.nodes[at];
      visit.world_from_parent = visit.world_from_parent * local_matrix(node);
      read_node(node, place, visit);
      for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
        visit.node = *child;
        pending.push_back(visit);
      }
    }
  }

  /// Adds the node's mesh, light and camera, and updates the state for its children.
  void read_node(const tinygltf::Node& node, const std::string& place, Visit& visit) {
    if (const auto role = role_of_node(node, place)) visit.role = role;
    visit.is_grenade = visit.is_grenade || node.name == "Grenade";

    if (node.mesh >= 0) add_mesh(node, place, visit);
    if (node.camera >= 0) add_camera(node.camera, place, visit.world_from_parent);
    const auto light = node.extensions.find("KHR_lights_punctual");
    if (light != node.extensions.end())
      add_light(light->second.Get("light").GetNumberAsInt(), place, visit.world_from_parent);
  }

  /// By its extras, which may be any value, or its name.
  std::optional<Role> role_of_node(const tinygltf::Node& node, const std::string& place) {
    if (const auto role = materials_.role_of_extras(node.extras, place)) return role;
    return is_true(node.extras, "brume_ignore") ? Role::ghost : role_of_prefix(node.name);
  }

  void add_mesh(const tinygltf::Node& node, const std::string& place, const Visit& visit) {
    const std::vector<double>& weights = model_.meshes[static_cast<std::size_t>(node.mesh)].weights;
    const auto& parts = meshes_.parts(node.mesh, node.weights.empty() ? weights : node.weights, node.skin);
    if (parts.empty()) return;
    const std::string mesh_name = builder_.scene.meshes[parts.front().mesh].name;
    Object object;
    object.name = node.name.empty() ? mesh_name : node.name;
    // A skin alone places its mesh: its vertices are in world space.
    const glm::dmat4 world_from_mesh = node.skin < 0 ? visit.world_from_parent : glm::dmat4(1);
    object.world_from_mesh = glm::mat4(world_from_mesh);
    const std::optional<Role> own = visit.role ? visit.role : role_of_prefix(mesh_name);
    if (visit.is_grenade || mesh_name == "Grenade") {
      set_grenade(place, parts, object);
      return;
    }
    for (const glm::dmat4& instance : instances_of(node, place)) {
      object.world_from_mesh = glm::mat4(world_from_mesh * instance);
      for (const GltfMeshes::Part& part : parts) {
        object.mesh = part.mesh;
        object.material = part.material;
        object.role = own.value_or(part.role);
        object.see_through = part.role == Role::glass;
        builder_.add_object(object, place).value_or_throw();
      }
    }
  }

  /// Where a node has its mesh: once, or as EXT_mesh_gpu_instancing says.
  std::vector<glm::dmat4> instances_of(const tinygltf::Node& node, const std::string& place) const {
    const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
    if (extension == node.extensions.end() || !extension->second.Has("attributes")) return {glm::dmat4(1)};
    const std::string here = place + ".extensions.EXT_mesh_gpu_instancing.attributes";
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    // Lists of numbers, one element for each instance; all have the same length.
    std::optional<std::size_t> count;
    const auto numbers_of = [&](const char* name, int components) {
      if (!attributes.Has(name)) return std::vector<double>();
      const std::string user = here + "." + name;
      const std::vector<float> found =
          document_.floats(attributes.Get(name).GetNumberAsInt(), components, user);
      const std::size_t elements = found.size() / static_cast<std::size_t>(components);
      if (count.value_or(elements) != elements)
        document_.fail(here, "have different counts; expected one of each for every instance");
      count = elements;
      return std::vector<double>(found.begin(), found.end());
    };
    const auto translations = numbers_of("TRANSLATION", 3), rotations = numbers_of("ROTATION", 4),
               scales = numbers_of("SCALE", 3);
    if (!count) return {glm::dmat4(1)};
    // Elements that are missing leave their part of the transform out.
    std::vector<glm::dmat4> instances;
    for (std::size_t i = 0; i < *count; ++i) {
      const auto element = [i](const std::vector<double>& numbers, std::size_t components) {
        return numbers.empty() ? std::span<const double>()
                               : std::span(numbers).subspan(i * components, components);
      };
      instances.push_back(composed(element(translations, 3), element(rotations, 4), element(scales, 3)));
    }
    return instances;
  }

  /// The grenade is one object: its parts become one mesh with the first part's material.
  void set_grenade(const std::string& place, const std::vector<GltfMeshes::Part>& parts, Object object) {
    if (builder_.has_grenade()) {
      log_warning(place + ": a second mesh of a Grenade is ignored");
      return;
    }
    Mesh merged;
    for (const GltfMeshes::Part& part : parts) {
      const Mesh& mesh = builder_.scene.meshes[part.mesh];
      const auto first = static_cast<std::uint32_t>(merged.vertices.size());
      merged.vertices.insert(merged.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
      for (const std::uint32_t index : mesh.indices) merged.indices.push_back(first + index);
    }
    object.mesh = builder_.add_mesh(std::move(merged)).value_or_throw();
    object.material = parts.front().material;
    builder_.set_grenade(object, place).value_or_throw();
  }

  void add_camera(int index, const std::string& place, const glm::dmat4& world_from_node) {
    const tinygltf::Camera& camera = model_.cameras[static_cast<std::size_t>(index)];
    if (builder_.scene.camera || camera.type != "perspective") return;
    Camera result;
    result.vertical_fov = static_cast<float>(camera.perspective.yfov);
    result.position_world = position(world_from_node, place);
    result.target_world = result.position_world + forward(world_from_node);
    builder_.scene.camera = result;
  }

  static void aim_at_middle(Scene& scene) {
    const Box<float> bounds = world_bounds(scene);
    if (bounds.empty()) return;
    Camera& camera = *scene.camera;
    const glm::vec3 axis = glm::normalize(camera.target_world - camera.position_world);
    const glm::vec3 middle = (bounds.low + bounds.high) / 2.0f;
    camera.target_world =
        camera.position_world + axis * std::max(1.0f, glm::dot(middle - camera.position_world, axis));
  }

  void add_light(int index, const std::string& place, const glm::dmat4& world_from_node) {
    const tinygltf::Light& source = model_.lights[static_cast<std::size_t>(index)];
    const std::string light_place =
        document_.place("extensions.KHR_lights_punctual.lights", static_cast<std::size_t>(index));
    Light light;
    if (source.type == "spot") {
      // Equal ones are a hard edge, as Blender writes it.
      if (source.spot.innerConeAngle > source.spot.outerConeAngle && !std::exchange(warned_of_cone_, true))
        log_warning(light_place + ".spot: its inner cone is wider than the outer one, which counts for both");
      light.kind = LightKind::spot;
      light.cos_outer = static_cast<float>(std::cos(source.spot.outerConeAngle));
      light.cos_inner =
          static_cast<float>(std::cos(std::min(source.spot.innerConeAngle, source.spot.outerConeAngle)));
    } else if (source.type == "directional") {
      light.kind = LightKind::directional;
    } else if (source.type != "point") {
      document_.fail(light_place + ".type", "is none of point, spot, directional");
    }
    const glm::dvec3 color = source.color.empty() ? glm::dvec3(1) : glm::make_vec3(source.color.data());
    light.intensity = glm::vec3(color * (source.intensity / kLumensPerWatt));
    light.position_world = position(world_from_node, place);
    light.direction_world = forward(world_from_node);
    builder_.scene.lights.push_back(light);
  }

  glm::vec3 position(const glm::dmat4& world_from_node, const std::string& place) const {
    const glm::dvec3 p(world_from_node[3]);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(p[axis]) <= double{kFarthest}))
        document_.fail(place, "is farther than 10,000 km from the origin");
    }
    return glm::vec3(p);
  }

  const GltfDocument& document_;
  const tinygltf::Model& model_;
  const std::string& name_;
  SceneBuilder builder_;
  GltfMaterials materials_;
  GltfMeshes meshes_;
  bool warned_of_cone_ = false;
};

}  // namespace

Result<Scene> parse_gltf(std::span<const std::byte> bytes, const std::string& name, const SceneFiles& files,
                         ImageUse use) {
  try {
    const GltfDocument document(bytes, name, files);
    const std::string& version = document.model().asset.version;
    if (!version.starts_with("2."))
      document.fail(name, "asset.version: expected 2.x, found " + version.substr(0, 16));
    return GltfLoader(document, files, name, use).load();
  } catch (const Error& error) {
    return error.failure();
  } catch (const std::bad_alloc&) {
    return Failure{ErrorCode::resource_limit, name + ": not enough memory to load the scene"};
  }
}

}  // namespace brume::scene
