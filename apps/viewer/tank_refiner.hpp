// Draws a tank frame by frame: samples are added until the picture has all of them, and it begins again when
// something in it changes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "apps/viewer/refiner.hpp"
#include "apps/viewer/screen.hpp"
#include "apps/viewer/tank_schedule.hpp"
#include "apps/viewer/tank_state.hpp"
#include "film/tank_photons.hpp"
#include "planning/tank_plan.hpp"

namespace brume::viewer {

/// What samples of a picture in this size depend on.
planning::TankPlan plan_picture(const TankState& state, const spheres::Tank& tank, glm::uvec2 size_px);

class TankRefiner final : public Refiner {
 public:
  /// The state has a value from the first frame on. All must outlive the refiner.
  TankRefiner(Screen& screen, const std::optional<TankState>& state, const spheres::Tank& tank)
      : screen_(screen), state_(state), tank_(tank) {}

  /// Uploads a tank, the document's in the next frame, in the place of the one before, if any, whose picture
  /// shows until there is another. May run in another thread while nobody uses the device. Throws what
  /// TankPicture throws; then there is none.
  void load(const spheres::Tank& tank, glm::uvec2 size_px);
  /// The next picture begins again: the shaders are others.
  void restart();
  /// To be called when the device has finished the frame.
  void measure();

  bool changes(glm::uvec2 window_px) override;
  bool prepare(glm::uvec2 window_px, Stage stage, double frame_seconds) override;
  void record(gpu::Recorder& recorder) override;
  const gpu::Image* shown() const override { return shown_ ? &shown_ : nullptr; }
  /// All samples, at the window's size.
  bool is_best() const override;
  image::Image8 picture(glm::uvec2 size_px, bool complete, const std::function<void()>& check) override;

  /// The picture is a preview.
  bool is_moving() const { return stage_ != Stage::refining; }
  /// Since the picture began, of it at its size now [s]: for rates.
  double seconds() const { return seconds_; }
  glm::uvec2 picture_px() const { return picture_ ? picture_->size_px() : glm::uvec2(0); }
  /// Samples of each pixel so far.
  std::uint32_t samples() const { return picture_ ? picture_->samples() : 0; }

 private:
  void show(const planning::TankPlan& plan);
  void reserve_shown();

  Screen& screen_;
  const std::optional<TankState>& state_;
  const spheres::Tank& tank_;
  std::optional<render::TankPicture> picture_;
  gpu::Image shown_;  ///< A copy, which remains when the picture's size changes.

  TankSchedule schedule_;
  film::TankPhotons photons_;
  std::optional<planning::TankPlan> drawn_;  ///< At the window's size, whatever the picture's.
  Stage stage_ = Stage::changed;             ///< The last one.
  render::TankSlice slice_;                  ///< The last one.
  double seconds_ = 0;
};

}  // namespace brume::viewer
