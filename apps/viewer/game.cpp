#include "apps/viewer/game.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "apps/viewer/carrier_keys.hpp"
#include "scenario/aim.hpp"

namespace brume::viewer {
namespace {

/// What undo calls an action that changes the timeline.
const char* name_of_event(Action action) {
  const char* const type = event_type(action);
  if (!type) return "all actions removed";
  const char* name = type;
  for_each_weapon([&](const WeaponEvent& weapon, auto) {
    if (std::string_view(weapon.type) == type) name = weapon.name;
  });
  return name;
}

}  // namespace

Game::Game(std::unique_ptr<Session> session, const Choices& choices,
           std::function<void(const std::string&)> notify)
    : session_(std::move(session)),
      notify_(std::move(notify)),
      choices_(choices),
      first_weapons_(choices.weapons) {
  go_to_start();
  if (player_.flying()) notify_("flying, since there is no floor right below; G walks");
  history_.emplace(edits(""));
}

Game::Edits Game::edits(const std::string& what) const {
  return {session_->edits(), choices_.weapons, player_.options(), optics_of(player_.camera()), what};
}

bool Game::report(const Result<void>& done) {
  if (!done) notify_(done.failure().message);
  return bool(done);
}

void Game::go_to_start() {
  const scenario::Scenario& scenario = session_->live().scenario();
  first_camera_ = scene::camera_at(scenario.timeline, scenario.camera, 0);
  player_.start(bodies(), first_camera_);
}

// Actions that change the timeline: each is a step to undo.
void Game::perform(Action action, glm::vec3 aim_world) {
  settle();
  const glm::vec3 eye = player_.camera().position_world;
  bool done = false;
  if (action == kThrowSmoke) {
    done = report(session_->throw_smoke(eye, aim_world));
  } else if (action == kShoot) {
    done = report(session_->shoot(eye, aim_world, choices_.weapons));
  } else if (action == kUseDoor) {
    const auto door = session_->use_door(eye);
    notify_(door ? *door : door.failure().message);
    done = bool(door);
  } else if (const char* const type = event_type(action)) {
    done = report(session_->set_off(type, eye, aim_world, choices_.weapons));
  }
  if (action == Action::empty) {
    done = session_->actions() > 0 && report(session_->empty());
    session_->rewind();
    go_to_start();
    notify_(done ? "all actions removed; Ctrl+Z brings them back" : "no actions to remove");
  }
  if (done) history_->add(edits(name_of_event(action)));
}

void Game::step_history(Action action) {
  settle();
  const bool back = action == Action::undo;
  if (back ? !history_->can_undo() : !history_->can_redo())
    return notify_(back ? "nothing to undo" : "nothing to redo");
  const std::string what = back ? history_->present().what : "";
  const Optics optics_before = history_->present().optics;
  const Edits& edits = back ? history_->undo() : history_->redo();
  if (!report(session_->restore(edits.session))) return;
  const ShotKind kind = choices_.weapons.kind;
  choices_.weapons = edits.weapons;
  choices_.weapons.kind = kind;
  player_.set_options(bodies(), edits.body);
  // A camera path changes it, too, which is no step.
  if (!(edits.optics == optics_before)) player_.set_optics(edits.optics);
  ++changes_;
  notify_(back ? "undone: " + what : "redone: " + edits.what);
}

void Game::settle() {
  if (!changing_) return;
  history_->add(edits(*changing_));
  changing_.reset();
}

void Game::choose_picture(const std::filesystem::path& file) {
  if (!choices_.pictures.matches(file))
    return notify_(file.filename().string() + ": expected a PNG or JPEG to shoot");
  choices_.weapons.picture = file;
  choices_.weapons.kind = ShotKind::picture;
  setting_changed("image to shoot");
  notify_("shoots the shape of " + file.filename().string());
}

void Game::pick_probe(glm::vec3 aim_world) {
  const glm::vec3 eye = player_.camera().position_world;
  const scenario::Aim aimed = scenario::aim(grid(), eye, aim_world);
  // Just in front of the wall, which would block the line of sight.
  const float back = 0.5f * grid().layout().voxel_size;
  choices_.probe.pick(eye + std::max(aimed.meets.value_or(10) - back, 0.0f) * aim_world);
}

// Time stands still while the help covers the image.
void Game::show_help(bool shows) {
  choices_.help = shows;
  if (shows) {
    help_paused_ = !session_->paused();
    session_->set_paused(true);
  } else if (std::exchange(help_paused_, false)) {
    session_->set_paused(false);
  }
}

scene::CarrierKey Game::carrier_pose() const {
  if (flight_ && flight_->carrier() == choices_.carrier) {
    scene::CarrierKey key = flight_->pose();
    key.time = session_->seconds();
    return key;
  }
  const auto& carriers = session_->live().scenario().timeline.carriers;
  return scene::key_at(carriers[choices_.carrier], session_->seconds());
}

std::optional<std::vector<scene::Carrier>> Game::steered_carriers() const {
  if (!flight_) return std::nullopt;
  return flight_->steered(session_->live().scenario().timeline.carriers);
}

void Game::show_decals(bool shows) {
  if (session_->live().scenario().timeline.decals.empty()) return notify_("the timeline has no [[decal]]");
  choices_.decals = shows;
  ++changes_;
}

/// Begins or ends to steer the chosen carrier.
void Game::set_steering(bool steers) {
  const scenario::Scenario& scenario = session_->live().scenario();
  const auto& carriers = scenario.timeline.carriers;
  if (carriers.empty()) return notify_("nothing to steer: the timeline has no [[carrier]]");
  ++changes_;
  if (!steers) {
    notify_(carriers[flight_->carrier()].name + " is on its path again");
    player_.go_to(bodies(), with_optics(flight_->camera_before(), optics_of(player_.camera())));
    flight_.reset();
    return;
  }
  flight_.emplace(scenario, choices_.carrier, session_->seconds(), player_.camera());
  notify_("you steer " + carriers[choices_.carrier].name + "; K adds a key, Esc ends");
}

void Game::change_settings(const std::string& what, scene::Timeline settings) {
  if (!report(session_->set_settings(std::move(settings)))) return;
  setting_changed(what);
  ++changes_;
}

bool Game::set_chosen_carrier(scene::Carrier carrier, const std::string& what) {
  settle();
  scene::Timeline settings = session_->live().scenario().timeline;
  settings.carriers[choices_.carrier] = std::move(carrier);
  if (!report(session_->set_settings(std::move(settings)))) return false;
  ++changes_;
  history_->add(edits(what));
  return true;
}

void Game::add_carrier_key() {
  const auto& carriers = session_->live().scenario().timeline.carriers;
  if (carriers.empty()) return notify_("no key added: the timeline has no [[carrier]]");
  scene::Carrier carrier = carriers[choices_.carrier];
  const bool moves = key_of_time(carrier, session_->seconds()).has_value();
  set_key(carrier, carrier_pose());
  const std::string name = carrier.name;
  if (set_chosen_carrier(std::move(carrier), "key of " + name))
    notify_((moves ? "the key of this time moved: " : "key added: ") + name);
}

void Game::remove_carrier_key() {
  scene::Carrier carrier = session_->live().scenario().timeline.carriers[choices_.carrier];
  const std::string name = carrier.name;
  if (!remove_key(carrier, session_->seconds()))
    return notify_(carrier.keys.size() == 1 ? "the only key of " + name + " cannot be removed"
                                            : name + " has no key at this time");
  if (set_chosen_carrier(std::move(carrier), "key of " + name + " removed")) notify_("key removed: " + name);
}

scene::Timeline Game::snapshot() const {
  scene::Timeline timeline = session_->snapshot(player_.camera());
  if (auto steered = steered_carriers()) timeline.carriers = std::move(*steered);
  if (!choices_.decals) timeline.decals.clear();
  return timeline;
}

// Actions that change settings of the weapons or the view.
void Game::choose(Action action) {
  if (action == Action::shape_bullet) choices_.weapons.kind = ShotKind::bullet;
  if (action == Action::shape_glyph) choices_.weapons.kind = ShotKind::glyph;
  if (action == Action::shape_word) choices_.weapons.kind = ShotKind::word;
  if (action == Action::shape_picture) choices_.weapons.kind = ShotKind::picture;
  if (action == Action::fly && !player_.set_flying(bodies(), !player_.flying()))
    notify_("still flying: there is no floor below");
  if (action == Action::steer_carrier) set_steering(!flight_);
  if (action == Action::decals) show_decals(!choices_.decals);
  choices_.act(action);
  if (action == Action::help) show_help(!choices_.help);
  if (action == Action::toggle_cursor && flight_) return set_steering(false);
  if (action == Action::toggle_cursor) choices_.free_cursor = !choices_.free_cursor;
  if (action == Action::next_view) {
    const auto next = (static_cast<std::size_t>(choices_.view) + 1) % passes::kDebugViewNames.size();
    choices_.view = static_cast<passes::DebugView>(next);
    ++changes_;
  }
}

void Game::act(Action action, glm::vec3 aim_world) {
  if (event_type(action) || action == Action::empty) return perform(action, aim_world);
  choose(action);
  if (action == Action::add_key) add_carrier_key();
  if (action == Action::undo || action == Action::redo) step_history(action);
  if (action == Action::probe) pick_probe(aim_world);
  if (action == Action::rewind) {
    session_->rewind();
    go_to_start();
  }
  if (action == Action::pause) {
    session_->set_paused(!session_->paused());
    help_paused_ = false;
  }
  if (action == Action::step_back) session_->step(-1);
  if (action == Action::step_on) session_->step(1);
}

void Game::move(const Input& input, double passed) {
  if (flight_) {
    if (input.wheel != 0) player_.change_fly_speed(bodies(), input.wheel);
    const double seconds = std::min(passed, Session::kLongestFrame);
    if (flight_->steer(input, player_.options().fly_speed, seconds)) ++changes_;
    return player_.follow(with_optics(flight_->camera(grid()), optics_of(player_.camera())));
  }
  const bool turned = input.look_px != glm::dvec2(0);
  if (session_->follows_path()) {
    constexpr std::array kMoves{Action::forward, Action::back, Action::left,
                                Action::right,   Action::up,   Action::down};
    const bool moved = std::any_of(kMoves.begin(), kMoves.end(), [&](Action a) { return input.is_held(a); });
    if (!turned && !moved) return player_.follow(session_->path_camera(session_->seconds()));
    session_->leave_path();
  }
  player_.turn(input.look_px);
  if (input.wheel != 0) player_.change_fly_speed(bodies(), input.wheel);
  if (!player_.move(input, bodies(), std::min(passed, Session::kLongestFrame)))
    notify_("you fell off the level, and are back where you stood");
  if (!session_->paused()) session_->record_camera(player_.camera());
}

}  // namespace brume::viewer
