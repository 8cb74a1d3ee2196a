#include "apps/viewer/tank_photons.hpp"

#include <algorithm>
#include <chrono>

#include "render/tank_picture.hpp"

namespace brume::viewer {

void TankPhotons::stop() {
  if (!next_.valid()) return;
  stops_ = true;
  next_.wait();
  next_ = {};
  stops_ = false;
}

void TankPhotons::restart() {
  stop();
  bricks_.reset();
  first_ = {};
  wanted_ = count_ = 0;
}

void TankPhotons::begin(const spheres::Tank& tank, std::uint32_t batch) {
  next_batch_ = batch;
  next_ = std::async(std::launch::async, [this, &tank, batch] { return trace(tank, wanted_, batch); });
}

bool TankPhotons::is_finished() const {
  return next_.valid() && next_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

spheres::LightPaths TankPhotons::trace(const spheres::Tank& tank, std::uint32_t count, std::uint32_t batch) {
  spheres::LightPathOptions options;
  options.count = count;
  options.seed = batch;
  return spheres::trace_light_paths(tank, *bricks_, scene_, options, [this] { return stops_.load(); });
}

bool TankPhotons::is_ready_for(std::uint32_t samples) const {
  return wanted_ == 0 || !is_complete() || batch_ == render::TankPicture::batch_of(samples);
}

std::optional<TankPhotons::Change> TankPhotons::update(const spheres::Tank& tank,
                                                       const spheres::LightPathScene& scene,
                                                       std::uint32_t count, std::uint32_t samples,
                                                       bool moves) {
  if (count != wanted_ || (count > 0 && !same_light(scene, scene_))) {
    stop();
    if (!bricks_ && count > 0) bricks_ = spheres::list_bricks(tank);
    scene_ = scene;
    wanted_ = count;
    count_ = std::min(count, kPreview);
    batch_ = 0;
    first_ = count > 0 ? trace(tank, count_, 0) : spheres::LightPaths();
    return Change{first_, true};
  }
  if (wanted_ == 0) return std::nullopt;

  const std::uint32_t batch = is_complete() ? render::TankPicture::batch_of(samples) : 0;
  if (is_complete() && batch != batch_ && batch == 0) {
    batch_ = 0;
    return Change{first_, false};
  }
  const std::uint32_t next = is_complete() && batch == batch_ ? batch + 1 : batch;
  if (next_.valid() && next_batch_ != next) stop();
  if (!next_.valid()) {
    if (!moves) begin(tank, next);
    return std::nullopt;
  }
  if (next != batch || !is_finished()) return std::nullopt;  // traced ahead, or still running
  Change change{next_.get(), !is_complete()};
  if (batch == 0) first_ = change.paths;
  count_ = wanted_;
  batch_ = batch;
  return change;
}

std::optional<TankPhotons::Change> TankPhotons::complete(const spheres::Tank& tank,
                                                         const spheres::LightPathScene& scene,
                                                         std::uint32_t count, std::uint32_t samples) {
  std::optional<Change> newest;
  while (true) {
    if (auto change = update(tank, scene, count, samples, false)) {
      change->restarts = change->restarts || (newest && newest->restarts);
      newest = std::move(change);
      if (newest->restarts) samples = 0;
    }
    if (is_complete() && is_ready_for(samples)) return newest;
    if (next_.valid()) next_.wait();
  }
}

}  // namespace brume::viewer
