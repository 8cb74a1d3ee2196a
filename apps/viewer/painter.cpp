#include "apps/viewer/painter.hpp"

#include <algorithm>

#include "apps/viewer/screenshot.hpp"
#include "image/png.hpp"

namespace brume::viewer {

Stage Painter::prepare(Refiner& refiner, glm::uvec2 window_px, double frame_seconds) {
  const bool changes = refiner.changes(window_px);
  still_frames_ = changes ? 0 : std::min(still_frames_ + 1, kFramesUntilRefined);
  const Stage stage = changes                               ? Stage::changed
                      : still_frames_ < kFramesUntilRefined ? Stage::waiting
                                                            : Stage::refining;
  if (!refiner.prepare(window_px, stage, frame_seconds)) still_frames_ = 0;
  return stage;
}

bool Painter::draw(Document& document, double frame_seconds, const ImDrawData& ui) {
  Refiner& refiner = document.refiner();
  const auto window_px = screen_.begin();
  if (!window_px) {
    refiner.hide();
    return false;
  }
  Stage stage{};
  try {
    stage = prepare(refiner, *window_px, frame_seconds);
  } catch (const gpu::DeviceLost&) {
    throw;
  } catch (const Error& error) {
    // What was acquired must be presented.
    screen_.show([](gpu::Recorder&) {}, refiner.shown(), ui);
    if (document.fall_back(error)) return false;
    throw;
  }
  screen_.show([&](gpu::Recorder& recorder) { refiner.record(recorder); }, refiner.shown(), ui);
  kind_ = refiner.is_best()         ? PictureKind::best
          : stage == Stage::changed ? PictureKind::film
                                    : PictureKind::still;
  return true;
}

Result<void> Painter::save(Document& document, const std::filesystem::path& path, glm::uvec2 size_px,
                           bool complete, const std::function<void()>& check) {
  const image::Image8 picture = document.refiner().picture(size_px, complete, check);
  if (auto saved = document.save_snapshot(snapshot_timeline(path)); !saved) return saved;
  return image::save_png(path, picture);
}

}  // namespace brume::viewer
