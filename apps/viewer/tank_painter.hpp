// Draws a tank frame by frame: samples are added until the picture has all of them, and it begins again when
// something in it changes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "apps/viewer/frame_log.hpp"
#include "apps/viewer/screen.hpp"
#include "apps/viewer/tank_photons.hpp"
#include "apps/viewer/tank_schedule.hpp"
#include "apps/viewer/tank_state.hpp"
#include "planning/tank_plan.hpp"
#include "render/tank_renderer.hpp"

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
  explicit TankPainter(Screen& screen) : screen_(screen) {}

  /// Uploads a tank in the place of the one before, if any, whose picture shows until there is another. May
  /// run in another thread while nobody uses the device. Throws what TankRenderer throws; then there is none.
  void load(const spheres::Tank& tank, glm::uvec2 size_px);
  bool is_loaded() const { return renderer_.has_value(); }

  /// Shows a frame with `ui` over it, and returns true; false if the window currently shows nothing. The
  /// device must have finished the previous frame. `tank` is the same until load(). Throws what
  /// TankRenderer::set_kind throws.
  bool draw(const TankState& state, const spheres::Tank& tank, const ImDrawData& ui);
  /// To be called when the device has finished the frame.
  void measure();
  /// The picture in this size, with at least `samples` of each pixel, unless `check`, which is called after
  /// every few, throws.
  image::Image8 picture(const TankState& state, const spheres::Tank& tank, glm::uvec2 size_px,
                        std::uint32_t samples, const std::function<void()>& check = {});
  /// The next picture begins again: the shaders are others.
  void restart();

  PictureKind kind() const {
    return is_best_ ? PictureKind::best : schedule_.is_moving() ? PictureKind::film : PictureKind::still;
  }
  /// The picture has all of its samples, at the window's size.
  bool is_best() const { return is_best_; }
  bool is_moving() const { return schedule_.is_moving(); }
  /// Since the picture began, of it at its size now [s]: for rates.
  double seconds() const { return seconds_; }
  glm::uvec2 picture_px() const;
  /// Samples of each pixel so far.
  std::uint32_t samples() const { return renderer_ ? renderer_->samples() : 0; }

 private:
  void begin_picture(const TankState& state, const spheres::Tank& tank, glm::uvec2 size_px);
  void set_display(const TankState& state);
  void set_photons(const std::optional<TankPhotons::Change>& change);
  void choose_slice(std::uint32_t limit);
  void record_slice(gpu::Recorder& recorder);
  void record_shown(gpu::Recorder& recorder);
  void show(const ImDrawData& ui);

  Screen& screen_;
  std::optional<render::TankRenderer> renderer_;
  std::optional<scene::TankView> kind_;  ///< The renderer's; none after a failure.
  scene::TankLighting lighting_ = scene::TankLighting::maps;
  gpu::Image shown_;              ///< The newest complete picture; none before the first.
  bool display_changed_ = false;  ///< The picture so far has another exposure than it shall have.

  TankSchedule schedule_;
  TankPhotons photons_;
  std::optional<TankPictureKey> drawn_;  ///< At the window's size, whatever the picture's.
  planning::TankDisplay display_;
  TankSlice slice_;  ///< The last one.
  bool is_best_ = false;
  double seconds_ = 0;
};

}  // namespace brume::viewer
