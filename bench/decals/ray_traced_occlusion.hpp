// Ambient occlusion at single points, by rays against the triangles of a mesh.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "voxel/triangle.hpp"

namespace brume::decals {

class RayTracedOcclusion {
 public:
  /// Triangles hide from both sides. `rays` per point, at least 1. Throws Error: no_device for a processor
  /// that Embree does not support, and internal.
  RayTracedOcclusion(std::span<const voxel::Triangle> triangles, int rays);
  RayTracedOcclusion(const RayTracedOcclusion&) = delete;
  RayTracedOcclusion& operator=(const RayTracedOcclusion&) = delete;
  ~RayTracedOcclusion();

  /// The fraction of a cosine-weighted hemisphere around a unit normal that the mesh hides from a point. The
  /// rays are a Fibonacci lattice on the disk below the hemisphere, rotated by `seed`. They start `offset`
  /// [m] off the point, along the normal. May be called from several threads.
  double at(glm::dvec3 p_world, glm::dvec3 normal, std::uint32_t seed, double offset) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
  std::vector<glm::vec3> directions_;  ///< Around z.
};

}  // namespace brume::decals
