#include "trace/triangle_tree.hpp"

#include <algorithm>

namespace brume::trace {

Result<void> TriangleTree::add(const TriangleMesh& mesh) {
  const Geometry geometry = scene_.make(RTC_GEOMETRY_TYPE_TRIANGLE);
  if (!geometry) return scene_.failure();
  std::vector<std::span<const glm::vec3>> steps{mesh.corners};
  steps.insert(steps.end(), mesh.moved.begin(), mesh.moved.end());
  embree().SetGeometryTimeStepCount(geometry.get(), static_cast<unsigned int>(steps.size()));
  for (unsigned int step = 0; step < steps.size(); ++step) {
    void* const vertices =
        embree().SetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3,
                                      sizeof(glm::vec3), mesh.corners.size());
    if (!vertices) return scene_.failure();
    std::ranges::copy(steps[step], static_cast<glm::vec3*>(vertices));
  }
  void* const indices =
      embree().SetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
  if (!indices) return scene_.failure();
  std::ranges::copy(mesh.indices, static_cast<std::uint32_t*>(indices));
  if (mesh.filter) {
    embree().SetGeometryUserData(geometry.get(), mesh.filter_data);
    embree().SetGeometryIntersectFilterFunction(geometry.get(), mesh.filter);
    embree().SetGeometryOccludedFilterFunction(geometry.get(), mesh.filter);
  }
  return scene_.attach(geometry);
}

Result<void> TriangleTree::build(const std::string& job, std::span<const TriangleMesh> meshes,
                                 const std::atomic<bool>* stopped) {
  if (const auto begun = scene_.begin(job, "the mesh; simplify it", stopped); !begun) return begun;
  for (const TriangleMesh& mesh : meshes)
    if (const auto added = add(mesh); !added) return added;
  return scene_.commit();
}

}  // namespace brume::trace
