#include "scene/gltf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/log.hpp"
#include "scene/gltf_parts.hpp"

namespace brume::scene {
namespace {

constexpr std::uint64_t kMostElements = 1u << 30;
constexpr double kPi = 3.14159265358979323846;

glm::dmat4 local_matrix(const GltfValue& node) {
  if (const auto matrix = node.find("matrix")) {
    const std::vector<double> values = matrix->numbers(16);
    glm::dmat4 result(1);
    for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = values[static_cast<std::size_t>(i)];
    return result;
  }
  glm::dmat4 result(1);
  if (const auto translation = node.find("translation")) {
    const std::vector<double> t = translation->numbers(3);
    result = glm::translate(result, glm::dvec3(t[0], t[1], t[2]));
  }
  if (const auto rotation = node.find("rotation")) {
    const std::vector<double> r = rotation->numbers(4);
    const glm::dquat quaternion(r[3], r[0], r[1], r[2]);
    if (glm::length(quaternion) > 1e-12) result = result * glm::mat4_cast(glm::normalize(quaternion));
  }
  if (const auto scale = node.find("scale")) {
    const std::vector<double> s = scale->numbers(3);
    result = glm::scale(result, glm::dvec3(s[0], s[1], s[2]));
  }
  return result;
}

/// Where the node's -z points in the world.
glm::vec3 forward(const glm::dmat4& world_from_node) {
  const glm::dvec3 direction = -glm::dvec3(world_from_node[2]);
  const double length = glm::length(direction);
  return length > 1e-30 && length < 1e30 ? glm::vec3(direction / length) : glm::vec3(0, 0, -1);
}

class GltfLoader {
 public:
  GltfLoader(GltfValue document, const SceneFiles& files, std::optional<std::span<const std::byte>> binary)
      : document_(std::move(document)),
        builder_(files, *document_.file()),
        buffers_(document_, files, binary),
        materials_(document_, buffers_, builder_, files),
        meshes_(document_, buffers_, materials_, builder_) {}

  Result<Scene> load() {
    check_extensions();
    walk(root_nodes());
    auto scene = std::move(builder_).finish();
    if (scene && scene->camera) aim_at_middle(*scene);
    return scene;
  }

 private:
  /// What a node hands down to its children.
  struct Visit {
    std::uint64_t node = 0;
    glm::dmat4 world_from_parent{1};
    bool voxelized = true, is_grenade = false;
  };

  void check_extensions() const {
    const auto required = document_.find("extensionsRequired");
    for (std::size_t i = 0; required && i < required->size(); ++i) {
      const std::string& name = (*required)[i].text();
      if (name != "KHR_lights_punctual" && name != "KHR_mesh_quantization" &&
          name != "KHR_texture_transform" && !name.starts_with("KHR_materials_")) {
        (*required)[i].fail("the file needs the extension " + name +
                            ", which is not known; export it without");
      }
    }
  }

  std::vector<Visit> root_nodes() const {
    std::vector<Visit> roots;
    const auto scenes = document_.find("scenes");
    if (scenes && scenes->size() > 0) {
      const auto chosen = document_.find("scene");
      const GltfValue scene =
          gltf_element(document_, "scenes", chosen ? chosen->whole(kMostElements) : 0, document_);
      const auto nodes = scene.find("nodes");
      for (std::size_t i = 0; nodes && i < nodes->size(); ++i)
        roots.push_back({(*nodes)[i].whole(kMostElements)});
      return roots;
    }
    // Without scenes: every node that is nobody's child.
    const auto nodes = document_.find("nodes");
    std::vector<bool> is_child(nodes ? nodes->size() : 0);
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      const auto children = (*nodes)[i].find("children");
      for (std::size_t k = 0; children && k < children->size(); ++k)
        is_child[(*children)[k].whole(is_child.size() - 1)] = true;
    }
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) roots.push_back({i});
    }
    return roots;
  }

  /// Visits nodes in the document's order, without recursion: files choose the depth.
  void walk(std::vector<Visit> pending) {
    std::reverse(pending.begin(), pending.end());
    std::vector<bool> visited;
    while (!pending.empty()) {
      const Visit visit = pending.back();
      pending.pop_back();
      const GltfValue node = gltf_element(document_, "nodes", visit.node, document_);
      if (visited.size() <= visit.node) visited.resize(visit.node + 1);
      if (visited[visit.node]) node.fail("is reached twice; expected a tree, where a node has one parent");
      visited[visit.node] = true;

      Visit handed = visit;
      handed.world_from_parent = visit.world_from_parent * local_matrix(node);
      read_node(node, handed);
      const auto children = node.find("children");
      for (std::size_t i = children ? children->size() : 0; i-- > 0;) {
        handed.node = (*children)[i].whole(kMostElements);
        pending.push_back(handed);
      }
    }
  }

  /// Adds what stands at the node, and updates what its children get.
  void read_node(const GltfValue& node, Visit& visit) {
    const std::string name = node.text_or("name", "");
    const auto extras = node.find("extras");
    // Extras may be any value; only objects can hold the mark.
    if (name.starts_with("IGNORE_") || (extras && extras->is_object() && has_ignore_mark(*extras)))
      visit.voxelized = false;
    visit.is_grenade = visit.is_grenade || name == "Grenade";

    if (const auto mesh = node.find("mesh")) add_mesh(node, *mesh, name, visit);
    if (const auto camera = node.find("camera")) add_camera(*camera, visit.world_from_parent);
    const auto extensions = node.find("extensions");
    const auto light = extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
    if (light) add_light(light->member("light"), visit.world_from_parent);
  }

  static bool has_ignore_mark(const GltfValue& extras) {
    const auto mark = extras.find("brume_ignore");
    return mark && mark->is_true();
  }

  void add_mesh(const GltfValue& node, const GltfValue& reference, const std::string& name,
                const Visit& visit) {
    const auto& parts = meshes_.parts(reference.whole(kMostElements), reference);
    if (parts.empty()) return;
    const std::string mesh_name = builder_.scene.meshes[parts.front().mesh].name;
    Object object;
    object.name = name.empty() ? mesh_name : name;
    object.world_from_mesh = glm::mat4(visit.world_from_parent);
    object.voxelized = visit.voxelized && !mesh_name.starts_with("IGNORE_");
    if (visit.is_grenade || mesh_name == "Grenade") {
      set_grenade(node, parts, object);
      return;
    }
    for (const GltfMeshes::Part& part : parts) {
      object.mesh = part.mesh;
      object.material = part.material;
      builder_.add_object(object, node.place()).value_or_throw();
    }
  }

  /// The grenade is one object: its parts become one mesh, in the first part's material.
  void set_grenade(const GltfValue& node, const std::vector<GltfMeshes::Part>& parts, Object object) {
    if (builder_.has_grenade()) {
      log_warning(node.place() + ": a second mesh of a Grenade is left out");
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
    builder_.set_grenade(object, node.place()).value_or_throw();
  }

  void add_camera(const GltfValue& reference, const glm::dmat4& world_from_node) {
    const GltfValue camera = gltf_element(document_, "cameras", reference.whole(kMostElements), reference);
    const auto perspective = camera.find("perspective");
    if (builder_.scene.camera || !perspective) return;
    Camera result;
    result.vertical_fov = static_cast<float>(perspective->member("yfov").number(0.001, kPi - 0.001));
    result.position_world = position(world_from_node, reference);
    result.target_world = result.position_world + forward(world_from_node);
    builder_.scene.camera = result;
  }

  static void aim_at_middle(Scene& scene) {
    const Bounds bounds = world_bounds(scene);
    Camera& camera = *scene.camera;
    const glm::vec3 axis = glm::normalize(camera.target_world - camera.position_world);
    const glm::vec3 middle = (bounds.min + bounds.max) / 2.0f;
    camera.target_world =
        camera.position_world + axis * std::max(1.0f, glm::dot(middle - camera.position_world, axis));
  }

  void add_light(const GltfValue& reference, const glm::dmat4& world_from_node) {
    const auto extensions = document_.find("extensions");
    const auto lights = extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
    if (!lights) reference.fail("names a light, but the document has none");
    const GltfValue description = gltf_element(*lights, "lights", reference.whole(kMostElements), reference);
    Light light;
    const std::string& type = description.member("type").text();
    if (type == "spot") {
      light.kind = LightKind::spot;
      double inner = 0, outer = kPi / 4;
      if (const auto spot = description.find("spot")) {
        outer = spot->number_or("outerConeAngle", outer, 0, kPi / 2);
        inner = spot->number_or("innerConeAngle", inner, 0, kPi / 2);
      }
      light.cos_outer = static_cast<float>(std::cos(outer));
      light.cos_inner = static_cast<float>(std::cos(std::min(inner, outer)));
    } else if (type == "directional") {
      light.kind = LightKind::directional;
    } else if (type != "point") {
      description.member("type").fail("is none of point, spot, directional");
    }
    light.intensity = description.vec3_or("color", glm::vec3(1), 0, 1e6) *
                      static_cast<float>(description.number_or("intensity", 1, 0, 1e12));
    light.position_world = position(world_from_node, reference);
    light.direction_world = forward(world_from_node);
    builder_.scene.lights.push_back(light);
  }

  static glm::vec3 position(const glm::dmat4& world_from_node, const GltfValue& reference) {
    const glm::dvec3 p(world_from_node[3]);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(p[axis]) <= double{kFarthest}))
        reference.fail("stands farther than 10,000 km from the origin");
    }
    return glm::vec3(p);
  }

  GltfValue document_;
  SceneBuilder builder_;
  GltfBuffers buffers_;
  GltfMaterials materials_;
  GltfMeshes meshes_;
};

}  // namespace

Result<Scene> parse_gltf(std::span<const std::byte> bytes, const std::string& name, const SceneFiles& files) {
  try {
    const GltfContainer container = split_gltf(bytes, name);
    const nlohmann::json json = parse_gltf_json(container.json, name);
    const GltfValue document(json, "", std::make_shared<const std::string>(name));
    const std::string version = document.member("asset").member("version").text();
    if (!version.starts_with("2.")) {
      return Failure{ErrorCode::bad_input,
                     name + ": asset.version: expected 2.x, found " + version.substr(0, 16)};
    }
    return GltfLoader(document, files, container.binary).load();
  } catch (const Error& error) {
    return error.failure();
  } catch (const std::bad_alloc&) {
    return Failure{ErrorCode::resource_limit, name + ": needs more memory than there is"};
  }
}

}  // namespace brume::scene
