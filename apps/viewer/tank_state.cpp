#include "apps/viewer/tank_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume::viewer {
namespace {

template <typename Key>
void set_key(std::vector<Key>& keys, Key key) {
  const auto at = std::lower_bound(keys.begin(), keys.end(), key.time,
                                   [](const Key& a, double time) { return a.time < time; });
  if (at != keys.end() && at->time == key.time) {
    *at = std::move(key);
  } else {
    keys.insert(at, std::move(key));
  }
}

}  // namespace

bool same_tank(const scene::TankScene& a, const scene::TankScene& b) {
  if (!a.file.empty() || !b.file.empty()) return a.file == b.file;
  const spheres::PackOptions &x = a.pack, &y = b.pack;
  return x.size == y.size && x.voxel == y.voxel && x.count == y.count && x.radius == y.radius &&
         x.distribution == y.distribution && x.arrangement == y.arrangement && x.noise_size == y.noise_size &&
         x.coloring == y.coloring && x.opacity == y.opacity && x.seed == y.seed && a.palette == b.palette &&
         a.palette_space == b.palette_space;
}

TankState::TankState(scene::TankScene scene, const glm::vec3& size)
    : scene_(scene),
      file_(scene),
      packed_(scene),
      history_(std::move(scene)),
      size_(size),
      free_(scene::camera_at(scene_, size, 0)) {}

scene::TankScene& TankState::edit() {
  is_edited_ = true;
  return scene_;
}

void TankState::settle() {
  if (is_edited_) history_.add(scene_);
  is_edited_ = false;
}

void TankState::undo() {
  settle();
  if (history_.can_undo()) scene_ = history_.undo();
  seek(seconds_);
}

void TankState::redo() {
  settle();
  if (history_.can_redo()) scene_ = history_.redo();
  seek(seconds_);
}

void TankState::set_packed(const scene::TankScene& scene, const glm::vec3& size, bool complete) {
  packed_ = scene;
  size_ = size;
  is_complete_ = complete;
}

bool TankState::differs_from_packed() const {
  return !same_tank(scene_, packed_);
}

void TankState::advance(double seconds) {
  if (!is_playing_) return;
  seconds_ = std::fmod(seconds_ + seconds, double{scene_.duration});
}

void TankState::seek(double seconds) {
  seconds_ = std::clamp(seconds, 0.0, double{scene_.duration});
}

scene::Camera TankState::camera() const {
  return follows_path_ ? scene::camera_at(scene_, size_, seconds_) : free_;
}

void TankState::set_follows_path(bool follows) {
  if (!follows) free_ = camera();
  follows_path_ = follows;
}

void TankState::move_camera(const scene::Camera& camera) {
  follows_path_ = false;
  free_ = camera;
}

void TankState::go_home() {
  follows_path_ = true;
}

void TankState::focus_on_middle(const spheres::Tank& tank) {
  scene::Camera focused = camera();
  focused.lens.focus = distance_ahead(focused, tank);
  move_camera(focused);
}

void TankState::add_camera_key() {
  set_key(edit().camera, scene::CameraKey{seconds_, camera()});
}

void TankState::add_light_key(std::size_t index) {
  scene::TankLight& light = edit().lights[index];
  set_key(light.keys, scene::PlaceKey{seconds_, scene::light_at(light, seconds_).position_world});
}

void TankState::add_glass_key() {
  scene::TankGlass& glass = *edit().glass;
  const scene::TankGlass now = scene::glass_at(glass, seconds_);
  set_key(glass.keys, scene::GlassKey{seconds_, now.position_world, now.radii});
}

scene::TankScene TankState::to_save() const {
  scene::TankScene saved = scene_;
  if (!follows_path_ && !has_path()) saved.camera = {{0, free_}};
  return saved;
}

scene::TankScene TankState::snapshot(std::uint32_t samples) const {
  scene::TankScene shot = scene_;
  shot.file = packed_.file;
  shot.pack = packed_.pack;
  shot.palette = packed_.palette;
  shot.palette_space = packed_.palette_space;
  shot.samples = std::max(samples, 1u);
  shot.camera = {{0, camera()}};
  for (scene::TankLight& light : shot.lights) {
    light = scene::light_at(light, seconds_);
    light.keys.clear();
  }
  if (shot.glass) {
    shot.glass = scene::glass_at(*shot.glass, seconds_);
    shot.glass->keys.clear();
  }
  return shot;
}

}  // namespace brume::viewer
