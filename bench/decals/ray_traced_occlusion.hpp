// Ambient occlusion at single points, by rays against the triangles of a mesh.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "trace/triangle_tree.hpp"
#include "voxel/triangle.hpp"

namespace brume::decals {

class RayTracedOcclusion {
 public:
  /// Triangles hide from both sides. `rays` per point, at least 1. Throws Error as trace::TriangleTree fails.
  RayTracedOcclusion(std::span<const voxel::Triangle> triangles, int rays);

  /// The fraction of a cosine-weighted hemisphere around a unit normal that the mesh hides from a point. The
  /// rays are a Fibonacci lattice on the disk below the hemisphere, rotated by `seed`. They start `offset`
  /// [m] off the point, along the normal. May be called from several threads.
  double at(glm::dvec3 p_world, glm::dvec3 normal, std::uint32_t seed, double offset) const;

 private:
  trace::TriangleTree tree_;
  std::vector<glm::vec3> directions_;  ///< Around z.
};

}  // namespace brume::decals
