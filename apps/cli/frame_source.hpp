// What draws the frames that `brume render` writes.
#pragma once

#include <cstdint>

#include "apps/command_line/json.hpp"
#include "apps/command_line/targets.hpp"
#include "scene/scene.hpp"

namespace brume::cli {

/// Frames of a scenario as it was when this was made.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The frame at a time [s]. Throws Error and Interrupted.
  virtual Picture draw(double seconds, std::uint32_t frame) = 0;
  /// Where the camera is from now on, instead of on the timeline's path.
  virtual void set_camera(const scene::Camera& camera) = 0;
  /// How the last frame became colours, or would.
  virtual image::Display display() const = 0;
  /// The statistics of all frames so far, for --json.
  virtual Json statistics() const = 0;
};

}  // namespace brume::cli
