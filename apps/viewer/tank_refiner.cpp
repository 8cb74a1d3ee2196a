#include "apps/viewer/tank_refiner.hpp"

#include <algorithm>

#include "film/tank_playback.hpp"

namespace brume::viewer {
namespace {

gpu::Image make_shown(gpu::Context& context, const glm::uvec3& size) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.size = size;
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  return gpu::Image(context, info);
}

}  // namespace

planning::TankPlan plan_picture(const TankState& state, const spheres::Tank& tank, glm::uvec2 size_px) {
  return planning::plan_tank(state.scene(), tank, state.seconds(), size_px, state.camera());
}

void TankRefiner::load(const spheres::Tank& tank, glm::uvec2 size_px) {
  restart();
  picture_.reset();  // first: there may be no room for two
  picture_.emplace(screen_.context(), screen_.runner(), tank);
  picture_->reserve(glm::max(size_px, glm::uvec2(1)));
}

void TankRefiner::restart() {
  photons_.restart();
  drawn_.reset();
  if (picture_) picture_->restart();
  schedule_.restart();
}

bool TankRefiner::changes(glm::uvec2 window_px) {
  planning::TankPlan plan = plan_picture(*state_, tank_, window_px);
  const bool changes = !drawn_ || !planning::same_samples(plan, *drawn_);
  drawn_ = std::move(plan);
  return changes;
}

/// The picture in this size goes on, or begins.
void TankRefiner::show(const planning::TankPlan& plan) {
  slice_ = {};
  if (picture_->show(plan, planning::plan_tank_display(state_->scene(), plan.constants.size_px)))
    seconds_ = 0;
}

void TankRefiner::reserve_shown() {
  const glm::uvec3 size(picture_px(), 1);
  if (!shown_ || shown_.info().size != size) shown_ = make_shown(screen_.context(), size);
}

bool TankRefiner::prepare(glm::uvec2 window_px, Stage stage, double /*frame_seconds*/) {
  stage_ = stage;
  show(plan_picture(*state_, tank_, schedule_.picture_px(window_px, is_moving())));
  if (photons_.update(*picture_, tank_, is_moving())) seconds_ = 0;
  if (const std::uint32_t most = photons_.samples_from(samples()); most > 0) {
    slice_ = schedule_.next(picture_px(), samples(), picture_->rows(), state_->scene().samples, is_moving());
    slice_.samples = std::min(slice_.samples, most);
  }
  // A picture of another size replaces the one that shows only when it is complete.
  const bool ends_sample = slice_.rows > 0 && picture_->rows() + slice_.rows == picture_px().y;
  if (slice_.samples > 0 || ends_sample) reserve_shown();
  return true;
}

void TankRefiner::record(gpu::Recorder& recorder) {
  if (picture_->record(recorder, slice_)) recorder.blit(picture_->display(), shown_, VK_FILTER_NEAREST);
}

bool TankRefiner::is_best() const {
  return !is_moving() && photons_.is_complete() && samples() >= state_->scene().samples;
}

void TankRefiner::measure() {
  for (const auto& scope : screen_.timings()) {
    if (scope.name != "tank") continue;
    const double seconds = 1e-3 * scope.milliseconds;
    schedule_.measured(seconds, picture_px(), slice_);
    seconds_ += seconds;
    return;
  }
}

image::Image8 TankRefiner::picture(glm::uvec2 size_px, bool complete, const std::function<void()>& check) {
  const std::uint32_t wanted = complete ? std::max(state_->scene().samples, 1u) : 1;
  drawn_ = plan_picture(*state_, tank_, size_px);
  show(*drawn_);
  const auto stopped = [&] {
    if (check) check();
    return false;
  };
  // Samples by the light of a preview do not count.
  if (!photons_.is_complete()) photons_.complete(*picture_, tank_, stopped);
  film::add_samples(screen_.runner(), *picture_, photons_, tank_, wanted, stopped);
  // The window shows what is saved.
  reserve_shown();
  screen_.runner().run([&](gpu::Recorder& recorder) {
    picture_->record(recorder, {});
    recorder.blit(picture_->display(), shown_, VK_FILTER_NEAREST);
  });
  return screen_.read(shown_);
}

}  // namespace brume::viewer
