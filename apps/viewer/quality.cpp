#include "apps/viewer/quality.hpp"

#include <algorithm>
#include <array>

namespace brume::viewer {
namespace {

constexpr std::array kLevels{
    Quality{"full", 1, 1, 1, 1, 1, 1.0f / 8, true, true},
    Quality{"half", 1, 2, 1, 1, 1, 1.0f / 8, true, true},
    Quality{"quarter", 1, 4, 1, 1, 1.0f / 2, 1.0f / 8, false, true},
    Quality{"coarse", 1, 4, 1.5f, 4, 1.0f / 8, 1.0f / 16},
    Quality{"small", 0.5f, 2, 1.5f, 4, 1.0f / 16, 1.0f / 32},
    Quality{"smallest", 0.5f, 4, 2, 4, 1.0f / 16, 1.0f / 64},
};

// The first frames at a level include the cost of the change; it is judged after a few more.
constexpr int kFramesOfChange = 2, kFramesToJudge = 4;
constexpr double kSmoothing = 0.25;  // weight of the newest frame
// Each level costs about twice as much as the next one, so a better one is tried below half the frame budget.
constexpr double kUpgradeBelow = 0.5;

}  // namespace

std::span<const Quality> quality_levels() {
  return kLevels;
}

float light_update_fraction(float level_fraction, double frame_seconds) {
  constexpr double kUsualRate = 20, kMost = 0.25;  // [1/s]; up to kMost shadows and noise are spread, too
  const double due = double{level_fraction} * std::min(frame_seconds * kUsualRate, 100.0);
  return std::max(level_fraction, static_cast<float>(std::min(due, kMost)));
}

void QualityControl::change_level(std::size_t level) {
  level_ = level;
  frames_ = 0;
  mean_seconds_ = 0;
  since_change_ = 0;
}

void QualityControl::fix(std::size_t level) {
  automatic_ = false;
  change_level(std::min(level, kLevels.size() - 1));
}

void QualityControl::add_frame(double work_seconds, double frame_seconds) {
  since_change_ += frame_seconds;
  ++frames_;
  if (frames_ <= kFramesOfChange) return;
  mean_seconds_ = frames_ == kFramesOfChange + 1
                      ? work_seconds
                      : mean_seconds_ + kSmoothing * (work_seconds - mean_seconds_);
  if (!automatic_ || frames_ < kFramesToJudge) return;
  if (mean_seconds_ > target_seconds_ && level_ + 1 < kLevels.size()) {
    // Too slow soon after the upgrade: wait longer before the next one.
    const bool too_early = tried_better_ && since_change_ < kMinCooldown;
    cooldown_ = too_early ? std::min(2 * cooldown_, kMaxCooldown) : kMinCooldown;
    tried_better_ = false;
    // Far too slow: skip levels, since each step takes several slow frames.
    const double excess = mean_seconds_ / target_seconds_;
    const std::size_t steps = excess > 6 ? 3 : excess > 3 ? 2 : 1;
    change_level(std::min(level_ + steps, kLevels.size() - 1));
  } else if (level_ > 0 && mean_seconds_ < kUpgradeBelow * target_seconds_ && since_change_ > cooldown_) {
    tried_better_ = true;
    change_level(level_ - 1);
  }
}

}  // namespace brume::viewer
