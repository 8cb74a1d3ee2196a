#include "scenario/world_triangles.hpp"

#include <algorithm>

#include "core/tasks.hpp"

namespace brume::scenario {
namespace {

using voxel::Triangle;

// An object and the position of its triangles in the list.
struct Part {
  const scene::Object* object;
  std::size_t first;
};

void place_object(const scene::Object& object, const scene::Mesh& mesh, Triangle* out) {
  const auto corner = [&](std::size_t i) {
    return glm::vec3(object.world_from_mesh * glm::vec4(mesh.vertices[mesh.indices[i]].position, 1));
  };
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    *out++ = {corner(i), corner(i + 1), corner(i + 2)};
}

}  // namespace

std::vector<Triangle> world_triangles(const scene::Scene& scene, bool (*stops)(Role)) {
  std::vector<Part> parts;
  std::size_t count = 0;
  for (const scene::Object& object : scene.objects) {
    if (!stops(object.role) || object.mesh == scene::kNone) continue;
    parts.push_back({&object, count});
    count += scene.meshes[object.mesh].indices.size() / 3;
  }
  std::vector<Triangle> triangles(count);
  parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      place_object(*parts[i].object, scene.meshes[parts[i].object->mesh], triangles.data() + parts[i].first);
  });
  return triangles;
}

voxel::TrianglesByRole triangles_by_role(const scene::Scene& scene) {
  const auto any = [&](Role role) {
    return std::ranges::find(scene.objects, role, &scene::Object::role) != scene.objects.end();
  };
  voxel::TrianglesByRole triangles{world_triangles(scene), {}, {}};
  if (any(Role::glass)) triangles.walls = world_triangles(scene, stops_sight);
  if (any(Role::grille))
    triangles.grilles = world_triangles(scene, [](Role role) { return role == Role::grille; });
  return triangles;
}

std::vector<Triangle> object_triangles(const scene::Scene& scene, const scene::Object& object) {
  if (object.mesh == scene::kNone) return {};
  const scene::Mesh& mesh = scene.meshes[object.mesh];
  std::vector<Triangle> triangles(mesh.indices.size() / 3);
  place_object(object, mesh, triangles.data());
  return triangles;
}

}  // namespace brume::scenario
