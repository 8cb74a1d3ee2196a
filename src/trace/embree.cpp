#include "trace/embree.hpp"

#include <string>

#include "core/platform/library.hpp"

namespace brume::trace {

Result<Embree> load_embree(const char* library) {
  // Never closed: other threads may trace until the process ends.
  void* const loaded = platform::load_library(library);
  if (!loaded)
    return Failure{ErrorCode::no_device, "Embree 3 (" + std::string(library) +
                                             "), which traces rays, is not installed; install " +
                                             std::string(platform::kEmbree.install) +
                                             ", or place the library where the program finds it"};
  Embree embree{};
  const char* missing = nullptr;
  const auto find = [&](auto& function, const char* name) {
    function =
        reinterpret_cast<std::remove_reference_t<decltype(function)>>(platform::find_symbol(loaded, name));
    if (!function) missing = name;
  };
  find(embree.AttachGeometry, "rtcAttachGeometry");
  find(embree.CommitGeometry, "rtcCommitGeometry");
  find(embree.CommitScene, "rtcCommitScene");
  find(embree.GetDeviceError, "rtcGetDeviceError");
  find(embree.Intersect1, "rtcIntersect1");
  find(embree.NewDevice, "rtcNewDevice");
  find(embree.NewGeometry, "rtcNewGeometry");
  find(embree.NewScene, "rtcNewScene");
  find(embree.Occluded1, "rtcOccluded1");
  find(embree.Occluded16, "rtcOccluded16");
  find(embree.Occluded8, "rtcOccluded8");
  find(embree.ReleaseDevice, "rtcReleaseDevice");
  find(embree.ReleaseGeometry, "rtcReleaseGeometry");
  find(embree.ReleaseScene, "rtcReleaseScene");
  find(embree.SetDeviceErrorFunction, "rtcSetDeviceErrorFunction");
  find(embree.SetGeometryIntersectFilterFunction, "rtcSetGeometryIntersectFilterFunction");
  find(embree.SetGeometryOccludedFilterFunction, "rtcSetGeometryOccludedFilterFunction");
  find(embree.SetGeometryTimeStepCount, "rtcSetGeometryTimeStepCount");
  find(embree.SetGeometryUserData, "rtcSetGeometryUserData");
  find(embree.SetNewGeometryBuffer, "rtcSetNewGeometryBuffer");
  find(embree.SetSceneBuildQuality, "rtcSetSceneBuildQuality");
  find(embree.SetSceneFlags, "rtcSetSceneFlags");
  find(embree.SetSceneProgressMonitorFunction, "rtcSetSceneProgressMonitorFunction");
  if (missing)
    return Failure{ErrorCode::no_device, std::string(library) + " has no " + missing +
                                             "; install Embree 3 (" + platform::kEmbree.install + ")"};
  return embree;
}

const Result<Embree>& find_embree() {
  static const Result<Embree> found = load_embree(platform::kEmbree.file);
  return found;
}

}  // namespace brume::trace
