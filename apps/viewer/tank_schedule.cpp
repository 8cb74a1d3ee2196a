#include "apps/viewer/tank_schedule.hpp"

#include <algorithm>

namespace brume::viewer {
namespace {

constexpr std::uint32_t kSmallest = 8;  // a moving picture has at least 1 / 8 of the window's size
constexpr double kNewest = 0.5;         // weight of a measurement

double pixels(glm::uvec2 size) {
  return double(size.x) * double(size.y);
}

}  // namespace

glm::uvec2 TankSchedule::picture_px(glm::uvec2 window_px, bool is_moving) const {
  if (!is_moving) return window_px;
  std::uint32_t divisor = 1;
  while (divisor < kSmallest && pixels(window_px / divisor) * seconds_per_sample_ > kMoving) ++divisor;
  return glm::max(window_px / divisor, glm::uvec2(1));
}

render::TankSlice TankSchedule::next(glm::uvec2 size_px, std::uint32_t samples, std::uint32_t rows,
                                     std::uint32_t limit, bool is_moving) const {
  if (samples >= limit) return {};
  const double affordable = (is_moving ? kMoving : kResting) / seconds_per_sample_;  // samples of a pixel
  // A picture that moves is small, and never shown in parts.
  if (rows == 0 && (is_moving || affordable >= pixels(size_px))) {
    const double whole = std::clamp(affordable / pixels(size_px), 1.0, double(kMostSamples));
    return {std::min(static_cast<std::uint32_t>(whole), limit - samples), 0};
  }
  constexpr std::uint32_t kStep = render::TankSampler::kRows;
  const double steps = std::clamp(affordable / (double(size_px.x) * kStep), 1.0, 1e6);
  return {0, std::min(kStep * static_cast<std::uint32_t>(steps), size_px.y - rows)};
}

void TankSchedule::measured(double seconds, glm::uvec2 size_px, const render::TankSlice& slice) {
  const double count = slice.samples > 0 ? pixels(size_px) * slice.samples : double(size_px.x) * slice.rows;
  if (count == 0 || seconds <= 0) return;
  const double now = seconds / count;
  seconds_per_sample_ =
      seconds_per_sample_ == kFirstGuess ? now : seconds_per_sample_ + kNewest * (now - seconds_per_sample_);
}

}  // namespace brume::viewer
