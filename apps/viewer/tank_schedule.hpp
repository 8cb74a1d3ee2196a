// How much of a tank's picture a frame of its window draws, so that the window answers soon on any device.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace brume::viewer {

/// What the next frame adds.
struct TankSlice {
  std::uint32_t samples = 0;  ///< Of each pixel; 0: a part of one.
  std::uint32_t rows = 0;     ///< Of the picture, where samples is 0.
};

class TankSchedule {
 public:
  /// What a frame may take while something moves, and at rest [s].
  static constexpr double kMoving = 0.05, kResting = 0.1;
  /// Frames without a change until the picture has the window's size again.
  static constexpr int kFramesUntilRest = 3;
  /// Of a submission: some devices think of longer ones that they hang.
  static constexpr std::uint32_t kMostSamples = 64;

  /// To be called once a frame: whether the picture is another one than before.
  void begin_frame(bool changed);
  bool is_moving() const { return still_frames_ < kFramesUntilRest; }

  /// The size of the picture for a window of this size: at most the window's, in whole fractions of it while
  /// something moves.
  glm::uvec2 picture_px(glm::uvec2 window_px) const;
  /// The next part of a picture of this size that has so many samples, and rows of one more, at most `limit`
  /// samples. Nothing (0, 0) when it has all.
  TankSlice next(glm::uvec2 size_px, std::uint32_t samples, std::uint32_t rows, std::uint32_t limit) const;

  /// The time that a slice took on the device [s].
  void measured(double seconds, glm::uvec2 size_px, const TankSlice& slice);
  /// What was measured no longer holds: what is drawn has changed.
  void restart() { seconds_per_sample_ = kFirstGuess; }

 private:
  /// Of a slow device: the first frame of a fast one is merely smaller than it could be.
  static constexpr double kFirstGuess = 1e-6;
  double seconds_per_sample_ = kFirstGuess;  ///< Time of a pixel's sample.
  int still_frames_ = 0;
};

}  // namespace brume::viewer
