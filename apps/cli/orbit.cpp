#include "apps/cli/orbit.hpp"

#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "scene/options.hpp"

namespace brume::cli {
namespace {

/// Horizontal distance from the axis, relative to that from the centre, below which a turn shows nothing.
constexpr float kLeastReach = 1e-4f;

/// Corners of boxes around all that is visible before time passes.
std::vector<glm::vec3> corners_of(const scenario::Scenario& scenario) {
  std::vector<glm::vec3> corners = scene::level_corners(scenario.scene);
  for (std::size_t i = 0; i < scenario.timeline.volumes.size(); ++i) {
    const auto more = volumes::corners_of(scenario.timeline.volumes[i], *scenario.volumes, i);
    corners.insert(corners.end(), more.begin(), more.end());
  }
  return corners;
}

}  // namespace

Orbit::Orbit(const scenario::Scenario& scenario, const std::optional<scene::Camera>& chosen, double degrees,
             FrameRange range, float aspect)
    : Orbit([&scenario](
                double seconds) { return scene::camera_at(scenario.timeline, scenario.camera, seconds); },
            chosen, degrees, range) {
  // What it circles, and from where, unless that is chosen.
  if (!still_ && scenario.timeline.camera.empty()) {
    still_ = scenario.camera;
    const Box<float> bounds = scene::world_bounds(scenario.scene);
    if (scenario.camera_is_fitted && !bounds.empty()) {
      centre_world_ = 0.5f * (bounds.low + bounds.high);
      still_ = scene::fitted_to_orbit(corners_of(scenario), *still_, *centre_world_, radians_, aspect);
    }
  }

  check();
}

Orbit::Orbit(scenario::CameraAt path, const std::optional<scene::Camera>& chosen, double degrees,
             FrameRange range)
    : path_(std::move(path)), still_(chosen), radians_(degrees * scene::kRadiansOfDegree), range_(range) {
  check();
}

// A camera on the axis would only roll, which a position and a target cannot express.
void Orbit::check() const {
  if (!still_) return;
  const glm::vec3 off = still_->position_world - centre_world_.value_or(still_->target_world);
  if (std::hypot(off.x, off.z) < kLeastReach * glm::length(off))
    throw Error(ErrorCode::usage,
                "--orbit: the camera is right above or below what it circles; choose another with --camera");
}

scene::Camera Orbit::at(double seconds, double frame) const {
  const scene::Camera camera = still_ ? *still_ : path_(seconds);
  const double first = range_.first, count = range_.last - first + 1, fraction = (frame - first) / count;
  return scene::orbited(camera, centre_world_.value_or(camera.target_world), fraction * radians_);
}

}  // namespace brume::cli
