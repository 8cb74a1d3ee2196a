// What a player does and chooses in a level, without a window: actions, settings, undo and redo.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "apps/viewer/carrier_flight.hpp"
#include "apps/viewer/file_list.hpp"
#include "apps/viewer/history.hpp"
#include "apps/viewer/player.hpp"
#include "apps/viewer/probe.hpp"
#include "apps/viewer/session.hpp"
#include "apps/viewer/window_choices.hpp"
#include "passes/debug_view.hpp"

namespace brume::viewer {

/// Settings that the player chooses by keys and panels.
struct Choices : WindowChoices {
  bool free_cursor = false;  ///< The mouse moves the cursor instead of turning the view.
  passes::DebugView view = passes::DebugView::none;
  std::optional<passes::ViewSlice> slice;  ///< Empty: through the middle of the smoke.
  Weapons weapons;
  FileList pictures{".", {".png", ".jpg", ".jpeg"}};  ///< To choose Weapons::picture from.
  Probe probe;
  std::optional<std::size_t> level;  ///< Index into quality_levels(); empty: adaptive.
  double frames_per_second = 60;
  bool temporal = true;     ///< Smooths smoke and edges over frames.
  bool decals = true;       ///< Decals are shown.
  std::size_t carrier = 0;  ///< The one to steer and to edit; of Timeline::carriers, unless there is none.
};

class Game {
 public:
  /// `notify` shows a line to the player.
  Game(std::unique_ptr<Session> session, const Choices& choices,
       std::function<void(const std::string&)> notify);

  Session& session() { return *session_; }
  const Session& session() const { return *session_; }
  Player& player() { return player_; }
  const Player& player() const { return player_; }
  Choices& choices() { return choices_; }
  const Choices& choices() const { return choices_; }
  /// The weapons at the start.
  const Weapons& first_weapons() const { return first_weapons_; }
  /// The camera at the start.
  const scene::Camera& first_camera() const { return first_camera_; }
  void notify(const std::string& line) const { notify_(line); }
  /// What stops shots, and what stops bodies.
  const voxel::BitGrid& grid() const { return session_->simulation().world().grid(); }
  const voxel::BitGrid& bodies() const { return session_->simulation().world().solids().bodies; }
  /// A number that grows whenever a paused image must be rendered again, beyond time and camera.
  std::uint64_t changes() const { return changes_; }
  void change_picture() { ++changes_; }

  /// Takes an action along a direction; actions of the window and of files are not its own.
  void act(Action action, glm::vec3 aim_world);
  /// Handles input that moves the player, and `passed` seconds of real time.
  void move(const Input& input, double passed);
  /// Shoots the shape of an image from now on.
  void choose_picture(const std::filesystem::path& file);

  /// The carrier that the player steers at present; null: none.
  const CarrierFlight* flight() const { return flight_ ? &*flight_ : nullptr; }
  /// The carriers of the timeline, that one where it is steered to; empty: it is none.
  std::optional<std::vector<scene::Carrier>> steered_carriers() const;
  /// Where the chosen carrier is now: on its path, or steered. Only if the timeline has carriers.
  scene::CarrierKey carrier_pose() const;
  /// Removes the key of the chosen carrier at the current time.
  void remove_carrier_key();
  /// A timeline that ends now, whose last frame is what the window shows, without debug view.
  scene::Timeline snapshot() const;

  /// Takes over the settings of a timeline (Session::set_settings) that a widget changed.
  void change_settings(const std::string& what, scene::Timeline settings);
  /// A setting changed, by a widget that may still be dragged: one step to undo once settle() says it is not.
  void setting_changed(const std::string& what) { changing_ = what; }
  void settle();

 private:
  struct Edits {
    Session::Edits session;
    Weapons weapons;
    scenario::WalkerOptions body;
    Optics optics;
    std::string what;  ///< The edit that led to it.
  };
  Edits edits(const std::string& what) const;
  void go_to_start();
  void perform(Action action, glm::vec3 aim_world);
  void choose(Action action);
  void pick_probe(glm::vec3 aim_world);
  void show_help(bool shows);
  void set_steering(bool steers);
  void show_decals(bool shows);
  void add_carrier_key();
  bool set_chosen_carrier(scene::Carrier carrier, const std::string& what);
  void step_history(Action action);
  bool report(const Result<void>& done);

  std::unique_ptr<Session> session_;
  std::function<void(const std::string&)> notify_;
  Choices choices_;
  Weapons first_weapons_;
  scene::Camera first_camera_;
  Player player_;
  std::uint64_t changes_ = 0;
  bool help_paused_ = false;  ///< The help paused the session, and its end resumes it.
  std::optional<CarrierFlight> flight_;
  std::optional<std::string> changing_;
  std::optional<History<Edits>> history_;
};

}  // namespace brume::viewer
