#include "film/tank_photons.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

namespace brume::film {

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

bool TankPhotons::is_finished(std::chrono::milliseconds wait) const {
  return next_.valid() && next_.wait_for(wait) == std::future_status::ready;
}

spheres::LightPaths TankPhotons::trace(const spheres::Tank& tank, std::uint32_t count, std::uint32_t batch) {
  spheres::LightPathOptions options;
  options.count = count;
  options.seed = batch;
  return spheres::trace_light_paths(tank, *bricks_, scene_, options, [this] { return stops_.load(); });
}

bool TankPhotons::has_paths_for(std::uint32_t samples) const {
  return wanted_ == 0 || (is_complete() && batch_ == batch_of(samples));
}

std::uint32_t TankPhotons::samples_from(std::uint32_t samples) const {
  if (wanted_ == 0) return std::numeric_limits<std::uint32_t>::max();
  if (is_complete() && !has_paths_for(samples)) return 0;
  return kSamplesOfBatch - samples % kSamplesOfBatch;
}

/// Whether the light of the picture is another one than before: then it has none of it so far.
bool TankPhotons::takes_light(const render::TankPicture& picture, const spheres::Tank& tank) {
  const planning::TankPlan& plan = picture.sampler().plan();
  const spheres::LightPathScene scene = planning::light_path_scene(plan);
  const std::uint32_t count = planning::light_path_count(plan);
  if (count == wanted_ && (count == 0 || same_light(scene, scene_))) return false;
  stop();
  if (!bricks_ && count > 0) bricks_ = spheres::list_bricks(tank);
  scene_ = scene;
  wanted_ = count;
  count_ = batch_ = 0;
  return true;
}

bool TankPhotons::update(render::TankPicture& picture, const spheres::Tank& tank, bool moves) {
  if (takes_light(picture, tank)) {
    count_ = std::min(wanted_, kPreview);
    first_ = count_ > 0 ? trace(tank, count_, 0) : spheres::LightPaths();
    picture.set_photons(first_);
    return true;
  }
  if (wanted_ == 0) return false;

  // What it has already, or what the other thread has found.
  const std::uint32_t batch = is_complete() ? batch_of(picture.samples()) : 0;
  if (is_complete() && batch != batch_ && batch == 0) {
    batch_ = 0;
    picture.replace_photons(first_);
    return false;
  }
  const std::uint32_t next = is_complete() && batch == batch_ ? batch + 1 : batch;
  if (next_.valid() && next_batch_ != next) stop();
  if (!next_.valid() && !moves) {
    begin(tank, next);
    return false;
  }
  if (next != batch || !is_finished()) return false;  // traced ahead, or still running
  const bool restarts = !is_complete();
  spheres::LightPaths paths = next_.get();
  restarts ? picture.set_photons(paths) : picture.replace_photons(paths);
  if (batch == 0) first_ = std::move(paths);
  count_ = wanted_;
  batch_ = batch;
  return restarts;
}

void TankPhotons::complete(render::TankPicture& picture, const spheres::Tank& tank,
                           const std::function<bool()>& stopped) {
  if (takes_light(picture, tank)) picture.set_photons({});
  while (!has_paths_for(picture.samples())) {
    update(picture, tank, false);
    while (next_.valid() && !is_finished(std::chrono::milliseconds(20)))
      if (stopped && stopped()) return stop();
  }
}

}  // namespace brume::film
