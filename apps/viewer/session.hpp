// What is played in the window: a scenario, its clock, and what a person does on it. Everything that is done
// becomes part of the scenario's timeline at the tick that comes next, so that the timeline, saved and played,
// makes the same again bit for bit.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "scenario/editable_scenario.hpp"

namespace brume::viewer {

enum class ShotKind { bullet, glyph, word, picture };
const char* name_of(ShotKind kind);

/// What the next shots and blasts are like.
struct Weapons {
  ShotKind kind = ShotKind::bullet;
  scene::ShotEvent shot;  ///< Of bullets and pictures; where from and when do not count.
  scene::TextEvent text;  ///< Of letters and words; text is the word.
  scene::BlastEvent blast;
  std::filesystem::path picture;  ///< PNG or JPEG; empty: none is chosen.
};

class Session {
 public:
  static constexpr double kTick = 1.0 / 64;         // [s], of the default sim::WorldSettings
  static constexpr double kFirstTime = 1.0 / 64;  // [s]: the shortest timeline is longer than nothing
  static constexpr double kCameraKeyEvery = 0.125;  // [s]
  static constexpr double kLongestFrame = 0.25;     // [s]: a slower frame lets the clock go slower

  /// A scenario as it is before anything happens; with `play` what its timeline says happens, and the camera
  /// goes its way.
  static Result<std::unique_ptr<Session>> create(scenario::Scenario scenario, bool play);

  const scenario::EditableScenario& live() const { return *live_; }
  scenario::EditableScenario& live() { return *live_; }
  const scenario::Simulation& simulation() const { return live_->simulation(); }
  double seconds() const { return seconds_; }
  /// Where the last thing happens or ends on the bar of time: at least the duration that was recorded.
  double end_seconds() const { return end_seconds_; }
  bool paused() const { return paused_; }
  void set_paused(bool paused) { paused_ = paused; }

  /// How much time passes during a frame that took so long [s].
  double passing(double frame_seconds) const { return paused_ ? 0 : std::min(frame_seconds, kLongestFrame); }
  /// To any time, forwards or backwards [s].
  void seek(double seconds);
  /// The same as the bar of time does it: paused, and on the camera's way, which is so not overwritten.
  void scrub(double seconds);
  void step(int ticks);
  /// Back to the beginning, without what was done.
  Result<void> reset();
  /// From the beginning, with what was done, on the camera's way.
  void play();

  // The camera's way.
  bool follows_path() const { return follows_path_; }
  void leave_path() { follows_path_ = false; }
  /// The camera at the present time on its way.
  scene::Camera path_camera() const;
  /// Where the camera is now, when it is not on its way: becomes part of the way.
  void record_camera(const scene::Camera& camera);

  // Actions: at the next tick. Fail in one line when they cannot be.
  Result<void> throw_smoke(glm::vec3 from_world, glm::vec3 direction_world);
  Result<void> shoot(glm::vec3 from_world, glm::vec3 direction_world, const Weapons& weapons);
  Result<void> blast(glm::vec3 from_world, glm::vec3 direction_world, const Weapons& weapons);
  /// The door nearest to a point; its name.
  Result<std::string> use_door(glm::vec3 at_world);

  /// The timeline with all that was done, as long as until now at least.
  scene::Timeline recording() const;
  /// The timeline of this moment: the picture of its end is what `camera` sees now.
  scene::Timeline snapshot(const scene::Camera& camera) const;

 private:
  Session(std::unique_ptr<scenario::EditableScenario> live, scene::Timeline initial, bool play);
  double next_tick_seconds() const;
  Result<void> add(const scene::Timeline& actions);

  std::unique_ptr<scenario::EditableScenario> live_;
  scene::Timeline initial_;  ///< What reset goes back to.
  std::vector<scene::CameraKey> keys_;
  double seconds_ = kFirstTime, end_seconds_ = kFirstTime;
  bool paused_ = false, follows_path_ = false;
  std::size_t next_letter_ = 0;  ///< In bytes of the word.
};

}  // namespace brume::viewer
