// How much of a tank's picture a frame of its window draws, so that the window answers soon on any device.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "render/tank_picture.hpp"

namespace brume::viewer {

class TankSchedule {
 public:
  /// What a frame may take while something moves, and at rest [s].
  static constexpr double kMoving = 0.05, kResting = 0.1;
  /// Most samples in a submission: drivers take a device that works for longer to be hung.
  static constexpr std::uint32_t kMostSamples = 64;

  /// The size of the picture for a window of this size: at most the window's, in whole fractions of it while
  /// something moves.
  glm::uvec2 picture_px(glm::uvec2 window_px, bool is_moving) const;
  /// The next part of a picture of this size that has `samples`, and `rows` of one more. Nothing (0, 0) when
  /// it has `limit` samples.
  render::TankSlice next(glm::uvec2 size_px, std::uint32_t samples, std::uint32_t rows, std::uint32_t limit,
                         bool is_moving) const;

  /// The time that a slice took on the device [s].
  void measured(double seconds, glm::uvec2 size_px, const render::TankSlice& slice);
  /// What was measured no longer holds: what is drawn has changed.
  void restart() { seconds_per_sample_ = kFirstGuess; }

 private:
  /// The figure of a slow device [s]: the first frame of a fast one is merely smaller than it could be.
  static constexpr double kFirstGuess = 1e-6;
  double seconds_per_sample_ = kFirstGuess;  ///< Time of one sample of one pixel.
};

}  // namespace brume::viewer
