// What a camera has besides its place.
#pragma once

#include "scene/scene.hpp"

namespace brume::viewer {

struct Optics {
  float vertical_fov = 1;
  scene::Lens lens;
  float shutter = 0;
  bool operator==(const Optics&) const = default;
};

inline Optics optics_of(const scene::Camera& camera) {
  return {camera.vertical_fov, camera.lens, camera.shutter};
}
inline scene::Camera with_optics(scene::Camera camera, const Optics& optics) {
  camera.vertical_fov = optics.vertical_fov;
  camera.lens = optics.lens;
  camera.shutter = optics.shutter;
  return camera;
}

}  // namespace brume::viewer
