// The player: position, view direction and movement.
#pragma once

#include <optional>

#include "apps/viewer/optics.hpp"
#include "apps/viewer/window.hpp"
#include "scenario/walker.hpp"
#include "scene/scene.hpp"

namespace brume::viewer {

class Player {
 public:
  static constexpr float kRadiansPerPixel = 0.0022f;  ///< How far the mouse turns the view.

  /// Moves to the position and view direction of a camera, on foot or flying as before.
  void go_to(const voxel::BitGrid& grid, const scene::Camera& camera);
  /// The same at the start of a level: on foot if there is a floor within reach of a short fall, else flying.
  void start(const voxel::BitGrid& grid, const scene::Camera& camera);
  /// Follows a camera path: camera() is exactly this one until the next move().
  void follow(const scene::Camera& camera);
  void turn(glm::dvec2 look_px);
  /// Returns false, and goes on flying, if there is nothing to stand on below.
  bool set_flying(const voxel::BitGrid& grid, bool flying);
  bool flying() const { return walker_.flying(); }
  /// Moves for `seconds` as the held keys demand. Returns false if the body fell off the level: it is back
  /// where it last stood.
  bool move(const Input& input, const voxel::BitGrid& grid, double seconds);
  /// Each notch of the wheel changes the flight speed by a quarter.
  void change_fly_speed(const voxel::BitGrid& grid, double notches);

  scene::Camera camera() const;
  glm::vec3 direction_world() const;
  void set_optics(const Optics& optics) {
    optics_ = optics;
    if (followed_) followed_ = with_optics(*followed_, optics);
  }
  const scenario::WalkerOptions& options() const { return walker_.options(); }
  void set_options(const voxel::BitGrid& grid, const scenario::WalkerOptions& options) {
    walker_.set_options(grid, options);
  }

 private:
  void look_along(const scene::Camera& camera);
  bool fell_off(const voxel::BitGrid& grid);

  scenario::Walker walker_;
  std::optional<glm::vec3> last_stood_world_;  ///< Feet; on something solid.
  float yaw_ = 0, pitch_ = 0;                  ///< [rad]; 0: along -z, level. Pitch rises upwards.
  Optics optics_;
  std::optional<scene::Camera> followed_;
};

/// The direction from the eye through a point of the image, in [0, 1]^2 with y down.
glm::vec3 direction_through(const scene::Camera& camera, float aspect, glm::vec2 point);

}  // namespace brume::viewer
