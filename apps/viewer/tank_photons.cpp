#include "apps/viewer/tank_photons.hpp"

#include <algorithm>
#include <chrono>

namespace brume::viewer {

void TankPhotons::stop() {
  if (!all_.valid()) return;
  stops_ = true;
  all_.wait();
  all_ = {};
  stops_ = false;
}

void TankPhotons::restart() {
  stop();
  bricks_.reset();
  wanted_ = count_ = 0;
}

spheres::LightPaths TankPhotons::trace(const spheres::Tank& tank, std::uint32_t count) {
  spheres::LightPathOptions options;
  options.count = count;
  return spheres::trace_light_paths(tank, *bricks_, scene_, options, [this] { return stops_.load(); });
}

std::optional<spheres::LightPaths> TankPhotons::update(const spheres::Tank& tank,
                                                       const spheres::LightPathScene& scene,
                                                       std::uint32_t count, bool moves) {
  if (!(scene.glass.index > 0) || scene.lights.empty()) count = 0;
  if (count != wanted_ || (count > 0 && !same_light(scene, scene_))) {
    stop();
    if (!bricks_ && count > 0) bricks_ = spheres::list_bricks(tank);
    scene_ = scene;
    wanted_ = count;
    count_ = std::min(count, kPreview);
    return count > 0 ? trace(tank, count_) : spheres::LightPaths();
  }
  if (is_complete()) return std::nullopt;
  if (!all_.valid()) {
    if (!moves) all_ = std::async(std::launch::async, [this, &tank] { return trace(tank, wanted_); });
    return std::nullopt;
  }
  if (all_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  count_ = wanted_;
  return all_.get();
}

std::optional<spheres::LightPaths> TankPhotons::complete(const spheres::Tank& tank,
                                                         const spheres::LightPathScene& scene,
                                                         std::uint32_t count) {
  std::optional<spheres::LightPaths> newest;
  while (true) {
    std::optional<spheres::LightPaths> next = update(tank, scene, count, false);
    if (next) newest = std::move(next);
    if (is_complete()) return newest;
    if (all_.valid()) all_.wait();
  }
}

}  // namespace brume::viewer
