#include "apps/viewer/tank_painter.hpp"

#include <algorithm>

#include "core/same_bytes.hpp"

namespace brume::viewer {
namespace {

/// Light paths of a picture: voxels show no light through the glass.
std::uint32_t photons_of(const TankPictureKey& key) {
  return key.view == scene::TankView::spheres ? key.photons : 0;
}

}  // namespace

TankPictureKey picture_key(const TankState& state, const spheres::Tank& tank, glm::uvec2 size_px) {
  const scene::TankScene& scene = state.scene();
  return {planning::plan_tank(scene, tank, state.seconds(), size_px, state.camera()), scene.view,
          scene.lighting, scene.photons};
}

bool same_samples(const TankPictureKey& a, const TankPictureKey& b) {
  return a.view == b.view && a.lighting == b.lighting && a.photons == b.photons &&
         same_bytes(a.plan.constants, b.plan.constants) &&
         std::ranges::equal(a.plan.lights, b.plan.lights, same_bytes<shared::TankLight>);
}

void TankPainter::restart() {
  photons_.restart();
  drawn_.reset();
  is_best_ = false;
  schedule_.restart();
}

void TankPainter::set_display(TankScreen& screen, const TankState& state) {
  const scene::TankScene& scene = state.scene();
  if (scene.exposure == exposure_ && scene.tone == tone_ && scene.dither == dither_) return;
  exposure_ = scene.exposure;
  tone_ = scene.tone;
  dither_ = scene.dither;
  screen.set_display(planning::plan_tank_display(scene, screen.picture_px()));
}

void TankPainter::begin_picture(TankScreen& screen, const TankState& state, const spheres::Tank& tank,
                                glm::uvec2 size_px) {
  const TankPictureKey key = picture_key(state, tank, size_px);
  exposure_ = state.scene().exposure;
  tone_ = state.scene().tone;
  dither_ = state.scene().dither;
  screen.set_view(key.plan, planning::plan_tank_display(state.scene(), size_px), key.view, key.lighting);
  seconds_ = 0;
}

void TankPainter::set_photons(TankScreen& screen, const std::optional<TankPhotons::Change>& change) {
  if (!change) return;
  if (!change->restarts) return screen.replace_photons(change->paths);
  screen.set_photons(change->paths);
  seconds_ = 0;
}

TankSlice TankPainter::limited(const TankSlice& slice, std::uint32_t samples) const {
  if (!photons_.is_ready_for(samples)) return {};
  if (photons_of(*drawn_) == 0) return slice;
  constexpr std::uint32_t kBatch = render::TankRenderer::kSamplesOfBatch;
  return {std::min(slice.samples, kBatch - samples % kBatch), slice.rows};
}

bool TankPainter::draw(TankScreen& screen, const TankState& state, const spheres::Tank& tank,
                       const ImDrawData& ui) {
  const auto window_px = screen.begin();
  if (!window_px) return false;
  TankPictureKey key = picture_key(state, tank, *window_px);
  const bool changed = !drawn_ || !same_samples(key, *drawn_);
  schedule_.begin_frame(changed);
  const glm::uvec2 size_px = schedule_.picture_px(*window_px);
  if (changed || size_px != screen.picture_px()) {
    drawn_.reset();
    try {
      begin_picture(screen, state, tank, size_px);
    } catch (const Error&) {
      screen.show({}, ui);  // what was acquired must be presented
      throw;
    }
    drawn_ = std::move(key);
  } else {
    set_display(screen, state);
  }
  set_photons(screen, photons_.update(tank, planning::light_path_scene(drawn_->plan), photons_of(*drawn_),
                                      screen.samples(), schedule_.is_moving()));
  const std::uint32_t limit = state.scene().samples;
  slice_ = limited(schedule_.next(size_px, screen.samples(), screen.rows(), limit), screen.samples());
  screen.show(slice_, ui);
  is_best_ = !schedule_.is_moving() && photons_.is_complete() && screen.samples() >= limit;
  return true;
}

void TankPainter::measure(const TankScreen& screen) {
  const double seconds = screen.slice_seconds();
  schedule_.measured(seconds, screen.picture_px(), slice_);
  seconds_ += seconds;
}

void TankPainter::complete(TankScreen& screen, const TankState& state, const spheres::Tank& tank,
                           glm::uvec2 window_px, std::uint32_t samples,
                           const std::function<bool()>& stopped) {
  TankPictureKey key = picture_key(state, tank, window_px);
  if (!drawn_ || !same_samples(key, *drawn_) || screen.picture_px() != window_px) {
    drawn_.reset();
    begin_picture(screen, state, tank, window_px);
    drawn_ = std::move(key);
  }
  while (screen.samples() == 0 || screen.rows() > 0 || screen.samples() < samples ||
         !photons_.is_complete()) {
    set_photons(screen, photons_.complete(tank, planning::light_path_scene(drawn_->plan), photons_of(*drawn_),
                                          screen.samples()));
    slice_ = limited(schedule_.next(window_px, screen.samples(), screen.rows(), std::max(samples, 1u)),
                     screen.samples());
    // The rest of a sample that began beyond the last.
    if (slice_.samples == 0 && slice_.rows == 0) slice_.rows = window_px.y - screen.rows();
    screen.add(slice_);
    measure(screen);
    if (screen.samples() > 0 && screen.rows() == 0 && stopped && stopped()) return;
  }
}

}  // namespace brume::viewer
