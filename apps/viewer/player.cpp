#include "apps/viewer/player.hpp"

#include <algorithm>
#include <cmath>

namespace brume::viewer {
namespace {

constexpr float kMaxPitch = 1.55f;  // [rad], below pi / 2, where the yaw is undefined

}  // namespace

void Player::look_along(const scene::Camera& camera) {
  const glm::vec3 apart = camera.target_world - camera.position_world;
  const glm::vec3 direction = glm::length(apart) > 1e-6f ? glm::normalize(apart) : glm::vec3(0, 0, -1);
  yaw_ = std::atan2(direction.x, -direction.z);
  pitch_ = std::clamp(std::asin(std::clamp(direction.y, -1.0f, 1.0f)), -kMaxPitch, kMaxPitch);
  vertical_fov_ = camera.vertical_fov;
}

void Player::go_to(const voxel::BitGrid& grid, const scene::Camera& camera) {
  look_along(camera);
  followed_.reset();
  walker_.put(grid, camera.position_world);
}

void Player::follow(const scene::Camera& camera) {
  look_along(camera);
  followed_ = camera;
}

void Player::turn(glm::dvec2 look_px) {
  yaw_ += static_cast<float>(look_px.x) * kRadiansPerPixel;
  pitch_ = std::clamp(pitch_ - static_cast<float>(look_px.y) * kRadiansPerPixel, -kMaxPitch, kMaxPitch);
}

void Player::set_flying(const voxel::BitGrid& grid, bool flying) {
  walker_.set_flying(grid, flying);
}

void Player::change_fly_speed(const voxel::BitGrid& grid, double notches) {
  scenario::WalkerOptions options = walker_.options();
  options.fly_speed =
      std::clamp(options.fly_speed * static_cast<float>(std::pow(1.25, notches)), 0.5f, 100.0f);
  walker_.set_options(grid, options);
}

void Player::move(const Input& input, const voxel::BitGrid& grid, double seconds) {
  if (followed_) go_to(grid, scene::Camera(*followed_));
  const auto axis = [&](Action positive, Action negative) {
    return (input.is_held(positive) ? 1.0f : 0.0f) - (input.is_held(negative) ? 1.0f : 0.0f);
  };
  const glm::vec3 ahead(std::sin(yaw_), 0, -std::cos(yaw_)), right(std::cos(yaw_), 0, std::sin(yaw_));
  scenario::WalkerInput motion;
  motion.direction_world = axis(Action::forward, Action::back) * (flying() ? direction_world() : ahead) +
                           axis(Action::right, Action::left) * right;
  if (flying()) motion.direction_world.y += axis(Action::up, Action::down);
  const float length = glm::length(motion.direction_world);
  if (length > 1) motion.direction_world /= length;
  motion.jump = !flying() && input.is_held(Action::up);
  motion.run = !flying() && input.is_held(Action::down);
  walker_.move(grid, motion, seconds);
}

glm::vec3 Player::direction_world() const {
  return {std::cos(pitch_) * std::sin(yaw_), std::sin(pitch_), -std::cos(pitch_) * std::cos(yaw_)};
}

scene::Camera Player::camera() const {
  if (followed_) return *followed_;
  scene::Camera camera;
  camera.position_world = walker_.eye_world();
  camera.target_world = camera.position_world + direction_world();
  camera.vertical_fov = vertical_fov_;
  return camera;
}

glm::vec3 direction_through(const scene::Camera& camera, float aspect, glm::vec2 point) {
  const glm::vec3 forward = glm::normalize(camera.target_world - camera.position_world);
  const glm::vec3 helper = std::abs(forward.y) > 0.999f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(forward, helper)), up = glm::cross(right, forward);
  const float tan_y = std::tan(0.5f * camera.vertical_fov);
  return glm::normalize(forward + (2 * point.x - 1) * aspect * tan_y * right -
                        (2 * point.y - 1) * tan_y * up);
}

}  // namespace brume::viewer
