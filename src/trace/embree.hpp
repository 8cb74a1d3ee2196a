// Embree 3, loaded where rays first meet triangles or spheres, so that a program which traces none needs no
// Embree.
#pragma once

#include <embree3/rtcore.h>

#include "core/error.hpp"

namespace brume::trace {

/// Its functions, without their prefix `rtc`.
struct Embree {
  decltype(&rtcAttachGeometry) AttachGeometry;
  decltype(&rtcCommitGeometry) CommitGeometry;
  decltype(&rtcCommitScene) CommitScene;
  decltype(&rtcGetDeviceError) GetDeviceError;
  decltype(&rtcIntersect1) Intersect1;
  decltype(&rtcNewDevice) NewDevice;
  decltype(&rtcNewGeometry) NewGeometry;
  decltype(&rtcNewScene) NewScene;
  decltype(&rtcOccluded1) Occluded1;
  decltype(&rtcOccluded16) Occluded16;
  decltype(&rtcOccluded8) Occluded8;
  decltype(&rtcReleaseDevice) ReleaseDevice;
  decltype(&rtcReleaseGeometry) ReleaseGeometry;
  decltype(&rtcReleaseScene) ReleaseScene;
  decltype(&rtcSetDeviceErrorFunction) SetDeviceErrorFunction;
  decltype(&rtcSetGeometryIntersectFilterFunction) SetGeometryIntersectFilterFunction;
  decltype(&rtcSetGeometryOccludedFilterFunction) SetGeometryOccludedFilterFunction;
  decltype(&rtcSetGeometryTimeStepCount) SetGeometryTimeStepCount;
  decltype(&rtcSetGeometryUserData) SetGeometryUserData;
  decltype(&rtcSetNewGeometryBuffer) SetNewGeometryBuffer;
  decltype(&rtcSetSceneBuildQuality) SetSceneBuildQuality;
  decltype(&rtcSetSceneFlags) SetSceneFlags;
  decltype(&rtcSetSceneProgressMonitorFunction) SetSceneProgressMonitorFunction;
};

/// The functions of `library`, which stays loaded. Fails with no_device where it is not installed or lacks a
/// function.
Result<Embree> load_embree(const char* library);

/// Loads Embree 3 in the first call; any thread may make it.
const Result<Embree>& find_embree();

/// After find_embree() was a success.
inline const Embree& embree() {
  return *find_embree();
}

}  // namespace brume::trace
