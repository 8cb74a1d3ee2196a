#include "trace/triangle_tree.hpp"

#include <algorithm>

namespace brume::trace {
namespace {

struct GeometryRelease {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};

Failure embree_failure(const std::string& job, RTCError error) {
  switch (error) {
    case RTC_ERROR_OUT_OF_MEMORY:
      return {ErrorCode::resource_limit, job + ": not enough memory for the mesh; simplify it"};
    case RTC_ERROR_CANCELLED:
      return {ErrorCode::internal, job + ": stopped"};
    case RTC_ERROR_UNSUPPORTED_CPU:
      return {ErrorCode::no_device, job + ": Embree does not support this processor"};
    default:
      return {ErrorCode::internal, job + ": Embree reports the error " + std::to_string(error)};
  }
}

}  // namespace

void TriangleTree::note_error(void* self, RTCError error, const char*) {
  RTCError none = RTC_ERROR_NONE;
  static_cast<TriangleTree*>(self)->error_.compare_exchange_strong(none, error);
}

Result<void> TriangleTree::check() const {
  if (const RTCError error = error_; error != RTC_ERROR_NONE) return embree_failure(job_, error);
  return {};
}

Result<void> TriangleTree::add(const TriangleMesh& mesh) {
  const std::unique_ptr<RTCGeometryTy, GeometryRelease> geometry(
      rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  if (!geometry) return embree_failure(job_, error_);
  std::vector<std::span<const glm::vec3>> steps{mesh.corners};
  steps.insert(steps.end(), mesh.moved.begin(), mesh.moved.end());
  rtcSetGeometryTimeStepCount(geometry.get(), static_cast<unsigned int>(steps.size()));
  for (unsigned int step = 0; step < steps.size(); ++step) {
    void* const vertices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, step,
                                                   RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.corners.size());
    if (!vertices) return embree_failure(job_, error_);
    std::ranges::copy(steps[step], static_cast<glm::vec3*>(vertices));
  }
  void* const indices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
  if (!indices) return embree_failure(job_, error_);
  std::ranges::copy(mesh.indices, static_cast<std::uint32_t*>(indices));
  if (mesh.filter) {
    rtcSetGeometryUserData(geometry.get(), mesh.filter_data);
    rtcSetGeometryIntersectFilterFunction(geometry.get(), mesh.filter);
    rtcSetGeometryOccludedFilterFunction(geometry.get(), mesh.filter);
  }
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene_.get(), geometry.get());
  return check();
}

Result<void> TriangleTree::build(const std::string& job, std::span<const TriangleMesh> meshes,
                                 const std::atomic<bool>* stopped) {
  job_ = job;
  // A device without threads of its own: sanitizers cannot see into them, and trees may depend on them.
  device_.reset(rtcNewDevice("threads=1,set_affinity=0"));
  if (!device_) return embree_failure(job_, rtcGetDeviceError(nullptr));
  rtcSetDeviceErrorFunction(device_.get(), note_error, this);
  scene_.reset(rtcNewScene(device_.get()));
  if (!scene_) return embree_failure(job_, error_);
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
  if (stopped)
    rtcSetSceneProgressMonitorFunction(
        scene_.get(),
        [](void* flag, double) {
          return !static_cast<const std::atomic<bool>*>(flag)->load(std::memory_order_relaxed);
        },
        const_cast<std::atomic<bool>*>(stopped));  // Only read.
  for (const TriangleMesh& mesh : meshes)
    if (const auto added = add(mesh); !added) return added;
  rtcCommitScene(scene_.get());
  return check();
}

}  // namespace brume::trace
