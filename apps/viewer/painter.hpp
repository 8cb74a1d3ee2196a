// Chooses what a window shows: a frame of the film, or a paused image, refined until it is the best one.
#pragma once

#include <cstdint>

#include "apps/viewer/frame_log.hpp"
#include "apps/viewer/game_frame.hpp"
#include "apps/viewer/quality.hpp"
#include "apps/viewer/screen.hpp"
#include "apps/viewer/window.hpp"

namespace brume::viewer {

class Painter {
 public:
  /// Shows a frame with `ui` over it, that many seconds after the last one; false if the window currently
  /// shows nothing. A paused image is repeated until it becomes the best one, the image of `brume render`:
  /// first the light in the smoke is brought up to date in slices and volumes are loaded and uploaded, then
  /// the image is rendered in parts, and of a camera with a lens or a shutter one sample after the other. An
  /// input ends all that soon.
  bool draw(Screen& screen, const Game& game, Window& window, const Quality& quality, double frame_seconds,
            const ImDrawData& ui);

  /// The image of the last draw.
  PictureKind kind() const {
    return in_motion_ ? PictureKind::film : is_best_ ? PictureKind::best : PictureKind::still;
  }
  bool in_motion() const { return in_motion_; }
  bool is_best() const { return is_best_; }
  /// The next frame is rendered, whatever the last one was: the screen shows something else or nothing.
  void restart();

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
  bool is_still(const Screen& screen, const Game& game, const Window& window);
  bool draw_film(Screen& screen, const Game& game, const Quality& quality, float light_update_fraction,
                 const ImDrawData& ui);
  bool draw_best(Screen& screen, const Game& game, Window& window, const Quality& quality,
                 const ImDrawData& ui);

  std::uint32_t frame_index_ = 0;
  bool continues_ = false;  ///< The next frame may accumulate with the previous one.
  Key rendered_;
  int still_frames_ = 0;       ///< Frames since the image changed.
  bool in_motion_ = false;     ///< The last frame was one of the running film.
  std::uint32_t samples_ = 0;  ///< That the paused image has at full quality.
  bool is_best_ = false;       ///< The paused image has full quality.
};

}  // namespace brume::viewer
