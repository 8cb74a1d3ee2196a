// How good the picture of a moving window is: as good as the wanted frame rate leaves time for.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace brume::viewer {

/// What a frame is drawn with.
struct Quality {
  const char* name;               ///< As the overlay says it.
  float picture_scale = 1;        ///< Pixels of the picture for each of the window, along each axis, (0, 1].
  std::uint32_t march_scale = 1;  ///< render::RendererOptions::march_scale.
  float step_scale = 1;           ///< planning::Quality::step_scale.
  float resolve_error_scale = 1;           ///< planning::Quality::resolve_error_scale.
  float light_update_fraction = 1;          ///< planning::Quality::light_update_fraction.
};

/// From the best to the fastest; the first is what `brume render` draws.
std::span<const Quality> quality_levels();

/// Picks a level by how long frames take. It gives way as soon as frames are too long, and tries the better
/// level again only after a while, which doubles (up to kMaxCooldown) each time that level was too slow
/// again.
class QualityControl {
 public:
  static constexpr double kMinCooldown = 2, kMaxCooldown = 32;  // [s]

  explicit QualityControl(double frames_per_second) : wanted_seconds_(1 / frames_per_second) {}

  void set_frame_rate(double frames_per_second) { wanted_seconds_ = 1 / frames_per_second; }
  /// A fixed level instead of one that is picked.
  void fix(std::size_t level);
  void set_automatic() { automatic_ = true; }
  bool automatic() const { return automatic_; }

  /// How long the work of the last frame took [s], and how long ago the one before began [s]: time that was
  /// spent waiting for the screen is no work.
  void add_frame(double work_seconds, double frame_seconds);
  std::size_t level() const { return level_; }
  const Quality& quality() const { return quality_levels()[level_]; }

 private:
  void change_level(std::size_t level);

  double wanted_seconds_;
  bool automatic_ = true;
  std::size_t level_ = 0;
  double mean_seconds_ = 0;  ///< Of work, smoothed, at this level.
  int frames_ = 0;           ///< At this level.
  double since_change_ = 0;  ///< [s]
  double rest_ = kMinCooldown;
  bool tried_better_ = false;  ///< This level is a try that has not failed.
};

}  // namespace brume::viewer
