// How frames of a scenario differ from what its timeline says.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "scene/carrier.hpp"
#include "scene/scene.hpp"
#include "volumes/volumes.hpp"

namespace brume::scenario {

using CameraAt = std::function<scene::Camera(double seconds)>;

struct FrameOptions {
  volumes::VolumeWait wait = volumes::VolumeWait::until_loaded;
  /// In place of the timeline's carriers; of the same names and objects. Null: the timeline's.
  const std::vector<scene::Carrier>* steered = nullptr;
  /// Whether volumes that the timeline shows as particles are; else they are volumes like others.
  bool particles = true;
  /// Where the camera is at a time [s], in place of the timeline's path; empty: there.
  CameraAt camera = {};
  /// In the place of the timeline's samples of tanks, for frames that follow each other: as long as nothing
  /// moves in front of a tank, each frame adds its samples to those before (TankInput::continues).
  std::optional<std::uint32_t> tank_samples = {};
};

}  // namespace brume::scenario
