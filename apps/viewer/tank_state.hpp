// What a window shows of a tank, without window and device: the scene that is edited, its time, and a camera.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "apps/viewer/history.hpp"
#include "apps/viewer/tank_handles.hpp"
#include "scene/tank_scene.hpp"

namespace brume::viewer {

class TankState {
 public:
  /// `size`: of the tank [m]. Paused at 0, along the path of the scene's camera.
  TankState(scene::TankScene scene, const glm::vec3& size);

  const scene::TankScene& scene() const { return scene_; }
  /// As loaded.
  const scene::TankScene& file() const { return file_; }
  /// To change it; ends with settle(), which makes a step of undo() of all changes since the last.
  scene::TankScene& edit();
  void settle();
  void undo();
  void redo();

  /// What the present tank was packed from, or loaded; and its size [m].
  void set_packed(const scene::TankScene& scene, const glm::vec3& size, bool complete);
  const scene::TankScene& packed() const { return packed_; }
  /// Whether packing the scene's tank would give another one.
  bool differs_from_packed() const;
  /// False for a tank whose packing was stopped.
  bool is_complete() const { return is_complete_; }
  const glm::vec3& size() const { return size_; }

  double seconds() const { return seconds_; }
  bool is_playing() const { return is_playing_; }
  void set_playing(bool playing) { is_playing_ = playing; }
  /// Time passes if it plays; after the end it begins again.
  void advance(double seconds);
  /// Another time, in [0, duration].
  void seek(double seconds);

  scene::Camera camera() const;
  /// Whether the camera moves along its keys.
  bool has_path() const { return scene_.camera.size() > 1; }
  bool follows_path() const { return follows_path_; }
  void set_follows_path(bool follows);
  /// A free camera from now on.
  void move_camera(const scene::Camera& camera);
  /// To where the scene's camera is.
  void go_home();
  /// Focuses on what is in the middle of the picture.
  void focus_on_middle(const spheres::Tank& tank);
  /// A key of the camera, of a light or of the glass where it is now; replaces one of the same time.
  void add_camera_key();
  void add_light_key(std::size_t index);
  void add_glass_key();

  /// The scene for a file: a free camera takes the place of one without a path.
  scene::TankScene to_save() const;
  /// A scene whose picture is what the window shows, with that many samples.
  scene::TankScene snapshot(std::uint32_t samples) const;

 private:
  scene::TankScene scene_, file_, packed_;
  History<scene::TankScene> history_;
  bool is_edited_ = false;
  glm::vec3 size_;
  bool is_complete_ = true;
  double seconds_ = 0;
  bool is_playing_ = false;
  bool follows_path_ = true;
  scene::Camera free_;
};

/// Whether two scenes have the same tank: file, options of packing and palette.
bool same_tank(const scene::TankScene& a, const scene::TankScene& b);

}  // namespace brume::viewer
