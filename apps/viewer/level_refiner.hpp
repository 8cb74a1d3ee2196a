// Draws the picture of a level: frames of the film, or a paused image, refined until it is the best one.
#pragma once

#include <cstdint>
#include <optional>

#include "apps/viewer/game_frame.hpp"
#include "apps/viewer/quality.hpp"
#include "apps/viewer/refiner.hpp"
#include "apps/viewer/screen.hpp"
#include "render/renderer.hpp"

namespace brume::viewer {

/// A paused image is repeated until it becomes the best one, the image of `brume render`: first the light in
/// the smoke is brought up to date in slices and volumes are loaded and uploaded, then the image is rendered
/// in parts, and of a camera with a lens or a shutter one sample after the other. An input ends all that
/// soon.
class LevelRefiner final : public Refiner {
 public:
  /// Reduces the volumes of a scenario to what the device has room for: at most `volume_bytes` (0: no such
  /// limit). `game`: of that scenario, there from the first frame on. All must outlive it. May run in another
  /// thread while nobody uses the device. Throws what Renderer throws.
  LevelRefiner(Screen& screen, Window& window, const scenario::Scenario& scenario, std::uint64_t volume_bytes,
               const std::optional<Game>& game, const QualityControl& quality);

  /// The exposure factor that fits `input` (film::measure_exposure).
  float measure_exposure(const render::FrameInput& input);
  void set_masks(const smoke::MaskAtlas& masks) { renderer_.set_masks(masks); }
  glm::uvec2 picture_px() const { return renderer_.targets().size_px; }
  /// CPU time to prepare and record the last frame [s].
  double record_seconds() const { return plan_seconds_ + screen_.record_seconds(); }

  bool changes(glm::uvec2 window_px) override;
  bool prepare(glm::uvec2 window_px, Stage stage, double frame_seconds) override;
  void record(gpu::Recorder& recorder) override;
  const gpu::Image* shown() const override { return &renderer_.targets().display; }
  bool is_best() const override { return is_best_; }
  /// The next frame is not the film's next one.
  void hide() override { continues_ = false; }
  /// Always complete: what `brume render` renders now.
  image::Image8 picture(glm::uvec2 size_px, bool complete, const std::function<void()>& check) override;

 private:
  /// Everything that a paused image depends on: it is rendered again only if the key changes.
  struct Key {
    double seconds = -1;
    glm::vec3 eye{0}, target{0};
    Optics optics;
    glm::uvec2 size_px{0};
    std::uint64_t changes = 0;
    bool operator==(const Key&) const = default;
  };
  void restart_still();
  void prepare_film(glm::uvec2 window_px, float light_update_fraction);
  bool draw_sample(render::FrameInput input, glm::uvec2 size_px);
  void set_resolution(glm::uvec2 picture_px, std::uint32_t march_scale);
  void begin_still(render::FrameInput& input, glm::uvec2 size_px);

  Screen& screen_;
  Window& window_;
  const std::optional<Game>& game_;
  const QualityControl& quality_;
  render::Renderer renderer_;
  std::uint32_t march_scale_ = 1;  ///< Current one of the renderer.
  bool history_lost_ = false;      ///< The renderer has no previous frame to accumulate with.

  // A frame of the film, until it is recorded.
  std::vector<shared::Hole> holes_;
  render::FrameInput input_;
  std::optional<render::FramePlan> plan_;
  double plan_seconds_ = 0;
  std::uint32_t frame_index_ = 0;
  bool continues_ = false;  ///< The next frame may accumulate with the previous one.

  // The paused image.
  Key rendered_;
  int slices_ = 0;             ///< Slices of the light in the smoke.
  std::uint32_t samples_ = 0;  ///< Samples at full quality.
  bool is_best_ = false;
};

}  // namespace brume::viewer
