// The camera of `render --orbit`: it circles what it shows.
#pragma once

#include <optional>

#include "apps/command_line/parse.hpp"
#include "scenario/frame.hpp"
#include "scenario/scenario.hpp"

namespace brume::cli {

/// A turn of the camera over a range of frames.
class Orbit {
 public:
  /// `degrees` over the frames of the range, counter-clockwise as seen from above; negative: clockwise.
  /// `chosen` replaces the scenario's camera. The camera circles
  ///
  /// - the centre of the scene's bounds, if it frames the scene: it is moved back until nothing of it, and of
  ///   the first frames of volumes, leaves an image of `aspect` = width / height on the turn;
  /// - its target otherwise. It follows camera keys while it turns.
  ///
  /// Throws Error (usage) if the camera is above or below what it circles, where no turn changes the image.
  /// `scenario` must outlive it.
  Orbit(const scenario::Scenario& scenario, const std::optional<scene::Camera>& chosen, double degrees,
        FrameRange range, float aspect);
  /// A turn around the target of `chosen`, or of a camera that moves along `path`.
  Orbit(scenario::CameraAt path, const std::optional<scene::Camera>& chosen, double degrees,
        FrameRange range);

  /// The camera of a frame: after (frame - first) / count of the angle. Frames outside of the range go on;
  /// fractions are times between frames.
  scene::Camera at(double seconds, double frame) const;
  /// Where the camera is before it turns; empty: on the path of the timeline's keys.
  const std::optional<scene::Camera>& still_camera() const { return still_; }

 private:
  void check() const;

  scenario::CameraAt path_;
  std::optional<scene::Camera> still_;
  std::optional<glm::vec3> centre_world_;  ///< Empty: the camera's target.
  double radians_;
  FrameRange range_;
};

}  // namespace brume::cli
