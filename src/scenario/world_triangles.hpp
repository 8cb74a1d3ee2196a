// The triangles of a scene in world space, object by object.
#pragma once

#include <vector>

#include "scene/scene.hpp"
#include "voxel/solids.hpp"

namespace brume::scenario {

/// The triangles of all objects whose role `stops` accepts, in the order of objects and indices regardless of
/// the number of threads. Mesh indices must be valid, as the loaders guarantee.
std::vector<voxel::Triangle> world_triangles(const scene::Scene& scene, bool (*stops)(Role) = stops_smoke);

/// The same for all roles.
voxel::TrianglesByRole triangles_by_role(const scene::Scene& scene);

/// The triangles of one object, whatever its role.
std::vector<voxel::Triangle> object_triangles(const scene::Scene& scene, const scene::Object& object);

}  // namespace brume::scenario
