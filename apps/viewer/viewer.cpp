#include "apps/viewer/viewer.hpp"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>

#include "apps/viewer/autosave.hpp"
#include "apps/viewer/frame_log.hpp"
#include "apps/viewer/notice_list.hpp"
#include "apps/viewer/painter.hpp"
#include "apps/viewer/screen.hpp"
#include "apps/viewer/screenshot.hpp"
#include "apps/viewer/shader_reload.hpp"
#include "apps/viewer/ui.hpp"
#include "apps/viewer/widgets.hpp"
#include "core/log.hpp"
#include "render/playback.hpp"
#include "scene/timeline_writer.hpp"

namespace brume::viewer {
namespace {

using Clock = std::chrono::steady_clock;

// A device that keeps getting lost is broken.
constexpr std::size_t kMostLostDevices = 5;
// A paused window sleeps between events.
constexpr double kIdleSeconds = 0.05;
// Of the newest frame, in the pace of the time.
constexpr double kPaceWeight = 0.3;

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

Choices first_choices(const ViewerOptions& options) {
  Choices choices;
  choices.weapons = options.weapons;
  choices.pictures.open(options.weapons.picture.empty() ? "." : options.weapons.picture.parent_path());
  choices.view = options.view;
  choices.panels = options.panels;
  choices.overlay = options.overlay;
  choices.level = options.level;
  choices.frames_per_second = options.frames_per_second;
  choices.vertical_sync = options.vertical_sync;
  return choices;
}

class Viewer {
 public:
  Viewer(const ScenarioLoader& load, bool play, const ViewerOptions& options)
      : options_(options),
        autosave_(options.folder),
        window_(options.size_px, "Brume - " + options.level_name),
        ui_(window_),
        quality_(options.frames_per_second),
        shaders_(options.shaders) {
    make_screen();
    begin(load, play);
    log_ = FrameLog(options.frame_log);  // An earlier file remains until there is something to write.
  }

  ViewerReport run() {
    announce_recovered_sessions();
    try {
      run_frames();
      ViewerReport result = report();
      autosave_.discard();
      return result;
    } catch (...) {
      const auto saved = autosave_.finish(session());
      if (!saved) log_warning("the session is lost: " + saved.failure().message);
      if (saved && *saved)
        log_warning("the session is saved in " + autosave_.file().string() + "; brume view recovers it");
      throw;
    }
  }

 private:
  void run_frames() {
    while (!window_.should_close() && !done_) {
      if (options_.check_signals) options_.check_signals();
      try {
        frame();
      } catch (const gpu::DeviceLost&) {
        recover();
      }
    }
  }

  void announce_recovered_sessions() {
    for (const std::filesystem::path& file : recover_sessions(options_.folder)) {
      const std::string line = "a session that ended early is recovered: brume view --play " + file.string();
      log_warning(line);
      notify(line);
    }
  }

  Session& session() { return game_->session(); }
  const Session& session() const { return game_->session(); }

  void make_screen() {
    screen_ = std::make_unique<Screen>(
        window_, ScreenOptions{options_.device, options_.validation, options_.vertical_sync});
    painter_.restart();
  }
  void load_screen(const scenario::Scenario& scenario) {
    screen_->load(scenario, window_.size_px(), options_.volume_bytes);
    masks_ = scenario.masks.key();
  }

  // Recreates all GPU state after a device loss; the session is unaffected.
  void recover() {
    take_messages();
    if (++devices_lost_ > kMostLostDevices)
      throw gpu::DeviceLost(ErrorCode::no_device, "the device is lost repeatedly");
    ImGui::EndFrame();  // the loss may have interrupted a frame
    screen_.reset();
    make_screen();
    load_screen(session().live().scenario());
    notify("the device was lost and has been recreated");
  }

  void notify(const std::string& line) { notices_.add(line); }
  void notify_failure(const Result<void>& done) {
    if (!done) notify(done.failure().message);
  }

  // Failures also go to the terminal, which outlives the window.
  void update_autosave() {
    const auto saved = autosave_.update(session());
    notify_failure(saved);
    if (!saved) log_warning("the session cannot be saved: " + saved.failure().message);
  }

  void begin(const ScenarioLoader& load, bool play);
  void during(const std::string& work, bool draws, const std::function<void()>& task);
  void show_loading(const std::string& work, double seconds);
  void frame();
  void play_frame(const Input& input, double frame_seconds);
  void advance_time(double frame_seconds);
  void act(Action action);
  void update_mouse_capture(const Input& input);
  void apply(const UiRequests& requests);
  void update_quality();
  void lose_for_tests();
  void finish_frame(Clock::time_point begin, double frame_seconds, double tick_seconds);
  void save_screenshot(const std::filesystem::path& picture);
  void save_recording(const std::filesystem::path& path);
  glm::vec3 aim() const;
  void take_messages();
  Notices notices();
  ViewerReport report();

  ViewerOptions options_;
  std::optional<Game> game_;  ///< Empty while the level loads.
  Autosave autosave_;
  Window window_;
  Ui ui_;
  QualityControl quality_;
  Painter painter_;
  FrameLog log_;
  ShaderReload shaders_;
  Figures figures_;
  std::unique_ptr<Screen> screen_;
  sim::MaskKey masks_{};  ///< Key of the masks that the screen has.

  std::optional<Clock::time_point> last_frame_;
  double pace_ = 1;  ///< Session time per real time, smoothed.
  bool done_ = false;
  NoticeList notices_;
  std::vector<std::string> messages_;  ///< From the validation layers.
  std::size_t devices_lost_ = 0;
};

void Viewer::take_messages() {
  for (std::string& message : screen_->context().take_validation_messages())
    messages_.push_back(std::move(message));
}

// One frame while the level loads.
void Viewer::show_loading(const std::string& work, double seconds) {
  if (!options_.overlay) return;
  screen_->wait();
  ui_.begin_frame();
  ui_.lay_out_loading(options_.level_name, work, seconds);
  screen_->show(nullptr, quality_.quality(), *ImGui::GetDrawData());
  screen_->wait();
}

// Runs a task in another thread; the window says so, and stays alive. A task that uses the device does not
// share it: then the window draws only once.
void Viewer::during(const std::string& work, bool draws, const std::function<void()>& task) {
  const Clock::time_point begin = Clock::now();
  show_loading(work, 0);
  auto done = std::async(std::launch::async, task);
  double shown = 0;
  while (done.wait_for(std::chrono::milliseconds(10)) != std::future_status::ready) {
    window_.poll(0);
    const double seconds = seconds_between(begin, Clock::now());
    if (!draws || std::floor(seconds) == shown) continue;
    shown = std::floor(seconds);
    show_loading(work, seconds);
  }
  done.get();
  if (options_.check_signals) options_.check_signals();
}

void Viewer::begin(const ScenarioLoader& load, bool play) {
  const Clock::time_point begin = Clock::now();
  if (options_.say) options_.say("loading " + options_.level_name + "...");

  // The level, then what the device needs of it.
  std::unique_ptr<Session> session;
  bool measures_exposure = false;
  during("1 of 2: reading the level, finding its solid voxels", true, [&] {
    scenario::Scenario scenario = load();
    measures_exposure = scenario.measure_exposure;
    session = Session::create(std::move(scenario), play).value_or_throw();
  });
  during("2 of 2: preparing textures, shadows and shaders", false, [&] {
    load_screen(session->live().scenario());
    if (!measures_exposure) return;
    std::vector<shared::Hole> holes;
    const float factor = screen_->measure_exposure(
        planning::frame_input(session->live().scenario(), session->simulation(), session->seconds(), holes));
    session->set_first_exposure(std::log2(factor)).value_or_throw();
  });
  char ready[64];
  std::snprintf(ready, sizeof ready, " is ready after %.1f s", seconds_between(begin, Clock::now()));
  if (options_.say) options_.say(options_.level_name + ready);

  // The game.
  game_.emplace(std::move(session), first_choices(options_),
                [this](const std::string& line) { notify(line); });
  if (!options_.begin_at) return;
  game_->session().seek(*options_.begin_at);
  game_->session().set_paused(!options_.exit_after);
}

// The mouse turns the view unless the cursor is needed.
void Viewer::update_mouse_capture(const Input& input) {
  const Choices& choices = game_->choices();
  window_.capture_mouse(!choices.panels && !choices.help && !choices.free_cursor &&
                        !input.is_held(Action::free_cursor));
}

glm::vec3 Viewer::aim() const {
  const glm::vec2 size(glm::max(window_.size_px(), glm::uvec2(1)));
  const glm::vec2 point = window_.captures_mouse() ? glm::vec2(0.5f) : window_.cursor_px() / size;
  return direction_through(game_->player().camera(), size.x / size.y,
                           glm::clamp(point, glm::vec2(0), glm::vec2(1)));
}

void Viewer::act(Action action) {
  game_->act(action, aim());
  if (action == Action::full_screen) window_.toggle_full_screen();
  if (action == Action::screenshot) save_screenshot(free_name(options_.folder, "brume", ".png"));
  if (action == Action::save_recording) save_recording(free_name(options_.folder, "recording", ".toml"));
}

// Advances the clock, and stops it at exactly exit_after.
void Viewer::advance_time(double frame_seconds) {
  const double passes = session().passing(frame_seconds);
  if (!session().paused() && frame_seconds > 0) pace_ += kPaceWeight * (passes / frame_seconds - pace_);
  const double next = session().seconds() + passes;
  // A seek without need would make the light in the smoke start over.
  done_ = options_.exit_after && next >= *options_.exit_after;
  if (done_ || passes > 0) session().seek(done_ ? std::max(*options_.exit_after, session().seconds()) : next);
}

// Handles input, advances the clock and moves the player.
void Viewer::play_frame(const Input& input, double frame_seconds) {
  for (const Action action : input.pressed) act(action);
  for (const std::filesystem::path& file : input.dropped) game_->choose_picture(file);
  advance_time(frame_seconds);
  game_->move(input, frame_seconds);
}

void Viewer::update_quality() {
  const Choices& choices = game_->choices();
  quality_.set_frame_rate(choices.frames_per_second);
  if (!choices.level) {
    quality_.set_automatic();
  } else if (quality_.automatic() || quality_.level() != *choices.level) {
    quality_.fix(*choices.level);
  }
}

void Viewer::lose_for_tests() {
  const auto due = [&](std::optional<double>& at) {
    if (!at || session().seconds() < *at) return false;
    at.reset();
    return true;
  };
  if (due(options_.lose_surface)) screen_->lose_surface();
  if (due(options_.lose_device)) throw gpu::DeviceLost(ErrorCode::no_device, "lost for a test");
}

void Viewer::apply(const UiRequests& requests) {
  if (requests.play) session().play();
  if (requests.seek) session().scrub(*requests.seek);
  for (const Action action : requests.actions) act(action);
}

Notices Viewer::notices() {
  Notices notices;
  notices.lines = notices_.recent();
  notices.device = screen_->context().info().name;
  notices.device_bytes = screen_->context().memory().bytes_in_use();
  notices.quality = &quality_.quality();
  notices.automatic = quality_.automatic();
  notices.pace = pace_;
  if (session().paused()) notices.refinement = painter_.is_best() ? Refinement::done : Refinement::drawing;
  notices.picture_px = screen_->picture_px();
  for (const auto& [name, text] : shaders_.errors()) notices.shader_errors += text;
  return notices;
}

void Viewer::frame() {
  const bool asleep = painter_.is_best() && session().paused();
  window_.poll(asleep ? kIdleSeconds : 0);
  const Clock::time_point begin = Clock::now();
  Input input = window_.take_input();
  update_mouse_capture(input);
  ui_.begin_frame();
  // Input that the panels capture does not reach the game.
  if (ui_.takes_keys()) input = {};
  if (ui_.has_popup() && std::erase(input.pressed, Action::toggle_cursor) > 0) close_popups();
  if (ui_.takes_mouse()) {
    std::erase_if(input.pressed, [](Action a) { return a == Action::throw_smoke || a == Action::shoot; });
    input.wheel = 0;
  }

  const double frame_seconds = last_frame_ ? seconds_between(*last_frame_, begin) : 0;
  last_frame_ = begin;
  play_frame(input, frame_seconds);
  const double tick_seconds = seconds_between(begin, Clock::now());
  apply(ui_.lay_out(*game_, figures_, notices()));
  if (!ui_.is_editing()) game_->settle();

  update_autosave();
  if (const sim::MaskKey key = session().live().scenario().masks.key(); !(key == masks_)) {
    screen_->set_masks(session().live().scenario().masks);
    masks_ = key;
  }
  if (shaders_.update(screen_->context())) game_->change_picture();
  update_quality();
  screen_->set_vertical_sync(game_->choices().vertical_sync);
  lose_for_tests();
  if (painter_.draw(*screen_, *game_, window_, quality_.quality(), frame_seconds, *ImGui::GetDrawData())) {
    finish_frame(begin, frame_seconds, tick_seconds);
  } else {
    painter_.restart();  // render a new image when the window shows again
    window_.poll(kIdleSeconds);
  }
  if (done_ && !options_.screenshot.empty()) save_screenshot(options_.screenshot);
}

void Viewer::finish_frame(Clock::time_point begin, double frame_seconds, double tick_seconds) {
  screen_->wait();
  const double latency = seconds_between(begin, Clock::now());
  FrameLine line{session().seconds(), 1e3 * frame_seconds, 1e3 * tick_seconds,
                 1e3 * latency,       window_.size_px(),   painter_.kind()};
  line.device_bytes = screen_->context().memory().bytes_in_use();
  line.shader_faults = shaders_.errors().size();
  if (options_.log_widgets) log_.add_widgets(ui_.widgets());
  log_.add(line);
  // The first frame has no duration, and paused frames are no measure of the cost of the film.
  if (frame_seconds == 0 || !painter_.in_motion()) return;
  FrameFigures figures;
  figures.frame_ms = 1e3 * frame_seconds;
  figures.tick_ms = 1e3 * tick_seconds;
  figures.latency_ms = 1e3 * latency;
  figures.passes = screen_->timings();
  double device_ms = 0;
  for (const auto& pass : figures.passes) device_ms += pass.milliseconds;
  // Excludes waiting for vertical sync.
  figures.work_ms = device_ms + 1e3 * (tick_seconds + screen_->record_seconds());
  quality_.add_frame(1e-3 * figures.work_ms, frame_seconds);
  figures_.add(std::move(figures));
}

void Viewer::save_screenshot(const std::filesystem::path& picture) {
  const glm::uvec2 size = glm::max(window_.size_px(), glm::uvec2(1));
  screen_->wait();
  const image::Image8 image = screen_->picture(StillFrame(*game_), size);
  painter_.restart();
  const auto saved = save_snapshot(picture, image, game_->snapshot());
  notify(saved ? "saved: " + picture.string() : saved.failure().message);
  if (!saved && done_) throw Error(saved.failure());
}

void Viewer::save_recording(const std::filesystem::path& path) {
  const auto saved = scene::save_timeline(path, session().recording());
  notify(saved ? "saved: " + path.string() : saved.failure().message);
  if (!saved && done_) throw Error(saved.failure());
}

ViewerReport Viewer::report() {
  done_ = true;
  if (!options_.record.empty()) save_recording(options_.record);
  ViewerReport report;
  report.device = screen_->context().info().name;
  report.quality = quality_.quality().name;
  report.frames = figures_.count();
  report.seconds = session().seconds();
  report.frames_per_second = figures_.frames_per_second();
  report.work_ms = figures_.median(&FrameFigures::work_ms);
  report.latency_ms = figures_.median(&FrameFigures::latency_ms);
  report.tick_ms = figures_.median(&FrameFigures::tick_ms);
  for (const std::string& name : figures_.pass_names())
    report.passes_ms.emplace_back(name, figures_.pass_median(name));
  report.tick = session().simulation().world().tick();
  report.state_hash = session().simulation().world().state_hash();
  report.process_bytes = resident_bytes();
  report.device_bytes = screen_->context().memory().bytes_in_use();
  report.shader_reloads = shaders_.reloads();
  report.devices_lost = devices_lost_;
  screen_->wait();
  take_messages();
  report.validation_messages = std::move(messages_);
  return report;
}

}  // namespace

ViewerReport run_viewer(const ScenarioLoader& load, bool play, const ViewerOptions& options) {
  return Viewer(load, play, options).run();
}

}  // namespace brume::viewer
