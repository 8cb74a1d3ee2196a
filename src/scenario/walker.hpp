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
  visit(OptionInfo{"half_width", "m", "from the body's middle to its side", 0.05, 1}, o.half_width);
  visit(OptionInfo{"height", "m", "of the body", 0.2, 3}, o.height);
  visit(OptionInfo{"eye", "m", "of the eye over the feet", 0.1, 3}, o.eye);
  visit(OptionInfo{"step", "m", "highest step that is climbed without a jump", 0, 2}, o.step);
  visit(OptionInfo{"walk_speed", "m/s", "on foot", 0.1, 100}, o.walk_speed);
  visit(OptionInfo{"fly_speed", "m/s", "in flight", 0.1, 1000}, o.fly_speed);
  visit(OptionInfo{"run", "", "how many times as fast when running", 1, 10}, o.run);
  visit(OptionInfo{"jump", "m", "how high a jump goes", 0, 10}, o.jump);
  visit(OptionInfo{"gravity", "m/s2", "how fast a fall grows faster", 0.1, 100}, o.gravity);
}

struct WalkerInput {
  glm::vec3 direction_world{0};  ///< Where to, at most 1 long; on foot its x and z count.
  bool run = false, jump = false;
};

/// The body is a box, upright and along the axes. On foot it is never inside a solid voxel, whatever the
/// speed and the length of a layout: its ways are swept. Below the grid's bottom, also beside the grid, all is
/// solid; else what is outside is free. The same inputs on the same grids give the same ways.
class Walker {
 public:
  explicit Walker(const WalkerOptions& options = {}) : options_(options) {}

  /// Puts the eye at a place, at rest. On foot, a body that would be in something solid stands at the nearest
  /// place that is free.
  void put(const voxel::BitGrid& grid, glm::vec3 eye_world);
  /// Takes off, or comes down on foot where it is (or at the nearest place that is free).
  void set_flying(const voxel::BitGrid& grid, bool flying);
  void set_options(const voxel::BitGrid& grid, const WalkerOptions& options);

  /// Moves on by some seconds; more than 1 are taken for 1, and what is no number for none. A body in which a
  /// voxel became solid stands at the nearest free place first.
  void move(const voxel::BitGrid& grid, const WalkerInput& input, double seconds);

  /// Follows the body, gently where it climbs or goes down stairs, and is never in a solid voxel on foot.
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
  double eye_behind_ = 0;   // how far the eye is over where it belongs [m]
  bool flying_ = false, on_ground_ = false;
};

}  // namespace brume::scenario
