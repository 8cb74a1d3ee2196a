// A player's body in the voxel world: it walks, falls, climbs stairs and slides along walls, or flies freely.
#pragma once

#include <glm/glm.hpp>

#include "scene/options.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::scenario {

/// Units, ranges and meanings: visit_walker_options.
struct WalkerOptions {
  float half_width = 0.2f;
  float height = 1.75f;
  float eye = 1.62f;  ///< At most `height`.
  float step = 0.55f;
  float walk_speed = 3.5f;
  float fly_speed = 7.0f;
  float run = 2.0f;
  float jump = 0.6f;
  float gravity = 9.81f;
};

/// As the functions of scene/options.hpp.
template <typename Options, typename Visitor>
void visit_walker_options(Options& o, Visitor&& visit) {
  using scene::OptionInfo;
  visit(OptionInfo{"half_width", "m", "from the body's middle to its side", 0.05, 1, "half its width"},
        o.half_width);
  visit(OptionInfo{"height", "m", "of the body", 0.2, 3}, o.height);
  visit(OptionInfo{"eye", "m", "of the eye over the feet", 0.1, 3, "height of the eye"}, o.eye);
  visit(OptionInfo{"step", "m", "highest step climbed without a jump", 0, 2, "highest step"}, o.step);
  visit(OptionInfo{"walk_speed", "m/s", "on foot", 0.1, 100, "walking speed"}, o.walk_speed);
  visit(OptionInfo{"fly_speed", "m/s", "in flight", 0.1, 1000, "flying speed"}, o.fly_speed);
  visit(OptionInfo{"run", "", "speed factor when running", 1, 10, "running is faster by"}, o.run);
  visit(OptionInfo{"jump", "m", "height of a jump", 0, 10, "height of a jump"}, o.jump);
  visit(OptionInfo{"gravity", "m/s2", "acceleration of a fall", 0.1, 100}, o.gravity);
}

struct WalkerInput {
  glm::vec3 direction_world{
      0};  ///< Direction and fraction of the speed, length <= 1; on foot only x and z count.
  bool run = false, jump = false;
};

/// The body is an upright, axis-aligned box. On foot it is never inside a solid voxel, whatever the speed and
/// the frame time: its motion is swept. Below the grid's bottom, also beside the grid, everything is solid;
/// elsewhere outside of the grid everything is free. Equal inputs on equal grids give equal motion.
class Walker {
 public:
  explicit Walker(const WalkerOptions& options = {}) : options_(options) {}

  /// Places the eye, with zero velocity. On foot, a body that would overlap a solid voxel moves to the
  /// nearest free position.
  void put(const voxel::BitGrid& grid, glm::vec3 eye_world);
  /// Starts or stops flying in place, or on foot at the nearest free position.
  void set_flying(const voxel::BitGrid& grid, bool flying);
  void set_options(const voxel::BitGrid& grid, const WalkerOptions& options);

  /// Moves for some seconds, at most 1; NaN and infinity count as 0. A body that overlaps a voxel that became
  /// solid first moves to the nearest free position.
  void move(const voxel::BitGrid& grid, const WalkerInput& input, double seconds);

  /// Follows the body, smoothed on stairs; on foot never in a solid voxel.
  glm::vec3 eye_world() const;
  glm::vec3 feet_world() const { return glm::vec3(feet_); }
  glm::vec3 velocity() const { return glm::vec3(velocity_); }  ///< [m/s]
  bool flying() const { return flying_; }
  bool on_ground() const { return on_ground_; }
  const WalkerOptions& options() const { return options_; }

 private:
  void fly(const WalkerInput& input, double seconds);
  void walk(const voxel::BitGrid& grid, const WalkerInput& input, double seconds);
  void fall(const voxel::BitGrid& grid, double seconds);
  void stride(const voxel::BitGrid& grid, double seconds);
  void stay_on_ground(const voxel::BitGrid& grid);
  void stand_free(const voxel::BitGrid& grid);
  void follow_with_eye(const voxel::BitGrid& grid, double seconds);

  WalkerOptions options_;
  glm::dvec3 feet_{0};      // middle of the body's lower side [m]
  glm::dvec3 velocity_{0};  // [m/s]
  double eye_offset_ = 0;   // height of the eye above its target [m]
  bool flying_ = false, on_ground_ = false;
};

}  // namespace brume::scenario
