// A scene of Embree. The only place that makes Embree's devices and scenes.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "core/error.hpp"
#include "trace/embree.hpp"

namespace brume::trace {

struct GeometryRelease {
  void operator()(RTCGeometry geometry) const { embree().ReleaseGeometry(geometry); }
};
using Geometry = std::unique_ptr<RTCGeometryTy, GeometryRelease>;

/// Geometries and their tree, the same whatever the number of threads.
class EmbreeScene {
 public:
  EmbreeScene() = default;
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Makes an empty scene, once. `job` begins the messages of failures, `large` says for what there may be
  /// not enough memory, and the fix. Fails with resource_limit without enough memory, no_device on processors
  /// that Embree does not support, and, here and later, internal when `stopped` becomes true.
  Result<void> begin(const std::string& job, const std::string& large,
                     const std::atomic<bool>* stopped = nullptr);
  /// A geometry of this scene to fill; null where there is not enough memory.
  Geometry make(RTCGeometryType type) const { return Geometry(embree().NewGeometry(device_.get(), type)); }
  /// Adds a geometry that is filled; they are numbered from 0 on.
  Result<void> attach(const Geometry& geometry);
  /// Builds the tree of all geometries.
  Result<void> commit();

  RTCScene get() const { return scene_.get(); }
  /// The first error since the start, of any thread.
  Result<void> check() const;
  /// The same of a call that has failed.
  Failure failure() const;

 private:
  struct DeviceRelease {
    void operator()(RTCDevice device) const { embree().ReleaseDevice(device); }
  };
  struct SceneRelease {
    void operator()(RTCScene scene) const { embree().ReleaseScene(scene); }
  };
  static void note_error(void* self, RTCError error, const char* text);

  std::string job_, large_;
  std::atomic<RTCError> error_{RTC_ERROR_NONE};  // Outlives the device, which writes to it.
  std::unique_ptr<RTCDeviceTy, DeviceRelease> device_;
  std::unique_ptr<RTCSceneTy, SceneRelease> scene_;
};

}  // namespace brume::trace
