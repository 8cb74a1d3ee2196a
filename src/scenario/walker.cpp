#include "scenario/walker.hpp"

#include <algorithm>
#include <cmath>

#include "scenario/body_sweep.hpp"
#include "scene/events.hpp"

namespace brume::scenario {
namespace {

using glm::dvec3;
using voxel::BitGrid;

/// Frames are split into steps no longer than this [s]: each step is straight, one axis after the other.
constexpr double kLongestStep = 1.0 / 120;
constexpr double kLongestFrame = 1;
/// Terminal velocity of a fall [m/s].
constexpr double kFastestFall = 60;
/// Acceleration on foot [m/s2], and convergence rate of the eye [1/s].
constexpr double kAcceleration = 40, kEyeRate = 11;
/// Walkers stay within the range of events [m].
constexpr double kFarthest = scene::kFarthestEvent - 4;

double finite(double value, double least, double most) {
  return std::isfinite(value) ? std::clamp(value, least, most) : 0.0;
}

/// At most 1 long; 0 if it is not finite.
dvec3 direction_of(const WalkerInput& input) {
  const dvec3 direction(input.direction_world);
  const double length = glm::length(direction);
  if (!std::isfinite(length)) return dvec3(0);
  return length > 1 ? direction / length : direction;
}

Body body_of(const WalkerOptions& options, const dvec3& feet) {
  const double half = double{options.half_width};
  return {feet - dvec3(half, 0, half), feet + dvec3(half, double{options.height}, half)};
}

/// Moves along x and then along z, each up to the first obstacle.
dvec3 slide(const BitGrid& grid, const Body& body, const dvec3& motion) {
  dvec3 done(0);
  for (const int axis : {0, 2}) done[axis] = sweep(grid, body.moved(done), axis, motion[axis]);
  return done;
}

}  // namespace

void Walker::put(const BitGrid& grid, glm::vec3 eye_world) {
  for (int axis = 0; axis < 3; ++axis) feet_[axis] = finite(double{eye_world[axis]}, -kFarthest, kFarthest);
  feet_.y -= double{options_.eye};
  velocity_ = dvec3(0);
  eye_offset_ = 0;
  on_ground_ = false;
  if (!flying_) stand_free(grid);
}

void Walker::set_flying(const BitGrid& grid, bool flying) {
  if (flying == flying_) return;
  flying_ = flying;
  velocity_ = dvec3(0);
  if (flying) feet_.y += eye_offset_;  // the eye stays where it is
  eye_offset_ = 0;
  on_ground_ = false;
  if (!flying) stand_free(grid);
}

void Walker::set_options(const BitGrid& grid, const WalkerOptions& options) {
  options_ = options;
  eye_offset_ = 0;
  if (!flying_) stand_free(grid);
}

glm::vec3 Walker::eye_world() const {
  return glm::vec3(feet_ + dvec3(0, double{options_.eye} + eye_offset_, 0));
}

void Walker::move(const BitGrid& grid, const WalkerInput& input, double seconds) {
  seconds = finite(seconds, 0, kLongestFrame);
  if (flying_) return fly(input, seconds);
  stand_free(grid);
  const int steps = static_cast<int>(std::ceil(seconds / kLongestStep));
  for (int step = 0; step < steps; ++step) walk(grid, input, seconds / steps);
}

void Walker::fly(const WalkerInput& input, double seconds) {
  const double speed = double{options_.fly_speed} * (input.run ? double{options_.run} : 1.0);
  velocity_ = speed * direction_of(input);
  feet_ = glm::clamp(feet_ + velocity_ * seconds, dvec3(-kFarthest), dvec3(kFarthest));
}

void Walker::walk(const BitGrid& grid, const WalkerInput& input, double seconds) {
  // Accelerate towards the requested velocity, also in the air.
  const double speed = double{options_.walk_speed} * (input.run ? double{options_.run} : 1.0);
  const dvec3 direction = direction_of(input);
  const dvec3 missing = dvec3(direction.x, 0, direction.z) * speed - dvec3(velocity_.x, 0, velocity_.z);
  const double change = glm::length(missing), most = std::max(kAcceleration, 10 * speed) * seconds;
  velocity_ += change > most ? missing * (most / change) : missing;

  // Jump, fall or walk.
  if (input.jump && on_ground_) {
    velocity_.y = std::sqrt(2 * double{options_.gravity} * double{options_.jump});
    on_ground_ = velocity_.y <= 0;
  }
  if (!on_ground_) fall(grid, seconds);
  stride(grid, seconds);
  if (on_ground_) stay_on_ground(grid);
  follow_with_eye(grid, seconds);
}

void Walker::fall(const BitGrid& grid, double seconds) {
  const double gravity = double{options_.gravity};
  const double before = velocity_.y;
  velocity_.y = std::max(before - gravity * seconds, -kFastestFall);
  const double distance = 0.5 * (before + velocity_.y) * seconds;
  const double done = sweep(grid, body_of(options_, feet_), 1, distance);
  feet_.y += done;
  if (done == distance) return;
  on_ground_ = distance < 0;
  velocity_.y = 0;
}

/// Horizontal motion: slides along walls and climbs steps no higher than options_.step.
void Walker::stride(const BitGrid& grid, double seconds) {
  dvec3 motion(velocity_.x * seconds, 0, velocity_.z * seconds);
  for (const int axis : {0, 2})
    motion[axis] = std::clamp(feet_[axis] + motion[axis], -kFarthest, kFarthest) - feet_[axis];
  const Body body = body_of(options_, feet_);
  dvec3 done = slide(grid, body, motion);
  if (on_ground_ && done != motion) {
    // Try up, along, and down again onto the step.
    const double up = sweep(grid, body, 1, double{options_.step});
    dvec3 above = slide(grid, body.moved({0, up, 0}), motion);
    above.y = up + sweep(grid, body.moved(above + dvec3(0, up, 0)), 1, -up);
    const bool is_farther = glm::dot(above, motion) > glm::dot(done, motion) + 1e-9;
    if (is_farther && above.y > 0) {
      eye_offset_ -= above.y;
      done = above;
    }
  }
  for (const int axis : {0, 2})
    if (done[axis] != motion[axis]) velocity_[axis] = 0;
  feet_ += done;
}

/// Moves down to ground within a step's height; otherwise the body starts to fall.
void Walker::stay_on_ground(const BitGrid& grid) {
  const double reach = double{options_.step} + 2 * kSkin;
  const double down = sweep(grid, body_of(options_, feet_), 1, -reach);
  on_ground_ = down != -reach;
  if (!on_ground_) return;
  feet_.y += down;
  eye_offset_ -= down;
}

void Walker::stand_free(const BitGrid& grid) {
  const Body body = body_of(options_, feet_);
  if (!is_stuck(grid, body)) return;
  feet_ += offset_to_free_space(grid, body);
  eye_offset_ = 0;
}

void Walker::follow_with_eye(const BitGrid& grid, double seconds) {
  eye_offset_ *= std::exp(-kEyeRate * seconds);
  const double lowest = -std::min(double{options_.step}, 0.8 * double{options_.eye});
  eye_offset_ = std::clamp(eye_offset_, lowest, double{options_.step});
  // An eye above the head must not enter an obstacle that the body has just passed under.
  const double over_head = double{options_.eye} + eye_offset_ - double{options_.height};
  if (over_head > 0)
    eye_offset_ += sweep(grid, body_of(options_, feet_), 1, over_head + kSkin) - over_head - kSkin;
}

}  // namespace brume::scenario
