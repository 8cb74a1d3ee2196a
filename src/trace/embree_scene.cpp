#include "trace/embree_scene.hpp"

namespace brume::trace {
void EmbreeScene::note_error(void* self, RTCError error, const char*) {
  RTCError none = RTC_ERROR_NONE;
  static_cast<EmbreeScene*>(self)->error_.compare_exchange_strong(none, error);
}

Failure EmbreeScene::failure() const {
  // Embree itself keeps the error of a device that was not made.
  switch (const RTCError error = device_ ? error_.load() : embree().GetDeviceError(nullptr)) {
    case RTC_ERROR_OUT_OF_MEMORY:
      return {ErrorCode::resource_limit, job_ + ": not enough memory for " + large_};
    case RTC_ERROR_CANCELLED:
      return {ErrorCode::internal, job_ + ": stopped"};
    case RTC_ERROR_UNSUPPORTED_CPU:
      return {ErrorCode::no_device, job_ + ": Embree does not support this processor"};
    default:
      return {ErrorCode::internal, job_ + ": Embree reports the error " + std::to_string(error)};
  }
}

Result<void> EmbreeScene::check() const {
  if (error_ != RTC_ERROR_NONE) return failure();
  return {};
}

Result<void> EmbreeScene::begin(const std::string& job, const std::string& large,
                                const std::atomic<bool>* stopped) {
  job_ = job;
  large_ = large;
  if (const auto& found = find_embree(); !found)
    return Failure{found.failure().code, job + ": " + found.failure().message};
  // A device without threads of its own: sanitizers cannot see into them, and trees may depend on them.
  device_.reset(embree().NewDevice("threads=1,set_affinity=0"));
  if (!device_) return failure();
  embree().SetDeviceErrorFunction(device_.get(), note_error, this);
  scene_.reset(embree().NewScene(device_.get()));
  if (!scene_) return failure();
  embree().SetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  embree().SetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
  if (stopped)
    embree().SetSceneProgressMonitorFunction(
        scene_.get(),
        [](void* flag, double) {
          return !static_cast<const std::atomic<bool>*>(flag)->load(std::memory_order_relaxed);
        },
        const_cast<std::atomic<bool>*>(stopped));  // Only read.
  return {};
}

Result<void> EmbreeScene::attach(const Geometry& geometry) {
  embree().CommitGeometry(geometry.get());
  embree().AttachGeometry(scene_.get(), geometry.get());
  return check();
}

Result<void> EmbreeScene::commit() {
  embree().CommitScene(scene_.get());
  return check();
}

}  // namespace brume::trace
