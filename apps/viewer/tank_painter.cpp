#include "apps/viewer/tank_painter.hpp"

#include <algorithm>

#include "core/same_bytes.hpp"

namespace brume::viewer {
namespace {

/// Light paths of a picture: voxels show no light through the glass.
std::uint32_t photons_of(const TankPictureKey& key) {
  return key.view == scene::TankView::spheres ? key.photons : 0;
}

bool same_display(const planning::TankDisplay& a, const planning::TankDisplay& b) {
  return a.frame.exposure == b.frame.exposure && a.frame.tone == b.frame.tone && a.dither == b.dither;
}

gpu::Image make_shown(gpu::Context& context, const glm::uvec3& size) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.size = size;
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  return gpu::Image(context, info);
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

void TankPainter::load(const spheres::Tank& tank, glm::uvec2 size_px) {
  restart();
  renderer_.reset();  // first: there may be no room for two
  renderer_.emplace(screen_.context(), screen_.runner(), tank, glm::max(size_px, glm::uvec2(1)));
  kind_ = scene::TankView::spheres;
  lighting_ = scene::TankLighting::maps;
}

glm::uvec2 TankPainter::picture_px() const {
  return renderer_ ? glm::uvec2(renderer_->display().info().size) : glm::uvec2(0);
}

void TankPainter::restart() {
  photons_.restart();
  drawn_.reset();
  is_best_ = false;
  schedule_.restart();
}

void TankPainter::begin_picture(const TankState& state, const spheres::Tank& tank, glm::uvec2 size_px) {
  const TankPictureKey key = picture_key(state, tank, size_px);
  if (key.lighting != lighting_) renderer_->set_lighting(key.lighting);
  lighting_ = key.lighting;
  if (key.view != kind_) {
    kind_.reset();  // if it throws
    renderer_->set_kind(key.view);
    kind_ = key.view;
  }
  if (size_px != picture_px()) renderer_->resize(size_px);
  display_ = planning::plan_tank_display(state.scene(), size_px);
  renderer_->set_view(key.plan, display_);
  display_changed_ = false;
  seconds_ = 0;
}

/// Exposure, tone curve and dither alone.
void TankPainter::set_display(const TankState& state) {
  const planning::TankDisplay display = planning::plan_tank_display(state.scene(), picture_px());
  if (same_display(display, display_)) return;
  display_ = display;
  renderer_->set_display(display);
  display_changed_ = true;
}

void TankPainter::set_photons(const std::optional<TankPhotons::Change>& change) {
  if (!change) return;
  if (!change->restarts) return renderer_->replace_photons(change->paths);
  renderer_->set_photons(change->paths);
  seconds_ = 0;
}

/// What is drawn next with the light paths that the renderer has.
void TankPainter::choose_slice(std::uint32_t limit) {
  slice_ = {};
  if (!photons_.is_ready_for(samples())) return;
  slice_ = schedule_.next(picture_px(), samples(), renderer_->rows(), limit);
  constexpr std::uint32_t kBatch = render::TankRenderer::kSamplesOfBatch;
  if (photons_of(*drawn_) > 0) slice_.samples = std::min(slice_.samples, kBatch - samples() % kBatch);
}

void TankPainter::record_slice(gpu::Recorder& recorder) {
  if (slice_.samples > 0) renderer_->record_samples(recorder, slice_.samples);
  if (slice_.rows > 0) renderer_->record_rows(recorder, slice_.rows);
}

/// The slice, and the picture if it is another one then.
void TankPainter::record_shown(gpu::Recorder& recorder) {
  const std::uint32_t before = samples();
  record_slice(recorder);
  if (samples() == 0 || (samples() == before && !display_changed_)) return;
  if (samples() == before) renderer_->record_display(recorder);
  display_changed_ = false;
  recorder.blit(renderer_->display(), shown_, VK_FILTER_NEAREST);
}

void TankPainter::show(const ImDrawData& ui) {
  // A picture of another size replaces the one that shows only when it is complete.
  const glm::uvec3 size(picture_px(), 1);
  const bool completes = slice_.samples > 0 || (slice_.rows > 0 && renderer_->rows() + slice_.rows == size.y);
  if (completes && (!shown_ || shown_.info().size != size)) shown_ = make_shown(screen_.context(), size);
  screen_.show([&](gpu::Recorder& recorder) { record_shown(recorder); }, shown_ ? &shown_ : nullptr, ui);
}

bool TankPainter::draw(const TankState& state, const spheres::Tank& tank, const ImDrawData& ui) {
  const auto window_px = screen_.begin();
  if (!window_px) return false;
  TankPictureKey key = picture_key(state, tank, *window_px);
  const bool changed = !drawn_ || !same_samples(key, *drawn_);
  schedule_.begin_frame(changed);
  const glm::uvec2 size_px = schedule_.picture_px(*window_px);
  if (changed || size_px != picture_px()) {
    drawn_.reset();
    try {
      begin_picture(state, tank, size_px);
    } catch (const Error&) {
      slice_ = {};
      show(ui);  // what was acquired must be presented
      throw;
    }
    drawn_ = std::move(key);
  } else {
    set_display(state);
  }
  set_photons(photons_.update(tank, planning::light_path_scene(drawn_->plan), photons_of(*drawn_), samples(),
                              schedule_.is_moving()));
  const std::uint32_t limit = state.scene().samples;
  choose_slice(limit);
  show(ui);
  is_best_ = !schedule_.is_moving() && photons_.is_complete() && samples() >= limit;
  return true;
}

void TankPainter::measure() {
  for (const auto& scope : screen_.timings()) {
    if (scope.name != "tank") continue;
    const double seconds = 1e-3 * scope.milliseconds;
    schedule_.measured(seconds, picture_px(), slice_);
    seconds_ += seconds;
    return;
  }
}

image::Image8 TankPainter::picture(const TankState& state, const spheres::Tank& tank, glm::uvec2 size_px,
                                   std::uint32_t samples, const std::function<void()>& check) {
  TankPictureKey key = picture_key(state, tank, size_px);
  if (!drawn_ || !same_samples(key, *drawn_) || picture_px() != size_px) {
    drawn_.reset();
    begin_picture(state, tank, size_px);
    drawn_ = std::move(key);
  }
  while (renderer_->samples() < std::max(samples, 1u) || renderer_->rows() > 0 || !photons_.is_complete()) {
    set_photons(photons_.complete(tank, planning::light_path_scene(drawn_->plan), photons_of(*drawn_),
                                  renderer_->samples()));
    choose_slice(std::max(samples, 1u));
    // The rest of a sample that began beyond the last.
    if (slice_.samples == 0 && slice_.rows == 0) slice_.rows = size_px.y - renderer_->rows();
    screen_.runner().run([&](gpu::Recorder& recorder) { record_slice(recorder); });
    measure();
    if (check) check();
  }
  screen_.runner().run([&](gpu::Recorder& recorder) { renderer_->record_display(recorder); });
  return screen_.read(renderer_->display());
}

}  // namespace brume::viewer
