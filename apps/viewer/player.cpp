#include "apps/viewer/player.hpp"

#include <algorithm>
#include <cmath>

#include "scenario/aim.hpp"

namespace brume::viewer {
namespace {

constexpr float kMaxPitch = 1.55f;  // [rad], below pi / 2, where the yaw is undefined
// A body walks at the start of a level if its fall is no deeper, and is put back after a deeper one onto the
// bottom of the grid, where nothing is to be seen [m].
constexpr float kShortFall = 2;
constexpr float kFarthestFloor = 4096;  // [m]

/// How far the feet are above something solid [m].
std::optional<float> height_above_floor(const voxel::BitGrid& grid, glm::vec3 feet_world) {
  constexpr float kAbove = 0.5f;  // begins above the floor that the feet touch
  const glm::vec3 from = feet_world + glm::vec3(0, kAbove, 0);
  const auto floor = scenario::aim(grid, from, glm::vec3(0, -1, 0), kFarthestFloor).meets;
  return floor ? std::optional(std::max(*floor - kAbove, 0.0f)) : std::nullopt;
}

/// How far a body falls [m], if anything stops it but a bottom of the grid deep below.
std::optional<float> height_of_fall(const voxel::BitGrid& grid, glm::vec3 feet_world) {
  if (const auto height = height_above_floor(grid, feet_world)) return height;
  const float height = feet_world.y - grid.layout().origin_world.y;
  return height <= kShortFall ? std::optional(std::max(height, 0.0f)) : std::nullopt;
}

}  // namespace

void Player::look_along(const scene::Camera& camera) {
  const glm::vec3 apart = camera.target_world - camera.position_world;
  const glm::vec3 direction = glm::length(apart) > 1e-6f ? glm::normalize(apart) : glm::vec3(0, 0, -1);
  yaw_ = std::atan2(direction.x, -direction.z);
  pitch_ = std::clamp(std::asin(std::clamp(direction.y, -1.0f, 1.0f)), -kMaxPitch, kMaxPitch);
  optics_ = optics_of(camera);
  // Its target is not kept.
  if (optics_.lens.aperture > 0) optics_.lens.focus = scene::focus_distance(camera);
}

void Player::go_to(const voxel::BitGrid& grid, const scene::Camera& camera) {
  look_along(camera);
  followed_.reset();
  walker_.put(grid, camera.position_world);
}

void Player::start(const voxel::BitGrid& grid, const scene::Camera& camera) {
  const glm::vec3 feet = camera.position_world - glm::vec3(0, walker_.options().eye, 0);
  const auto fall = height_of_fall(grid, feet);
  last_stood_world_.reset();
  walker_.set_flying(grid, !fall || *fall > kShortFall);
  go_to(grid, camera);
}

void Player::follow(const scene::Camera& camera) {
  look_along(camera);
  followed_ = camera;
}

void Player::turn(glm::dvec2 look_px) {
  yaw_ += static_cast<float>(look_px.x) * kRadiansPerPixel;
  pitch_ = std::clamp(pitch_ - static_cast<float>(look_px.y) * kRadiansPerPixel, -kMaxPitch, kMaxPitch);
}

bool Player::set_flying(const voxel::BitGrid& grid, bool flying) {
  if (!flying && !height_of_fall(grid, walker_.feet_world())) return false;
  walker_.set_flying(grid, flying);
  return true;
}

bool Player::fell_off(const voxel::BitGrid& grid) {
  if (flying() || !walker_.on_ground()) return false;
  const glm::vec3 feet = walker_.feet_world();
  const bool on_bottom = feet.y < grid.layout().origin_world.y + 0.01f;
  if (!on_bottom || !last_stood_world_ || last_stood_world_->y - feet.y < kShortFall) {
    last_stood_world_ = feet;
    return false;
  }
  walker_.put(grid, *last_stood_world_ + glm::vec3(0, walker_.options().eye, 0));
  return true;
}

void Player::change_fly_speed(const voxel::BitGrid& grid, double notches) {
  scenario::WalkerOptions options = walker_.options();
  options.fly_speed =
      std::clamp(options.fly_speed * static_cast<float>(std::pow(1.25, notches)), 0.5f, 100.0f);
  walker_.set_options(grid, options);
}

bool Player::move(const Input& input, const voxel::BitGrid& grid, double seconds) {
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
  return !fell_off(grid);
}

glm::vec3 Player::direction_world() const {
  return {std::cos(pitch_) * std::sin(yaw_), std::sin(pitch_), -std::cos(pitch_) * std::cos(yaw_)};
}

scene::Camera Player::camera() const {
  if (followed_) return *followed_;
  scene::Camera camera;
  camera.position_world = walker_.eye_world();
  camera.target_world = camera.position_world + direction_world();
  return with_optics(camera, optics_);
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
