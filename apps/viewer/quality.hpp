// Adaptive quality: the best image that the target frame rate allows.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace brume::viewer {

/// The settings of a quality level.
struct Quality {
  const char* name;                         ///< Label in the overlay.
  float picture_scale = 1;                  ///< Rendered pixels per window pixel along each axis, (0, 1].
  std::uint32_t march_scale = 1;            ///< render::RendererOptions::march_scale.
  float step_scale = 1;                     ///< planning::Quality::step_scale.
  float resolve_error_scale = 1;            ///< planning::Quality::resolve_error_scale.
  float light_update_fraction = 1;          ///< planning::Quality::light_update_fraction.
  float indirect_update_fraction = 0.125f;  ///< planning::Quality::indirect_update_fraction.
  bool fine_shadows = false;                ///< planning::Quality::fine_shadows.
  bool detail = false;                      ///< planning::Quality::detail.
};

/// From best to fastest; `brume render` has the first.
std::span<const Quality> quality_levels();

/// The light update fraction of a frame this long after the last one [s]: more than the level's where frames
/// are few, up to 1/4, so that the light of growing smoke is seldom older than a second.
float light_update_fraction(float level_fraction, double frame_seconds);

/// Chooses a level from the measured frame times. Lowers the quality as soon as frames are too slow, and
/// tries the better level only after a cooldown, which doubles (up to kMaxCooldown) each time that level is
/// too slow again.
class QualityControl {
 public:
  static constexpr double kMinCooldown = 2, kMaxCooldown = 32;  // [s]

  explicit QualityControl(double frames_per_second) : target_seconds_(1 / frames_per_second) {}

  void set_frame_rate(double frames_per_second) { target_seconds_ = 1 / frames_per_second; }
  /// Fixes the level until set_automatic().
  void fix(std::size_t level);
  void set_automatic() { automatic_ = true; }
  bool automatic() const { return automatic_; }

  /// Adds a frame: CPU and GPU work without waiting for vertical sync [s], and the time since the previous
  /// frame began [s].
  void add_frame(double work_seconds, double frame_seconds);
  std::size_t level() const { return level_; }
  const Quality& quality() const { return quality_levels()[level_]; }

 private:
  void change_level(std::size_t level);

  double target_seconds_;
  bool automatic_ = true;
  std::size_t level_ = 0;
  double mean_seconds_ = 0;  ///< Smoothed work per frame at this level.
  int frames_ = 0;           ///< Frames at this level.
  double since_change_ = 0;  ///< [s]
  double cooldown_ = kMinCooldown;
  bool tried_better_ = false;  ///< This level is an upgrade that has not failed so far.
};

}  // namespace brume::viewer
