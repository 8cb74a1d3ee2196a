// The path of a camera: its keys, and where it is between them.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace brume::scene {

struct CameraKey {
  double time = 0;  ///< [s], [0, 3600].
  Camera camera;
  std::string place = {};  ///< Where the file names the lens's opening, for messages.
};

/// The camera at a time [s]: passes through all keys with continuous velocity, at rest before the first and
/// after the last; `fallback` when there are no keys. The field of view stays within that of the two
/// neighbouring keys.
Camera camera_at(const std::vector<CameraKey>& keys, const Camera& fallback, double time);

}  // namespace brume::scene
