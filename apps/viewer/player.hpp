// The person at the window: where they stand, where they look, how they move.
#pragma once

#include <optional>

#include "apps/viewer/window.hpp"
#include "scene/scene.hpp"
#include "scenario/walker.hpp"

namespace brume::viewer {

class Player {
 public:
  static constexpr float kRadiansPerPixel = 0.0022f;  // of the mouse

  /// Stands (or flies) where a camera is, and looks where it looks.
  void go_to(const voxel::BitGrid& grid, const scene::Camera& camera);
  /// Is carried along a path: its camera is exactly this one until it moves by itself again.
  void ride(const scene::Camera& camera);
  void turn(glm::dvec2 look_px);
  void set_flying(const voxel::BitGrid& grid, bool flying);
  bool flying() const { return walker_.flying(); }
  /// Moves for a time [s] as the keys say.
  void move(const Input& input, const voxel::BitGrid& grid, double seconds);
  /// Each notch makes flight a quarter faster or slower.
  void change_fly_speed(const voxel::BitGrid& grid, double notches);

  scene::Camera camera() const;
  glm::vec3 direction_world() const;
  void set_vertical_fov(float radians) { vertical_fov_ = radians; }
  const scenario::WalkerOptions& options() const { return walker_.options(); }
  void set_options(const voxel::BitGrid& grid, const scenario::WalkerOptions& options) {
    walker_.set_options(grid, options);
  }

 private:
  void look_along(const scene::Camera& camera);

  scenario::Walker walker_;
  float yaw_ = 0, pitch_ = 0;  ///< [rad]; 0: along -z, level. Pitch rises upwards.
  float vertical_fov_ = 1;
  std::optional<scene::Camera> ridden_;
};

/// The direction from the eye through a place of the picture, whose size is 1 x 1, y down.
glm::vec3 direction_through(const scene::Camera& camera, float aspect, glm::vec2 place);

}  // namespace brume::viewer
