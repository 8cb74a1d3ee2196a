#include "apps/viewer/session.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <string_view>

#include "core/utf8.hpp"
#include "scenario/aim.hpp"
#include "scenario/doors.hpp"
#include "scene/options.hpp"

namespace brume::viewer {
namespace {

constexpr float kReach = 100;           // [m]: range of an action
constexpr float kExplosionBack = 0.3f;  // [m]: an explosion is in front of the surface that it hits

/// The time of the last event or camera key [s].
double last_event(const scene::Timeline& timeline) {
  double last = timeline.camera.empty() ? 0 : timeline.camera.back().time;
  scene::for_each_event_list(timeline, [&](const char*, const auto& events) {
    if (!events.empty()) last = std::max(last, events.back().time);
  });
  return last;
}

/// The time of the last key of what moves or glows [s].
double last_key(const scene::Timeline& timeline) {
  double last = 0;
  for (const scene::Carrier& carrier : timeline.carriers) last = std::max(last, carrier.keys.back().time);
  for (const scene::VolumeOptions& volume : timeline.volumes)
    for (const scene::VolumeMask& mask : volume.masks)
      if (!mask.keys.empty()) last = std::max(last, mask.keys.back().time);
  return last;
}

void clear_events(scene::Timeline& timeline) {
  scene::for_each_event_list(timeline, [](const char*, auto& events) { events.clear(); });
}

Failure no_target(const char* action) {
  return {ErrorCode::bad_input,
          std::string("nothing to ") + action + " in that direction; look at something solid"};
}

}  // namespace

const char* name_of(ShotKind kind) {
  switch (kind) {
    case ShotKind::bullet:
      return "bullet";
    case ShotKind::glyph:
      return "letter";
    case ShotKind::word:
      return "word";
    case ShotKind::picture:
      return "image";
  }
  return "";
}

Result<std::unique_ptr<Session>> Session::create(scenario::Scenario scenario, bool play) {
  if (!play) clear_events(scenario.timeline);
  scene::Timeline initial = scenario.timeline;
  auto live = scenario::EditableScenario::create(std::move(scenario));
  if (!live) return live.failure();
  return std::unique_ptr<Session>(new Session(std::move(*live), std::move(initial), play));
}

Session::Session(std::unique_ptr<scenario::EditableScenario> live, scene::Timeline initial, bool play)
    : live_(std::move(live)), initial_(std::move(initial)), keys_(initial_.camera), follows_path_(play) {
  if (play) end_seconds_ = std::max(double{initial_.duration}, last_event(initial_));
  // Without play only the first camera key matters: the player starts there.
  if (!play) keys_.clear();
  if (!play) end_seconds_ = std::max(end_seconds_, last_key(initial_));
  seek(kFirstTime);
}

void Session::seek(double seconds) {
  // Rounded to float, as is the duration of the timeline that snapshot() returns.
  seconds_ = static_cast<double>(static_cast<float>(std::clamp(seconds, kFirstTime, scene::kLatestTime)));
  end_seconds_ = std::max(end_seconds_, seconds_);
  live_->advance_to(seconds_);
}

void Session::scrub(double seconds) {
  paused_ = true;
  follows_path_ = !keys_.empty();
  seek(seconds);
}

void Session::step(int ticks) {
  paused_ = true;
  seek((std::floor(seconds_ / kTick + 1e-9) + ticks) * kTick);
}

Result<void> Session::set_first_exposure(float exposure) {
  scene::Timeline settings = live_->scenario().timeline;
  settings.exposure = exposure;
  if (auto done = live_->set_settings(std::move(settings)); !done) return done;
  initial_.exposure = exposure;
  return {};
}

void Session::rewind() {
  follows_path_ = false;
  seek(kFirstTime);
}

Result<void> Session::empty() {
  scene::Timeline timeline = live_->scenario().timeline;
  scene::for_each_event_kind([&](const char*, auto list) { timeline.*list = initial_.*list; });
  if (auto done = live_->reset(timeline); !done) return done;
  keys_.clear();
  end_seconds_ = std::max({kFirstTime, last_event(timeline), last_key(timeline)});
  next_letter_ = 0;
  actions_ = 0;
  events_ = ++last_events_;
  rewind();
  return {};
}

Session::Edits Session::edits() const {
  return {live_->scenario().timeline, events_, actions_, next_letter_, key_changes_};
}

Result<void> Session::restore(const Edits& edits) {
  auto done = edits.events != events_ ? live_->reset(edits.timeline) : live_->set_settings(edits.timeline);
  if (!done) return done;
  events_ = edits.events;
  actions_ = edits.actions;
  next_letter_ = edits.next_letter;
  key_changes_ = edits.key_changes;
  end_seconds_ = std::max(end_seconds_, last_event(edits.timeline));
  seek(seconds_);
  return {};
}

Result<void> Session::set_settings(scene::Timeline settings) {
  const bool moves_carriers = settings.carriers != live_->scenario().timeline.carriers;
  auto done = live_->set_settings(std::move(settings));
  if (done && moves_carriers) ++key_changes_;
  seek(seconds_);
  return done;
}

void Session::play() {
  follows_path_ = !keys_.empty();
  paused_ = false;
  seek(kFirstTime);
}

scene::Camera Session::path_camera(double seconds) const {
  scene::Timeline timeline;
  timeline.camera = keys_;
  return scene::camera_at(timeline, live_->scenario().camera, seconds);
}

void Session::record_camera(const scene::Camera& camera) {
  // Later keys belong to a path that this one replaces.
  while (!keys_.empty() && keys_.back().time > seconds_) keys_.pop_back();
  if (!keys_.empty() && seconds_ - keys_.back().time < kCameraKeyEvery) return;
  keys_.push_back({seconds_, camera});
}

double Session::next_tick_seconds() const {
  return (std::floor(seconds_ / kTick + 1e-9) + 1) * kTick;
}

Result<void> Session::add(const scene::Timeline& actions) {
  if (last_event(actions) > scene::kLatestTime)
    return Failure{ErrorCode::resource_limit,
                   "a recording is limited to one hour; press Shift+R to begin again"};
  end_seconds_ = std::max(end_seconds_, last_event(actions));
  auto added = live_->add(actions);
  if (added) {
    ++actions_;
    events_ = ++last_events_;
  }
  return added;
}

Result<void> Session::throw_smoke(glm::vec3 from_world, glm::vec3 direction_world) {
  const scenario::Aim aim =
      scenario::aim(simulation().world().solids().bodies, from_world, direction_world, kReach);
  if (!aim.meets || !aim.landing_world) return no_target("hit");
  scene::Timeline actions;
  actions.smokes.push_back({next_tick_seconds(), from_world, aim.at_world});
  return add(actions);
}

Result<void> Session::shoot(glm::vec3 from_world, glm::vec3 direction_world, const Weapons& weapons) {
  scene::Timeline actions;
  const glm::vec3 toward_world = from_world + kReach * direction_world;
  if (weapons.kind == ShotKind::bullet || weapons.kind == ShotKind::picture) {
    scene::ShotEvent shot = weapons.shot;
    shot.time = next_tick_seconds();
    shot.from_world = from_world;
    shot.toward_world = toward_world;
    if (weapons.kind == ShotKind::picture) {
      if (weapons.picture.empty())
        return Failure{ErrorCode::usage,
                       "no image to shoot; choose one under Shots in the panels, drop a file on the window, "
                       "or start with --shot"};
      shot.shape = scene::ShotShape::mask;
      shot.mask = weapons.picture;
    }
    actions.shots.push_back(std::move(shot));
    return add(actions);
  }
  scene::TextEvent text = weapons.text;
  text.time = next_tick_seconds();
  text.from_world = from_world;
  text.toward_world = toward_world;
  if (weapons.kind == ShotKind::glyph && !text.text.empty()) {
    // Skip blanks.
    const std::string word = text.text;
    for (std::size_t tries = 0; tries < word.size(); ++tries) {
      if (next_letter_ >= word.size()) next_letter_ = 0;
      std::string_view rest = std::string_view(word).substr(next_letter_);
      // The check of the text refuses what is not UTF-8.
      if (!take_character(rest)) rest.remove_prefix(1);
      const std::size_t end = word.size() - rest.size();
      text.text = word.substr(next_letter_, end - next_letter_);
      next_letter_ = end;
      if (text.text != " ") break;
    }
  }
  actions.texts.push_back(std::move(text));
  return add(actions);
}

Result<void> Session::set_off(std::string_view type, glm::vec3 from_world, glm::vec3 direction_world,
                              const Weapons& weapons) {
  const scenario::Aim aim = scenario::aim(simulation().world().grid(), from_world, direction_world, kReach);
  if (!aim.meets) return no_target("blow up");
  scene::Timeline actions;
  bool is_weapon = false;
  for_each_weapon([&]<typename Event>(const WeaponEvent& weapon, Event Weapons::*settings) {
    if constexpr (requires(Event shown) { shown.at_world; }) {
      if (weapon.type != type) return;
      is_weapon = true;
      Event event = weapons.*settings;
      event.time = next_tick_seconds();
      event.at_world = from_world + std::max(*aim.meets - kExplosionBack, 0.0f) * direction_world;
      scene::for_each_event_list(actions, [&]<typename Listed>(const char*, std::vector<Listed>& list) {
        if constexpr (std::same_as<Listed, Event>) list.push_back(event);
      });
    }
  });
  BRUME_ASSERT(is_weapon, std::string(type));
  return add(actions);
}

Result<std::string> Session::use_door(glm::vec3 at_world) {
  const scenario::Scenario& scenario = live_->scenario();
  const std::vector<scenario::Door> doors = scenario::doors_of(scenario.scene);
  if (doors.empty())
    return Failure{ErrorCode::bad_input, "the scene has no door: no object has \"door\" in its name"};
  const auto distance = [&](const scenario::Door& door) {
    return glm::length(at_world - glm::clamp(at_world, door.bounds_world.low, door.bounds_world.high));
  };
  const auto nearest = std::min_element(
      doors.begin(), doors.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  scene::Timeline actions;
  scene::DoorEvent event;
  event.time = next_tick_seconds();
  event.object = nearest->name;
  event.open = !scenario::is_open(scenario.timeline, nearest->name, event.time);
  actions.doors.push_back(event);
  if (auto done = add(actions); !done) return done.failure();
  return (event.open ? "opened: " : "closed: ") + nearest->name;
}

scene::Timeline Session::recording() const {
  scene::Timeline timeline = live_->scenario().timeline;
  timeline.camera = keys_;
  const double length = std::max({seconds_, end_seconds_, last_event(timeline)});
  timeline.duration = static_cast<float>(std::min(length, scene::kLatestTime));
  return timeline;
}

scene::Timeline Session::snapshot(const scene::Camera& camera) const {
  scene::Timeline timeline = recording();
  timeline.camera = {{seconds_, camera}};
  timeline.duration = static_cast<float>(seconds_);
  return timeline;
}

}  // namespace brume::viewer
