// Draws a tank frame by frame: samples are added until the picture has all of them, and it begins again when
// something in it changes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "apps/viewer/frame_log.hpp"
#include "apps/viewer/tank_photons.hpp"
#include "apps/viewer/tank_schedule.hpp"
#include "apps/viewer/tank_screen.hpp"
#include "apps/viewer/tank_state.hpp"
#include "planning/tank_plan.hpp"
#include "spheres/tank.hpp"

namespace brume::viewer {

/// Everything that samples depend on.
struct TankPictureKey {
  planning::TankPlan plan;
  scene::TankView view = scene::TankView::spheres;
  scene::TankLighting lighting = scene::TankLighting::maps;
  std::uint32_t photons = 0;
};
TankPictureKey picture_key(const TankState& state, const spheres::Tank& tank, glm::uvec2 size_px);
/// Whether samples of the two may be added up.
bool same_samples(const TankPictureKey& a, const TankPictureKey& b);

class TankPainter {
 public:
  /// Shows a frame with `ui` over it, and returns true; false if the window currently shows nothing. The
  /// device must have finished the previous frame. Throws what TankScreen::set_view throws.
  bool draw(TankScreen& screen, const TankState& state, const spheres::Tank& tank, const ImDrawData& ui);
  /// To be called when the device has finished the frame.
  void measure(const TankScreen& screen);
  /// Adds samples until the picture has the window's size and `samples` of each pixel, or `stopped` returns
  /// true; at least one. Without showing them.
  void complete(TankScreen& screen, const TankState& state, const spheres::Tank& tank, glm::uvec2 window_px,
                std::uint32_t samples, const std::function<bool()>& stopped = {});
  /// The next picture begins again: tank, device or shaders are others.
  void restart();

  PictureKind kind() const {
    return is_best_ ? PictureKind::best : schedule_.is_moving() ? PictureKind::film : PictureKind::still;
  }
  /// The picture has all of its samples, at the window's size.
  bool is_best() const { return is_best_; }
  bool is_moving() const { return schedule_.is_moving(); }
  /// Since the picture began, of it at its size now [s]: for rates.
  double seconds() const { return seconds_; }

 private:
  void begin_picture(TankScreen& screen, const TankState& state, const spheres::Tank& tank,
                     glm::uvec2 size_px);
  void set_display(TankScreen& screen, const TankState& state);
  void set_photons(TankScreen& screen, const std::optional<TankPhotons::Change>& change);
  /// Of `slice`, what may be drawn with the light paths that the screen has.
  TankSlice limited(const TankSlice& slice, std::uint32_t samples) const;

  TankSchedule schedule_;
  TankPhotons photons_;
  std::optional<TankPictureKey> drawn_;  ///< At the window's size, whatever that of the picture.
  float exposure_ = 0, dither_ = 1;
  scene::ToneCurve tone_ = scene::ToneCurve::neutral;
  TankSlice slice_;  ///< The last one.
  bool is_best_ = false;
  double seconds_ = 0;
};

}  // namespace brume::viewer
