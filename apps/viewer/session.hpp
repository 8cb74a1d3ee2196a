// An interactive session: a scenario, its clock and the actions of the player. Every action becomes a
// timeline event at the next tick, so that the saved timeline reproduces the session bit for bit.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "scenario/editable_scenario.hpp"

namespace brume::viewer {

enum class ShotKind { bullet, glyph, word, picture };
const char* name_of(ShotKind kind);

/// Settings of what is shot and blown up next.
struct Weapons {
  ShotKind kind = ShotKind::bullet;
  scene::ShotEvent shot;  ///< For bullets and pictures; time, origin and direction are ignored.
  scene::TextEvent text;  ///< For letters and words; `text` is the word.
  scene::BlastEvent blast;
  std::filesystem::path picture;  ///< PNG or JPEG; empty: none.
};
/// The event of a weapon: its type in timelines, what undo calls it, and what the panel calls its settings.
struct WeaponEvent {
  const char *type, *name, *settings;
  const char* key = nullptr;   ///< The letter that sets it off; null: keys.cpp has its bindings.
  const char* does = nullptr;  ///< Description of the key in the help.
};
/// Calls visit(event, member) for each weapon; the pointer to its settings is the second. A weapon with
/// `at_world` goes off where the player looks (Session::set_off), by its key.
template <typename Visitor>
void for_each_weapon(Visitor&& visit) {
  visit(WeaponEvent{"shot", "shot", "bullets and images"}, &Weapons::shot);
  visit(WeaponEvent{"text", "text", "letters and words"}, &Weapons::text);
  visit(WeaponEvent{"blast", "explosion", "explosions", "E", "explosion where you look"}, &Weapons::blast);
}

class Session {
 public:
  static constexpr double kTick = 1.0 / 64;         // [s], of the default sim::WorldSettings
  static constexpr double kFirstTime = 1.0 / 64;    // [s], since a timeline must not be empty
  static constexpr double kCameraKeyEvery = 0.125;  // [s]
  static constexpr double kLongestFrame = 0.25;     // [s]; slower frames slow the clock down

  /// A session at the start of the scenario. With `play` the events of its timeline take place and the camera
  /// follows its path; otherwise the timeline only sets the initial camera.
  static Result<std::unique_ptr<Session>> create(scenario::Scenario scenario, bool play);

  const scenario::EditableScenario& live() const { return *live_; }
  scenario::EditableScenario& live() { return *live_; }
  const scenario::Simulation& simulation() const { return live_->simulation(); }
  double seconds() const { return seconds_; }
  /// End of the time slider [s]: the latest event or time reached so far, and at least the recorded duration,
  /// or the last key of carriers and masks.
  double end_seconds() const { return end_seconds_; }
  bool paused() const { return paused_; }
  void set_paused(bool paused) { paused_ = paused; }

  /// Session time that passes during a frame of this duration [s].
  double passing(double frame_seconds) const { return paused_ ? 0 : std::min(frame_seconds, kLongestFrame); }
  /// Moves the clock to any time, forwards or backwards [s].
  void seek(double seconds);
  /// Seeks for the time slider: pauses and follows the recorded camera path, so that it is not overwritten.
  void scrub(double seconds);
  /// Pauses and seeks by a number of ticks, backwards if negative.
  void step(int ticks);
  /// The exposure that the level begins with, in place of the file's [EV].
  Result<void> set_first_exposure(float exposure);
  /// Back to the start: all actions happen again at their times.
  void rewind();
  /// Back to the start, without the actions of this session; its settings remain.
  Result<void> empty();
  /// Replays all actions from the start along the recorded camera path.
  void play();

  /// Takes over all of a timeline but its events (EditableScenario::set_settings), at the present time, too.
  Result<void> set_settings(scene::Timeline settings);

  // The recorded camera path.
  bool follows_path() const { return follows_path_; }
  void leave_path() { follows_path_ = false; }
  /// The camera of the path at a time [s].
  scene::Camera path_camera(double seconds) const;
  /// Adds the player's camera to the path, at most every kCameraKeyEvery; discards later keys.
  void record_camera(const scene::Camera& camera);

  // Actions take place at the next tick. They fail with a one-line message.
  Result<void> throw_smoke(glm::vec3 from_world, glm::vec3 direction_world);
  Result<void> shoot(glm::vec3 from_world, glm::vec3 direction_world, const Weapons& weapons);
  /// Sets off the weapon of this type of events where the player looks.
  Result<void> set_off(std::string_view type, glm::vec3 from_world, glm::vec3 direction_world,
                       const Weapons& weapons);
  /// Opens or closes the door nearest to a point. Returns a message with its name.
  Result<std::string> use_door(glm::vec3 at_world);

  /// Number of actions since the start or the last empty().
  std::size_t actions() const { return actions_; }
  /// Number of changes of the carriers' keys since the start.
  std::size_t key_changes() const { return key_changes_; }
  /// The timeline that the session began with: events only if it plays them.
  const scene::Timeline& file() const { return initial_; }

  /// The events and settings at one time of the editing, for undo and redo.
  struct Edits {
    scene::Timeline timeline;
    std::uint64_t events = 0;  ///< Number of the set of events, unique in a session.
    std::size_t actions = 0, next_letter = 0, key_changes = 0;
  };
  Edits edits() const;
  /// Goes back to edits of this session. The time stays; events are replayed if they differ.
  Result<void> restore(const Edits& edits);

  /// The timeline of the session with all actions, at least as long as the current time.
  scene::Timeline recording() const;
  /// A timeline that ends now: its last frame shows what `camera` sees.
  scene::Timeline snapshot(const scene::Camera& camera) const;

 private:
  Session(std::unique_ptr<scenario::EditableScenario> live, scene::Timeline initial, bool play);
  double next_tick_seconds() const;
  Result<void> add(const scene::Timeline& actions);

  std::unique_ptr<scenario::EditableScenario> live_;
  scene::Timeline initial_;
  std::vector<scene::CameraKey> keys_;
  double seconds_ = kFirstTime, end_seconds_ = kFirstTime;
  bool paused_ = false, follows_path_ = false;
  std::size_t actions_ = 0, key_changes_ = 0;
  std::uint64_t events_ = 0, last_events_ = 0;  ///< Number of the present set of events, and the latest one.
  std::size_t next_letter_ = 0;                 ///< Byte offset in the word.
};

}  // namespace brume::viewer
