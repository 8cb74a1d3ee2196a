// The displacement of the smoke's noise at a time, at points of a brick: at each texel as
// smoke/noise_displacement.hpp has it, or two voxels apart, which is a fifth of the data and smooth enough to
// be interpolated.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/type_precision.hpp>
#include <memory>
#include <span>
#include <vector>

#include "shared/frame.h"
#include "shared/noise_advection.h"
#include "sim/state.hpp"
#include "smoke/cloud_growth.hpp"
#include "smoke/noise_motion.hpp"
#include "smoke/smoke_volume.hpp"
#include "textures/smoky_brick.hpp"

namespace brume::textures {

/// What of it does not change from one time to the next is kept: growth, and the rolls at each point.
class NoisePoints {
 public:
  /// `spacing`: of the points, 1 or 2 [voxels].
  explicit NoisePoints(int spacing)
      : spacing_(spacing), per_axis_(spacing == 1 ? shared::kBrickTexels : shared::kDisplacementPoints) {}

  /// Points per axis of a brick. The first is its texel (0, 0, 0).
  int per_axis() const { return per_axis_; }
  std::size_t per_brick() const { return static_cast<std::size_t>(per_axis_ * per_axis_ * per_axis_); }

  /// Follows a state and the smoke of it at `seconds` after tick 0.
  void update(const smoke::SmokeVolume& volume, const sim::State& state, const shared::SmokeLook& look,
              double swirl_period, double seconds);
  /// Writes the displacement of a brick's points [m] as half floats, per_brick() of them; w is 0. With a
  /// spacing of 1, points farther than a texel from smoke get 0. After `update`, for different bricks from
  /// any number of threads.
  void write(const SmokyBrick& smoky, std::span<glm::u16vec4> out);

 private:
  /// What does not change at the points of a brick: the two fields of rolls, and the growth of each cloud, in
  /// w its weight. Found where it is first read.
  struct Points {
    glm::ivec3 brick{0};
    std::uint64_t parts = 0;                // value of parts_ that `growth` is from
    smoke::TexelSet has_rolls, has_growth;  // by point
    std::vector<glm::vec3> first, second;
    std::vector<glm::vec4> growth;
  };

  smoke::TexelSet points_read(const SmokyBrick& smoky) const;
  const Points& points_of(std::uint32_t slot, const smoke::TexelSet& read, std::span<const glm::uvec2> parts);
  glm::ivec3 place_of(std::size_t index) const;
  glm::vec3 position(std::uint32_t slot, std::size_t index) const;
  void add_clouds(std::uint32_t slot, const smoke::TexelSet& read, std::span<glm::vec4> sums);
  void extend(std::span<glm::vec4> points) const;

  int spacing_, per_axis_;
  smoke::CloudGrowth growth_;
  smoke::NoiseMotion motion_;
  const smoke::SmokeVolume* volume_ = nullptr;  // the last update's
  std::uint64_t parts_ = 0;                     // how often the parts of growth_ changed
  float swirl_ = 0, swirl_width_ = 1;
  std::vector<std::unique_ptr<Points>> points_;  // by slot
};

}  // namespace brume::textures
