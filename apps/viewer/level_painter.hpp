// Chooses what the window of a level shows: a frame of the film, or a paused image, refined until it is the
// best one.
#pragma once

#include <cstdint>

#include "apps/viewer/frame_log.hpp"
#include "apps/viewer/game_frame.hpp"
#include "apps/viewer/quality.hpp"
#include "apps/viewer/screen.hpp"
#include "render/renderer.hpp"

namespace brume::viewer {

class LevelPainter {
 public:
  /// Reduces the volumes of a scenario to what the device has room for: at most `volume_bytes` (0: no such
  /// limit). Screen, window and scenario must outlive it. May run in another thread while nobody uses the
  /// device. Throws what Renderer throws.
  LevelPainter(Screen& screen, Window& window, const scenario::Scenario& scenario,
               std::uint64_t volume_bytes);

  /// Shows a frame with `ui` over it, that many seconds after the last one; false if the window currently
  /// shows nothing. A paused image is repeated until it becomes the best one, the image of `brume render`:
  /// first the light in the smoke is brought up to date in slices and volumes are loaded and uploaded, then
  /// the image is rendered in parts, and of a camera with a lens or a shutter one sample after the other. An
  /// input ends all that soon.
  bool draw(const Game& game, const Quality& quality, double frame_seconds, const ImDrawData& ui);
  /// The exposure factor that fits `input` (render::measure_exposure).
  float measure_exposure(const render::FrameInput& input);
  /// What `brume render` renders of a game now, in this size.
  image::Image8 picture(const Game& game, glm::uvec2 size_px);

  void set_masks(const smoke::MaskAtlas& masks) { renderer_.set_masks(masks); }
  /// The image of the last draw.
  PictureKind kind() const {
    return in_motion_ ? PictureKind::film : is_best_ ? PictureKind::best : PictureKind::still;
  }
  bool in_motion() const { return in_motion_; }
  bool is_best() const { return is_best_; }
  glm::uvec2 picture_px() const { return renderer_.targets().size_px; }
  /// CPU time to prepare and record the last frame [s].
  double record_seconds() const { return plan_seconds_ + screen_.record_seconds(); }

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
  void restart();
  bool is_still(const Game& game);
  bool show(render::FrameInput* input, const Quality& quality, const ImDrawData& ui);
  bool refine(render::FrameInput input);
  bool draw_frame(const Game& game, const Quality& quality, double frame_seconds, const ImDrawData& ui);
  bool draw_film(const Game& game, const Quality& quality, float light_update_fraction, const ImDrawData& ui);
  bool draw_best(const Game& game, const Quality& quality, const ImDrawData& ui);
  void set_resolution(glm::uvec2 picture_px, std::uint32_t march_scale);
  void begin_still(render::FrameInput& input, glm::uvec2 size_px);

  Screen& screen_;
  Window& window_;
  render::Renderer renderer_;
  std::uint32_t march_scale_ = 1;  ///< Current one of the renderer.
  bool history_lost_ = false;      ///< The renderer has no previous frame to accumulate with.
  double plan_seconds_ = 0;

  std::uint32_t frame_index_ = 0;
  bool continues_ = false;  ///< The next frame may accumulate with the previous one.
  Key rendered_;
  int still_frames_ = 0;       ///< Frames since the image changed.
  bool in_motion_ = false;     ///< The last frame was one of the running film.
  std::uint32_t samples_ = 0;  ///< Samples of the paused image at full quality.
  bool is_best_ = false;       ///< The paused image has full quality.
};

}  // namespace brume::viewer
