// The picture of a document in a window: frames while something changes, then the best picture, step by step.
#pragma once

#include <filesystem>

#include "apps/viewer/document.hpp"
#include "apps/viewer/frame_log.hpp"
#include "apps/viewer/screen.hpp"

namespace brume::viewer {

class Painter {
 public:
  /// Frames without a change until the picture is refined.
  static constexpr int kFramesUntilRefined = 3;

  /// As Screen.
  Painter(const Window& window, const ScreenOptions& options) : screen_(window, options) {}
  Screen& screen() { return screen_; }

  /// Shows a frame with `ui` over it, that many seconds after the last one; false if there is nothing to wait
  /// for: the window shows nothing, or the document falls back to another picture. The device must have
  /// finished the frame before. Throws what Refiner::prepare throws.
  bool draw(Document& document, double frame_seconds, const ImDrawData& ui);
  /// The picture of the last frame.
  PictureKind kind() const { return kind_; }

  /// Saves the picture in this size, and next to it what reproduces it (snapshot_timeline). As
  /// Refiner::picture.
  Result<void> save(Document& document, const std::filesystem::path& path, glm::uvec2 size_px, bool complete,
                    const std::function<void()>& check);

 private:
  Stage prepare(Refiner& refiner, glm::uvec2 window_px, double frame_seconds);

  Screen screen_;
  int still_frames_ = 0;  ///< Frames since the picture changed.
  PictureKind kind_ = PictureKind::film;
};

}  // namespace brume::viewer
