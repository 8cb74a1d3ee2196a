#include "apps/viewer/painter.hpp"

namespace brume::viewer {
namespace {

// A still waits for further input before it is refined. Then the light of the smoke is updated in as many
// slices, each in a frame that ends soon after an input.
constexpr int kFramesUntilRefined = 3;
constexpr int kLightSlices = 8;
// Of bricks of volumes in a frame: 3 ms of a bus of 6 GB/s.
constexpr std::uint64_t kVolumeUploadBytes = 16u << 20;

/// Whether volumes are shown at another time or resolution than they will be.
bool volumes_arrive(const Screen& screen, const Game& game) {
  const auto& volumes = game.session().live().scenario().volumes;
  return screen.streams_volumes() || (volumes && volumes->is_behind());
}

}  // namespace

void Painter::restart() {
  continues_ = false;
  samples_ = 0;
  is_best_ = false;
  rendered_ = {};
}

/// Whether the paused image is up to date.
bool Painter::is_still(const Screen& screen, const Game& game, const Window& window) {
  const scene::Camera camera = game.player().camera();
  const Key now{game.session().seconds(), camera.position_world, camera.target_world,
                optics_of(camera),        window.size_px(),      game.changes()};
  if (now != rendered_ || volumes_arrive(screen, game)) {
    rendered_ = now;
    still_frames_ = 0;
    samples_ = 0;
    is_best_ = false;
    return false;
  }
  ++still_frames_;
  return game.session().paused();
}

bool Painter::draw_film(Screen& screen, const Game& game, const Quality& quality, float light_update_fraction,
                        const ImDrawData& ui) {
  std::vector<shared::Hole> holes;
  render::FrameInput input = frame_input(game, holes, volumes::VolumeWait::never);
  input.quality.volume_upload_bytes = kVolumeUploadBytes;
  input.view.continues = continues_ && game.choices().temporal;
  input.view.frame_index = ++frame_index_;
  if (input.view.continues) input.view.sample = planning::film_sample(frame_index_);
  input.quality.step_scale = quality.step_scale;
  input.quality.resolve_error_scale = quality.resolve_error_scale;
  input.quality.light_update_fraction = light_update_fraction;
  input.quality.indirect_update_fraction = quality.indirect_update_fraction;
  input.quality.fine_shadows = quality.fine_shadows;
  input.quality.detail = quality.detail;
  continues_ = true;
  return screen.show(&input, quality, ui);
}

bool Painter::draw_best(Screen& screen, const Game& game, Window& window, const Quality& quality,
                        const ImDrawData& ui) {
  const StillFrame still(game);
  const std::uint64_t events = window.events();
  const bool is_refined = screen.refine(still.sample(samples_), [&] {
    window.poll(0);
    return window.events() != events;
  });
  continues_ = false;
  if (is_refined) {
    is_best_ = ++samples_ == still.samples();
    return screen.show(nullptr, quality, ui);
  }
  still_frames_ = 0;
  samples_ = 0;
  return draw_film(screen, game, quality, 1.0f / kLightSlices, ui);
}

bool Painter::draw(Screen& screen, const Game& game, Window& window, const Quality& quality,
                   double frame_seconds, const ImDrawData& ui) {
  in_motion_ = !is_still(screen, game, window);
  if (in_motion_) {
    const float fraction = light_update_fraction(quality.light_update_fraction, frame_seconds);
    return draw_film(screen, game, quality, fraction, ui);
  }
  if (is_best_ || still_frames_ < kFramesUntilRefined) return screen.show(nullptr, quality, ui);
  const int slices = quality.light_update_fraction < 1 ? kLightSlices : 0;
  if (still_frames_ < kFramesUntilRefined + slices)
    return draw_film(screen, game, quality, 1.0f / kLightSlices, ui);
  return draw_best(screen, game, window, quality, ui);
}

}  // namespace brume::viewer
