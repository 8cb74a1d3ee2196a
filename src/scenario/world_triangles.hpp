// The triangles of a scene in world space, object by object.
#pragma once

#include <vector>

#include "scene/scene.hpp"
#include "voxel/triangle.hpp"

namespace brume::scenario {

/// The triangles of all voxelized objects, in the order of objects and indices regardless of the number of
/// threads. Mesh indices must be valid, as the loaders guarantee.
std::vector<voxel::Triangle> world_triangles(const scene::Scene& scene);

/// The triangles of one object, voxelized or not.
std::vector<voxel::Triangle> object_triangles(const scene::Scene& scene, const scene::Object& object);

}  // namespace brume::scenario
