#include "apps/viewer/tank_viewer.hpp"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "apps/viewer/figures.hpp"
#include "apps/viewer/frame_log.hpp"
#include "apps/viewer/notice_list.hpp"
#include "apps/viewer/screenshot.hpp"
#include "apps/viewer/shader_reload.hpp"
#include "apps/viewer/tank_mouse.hpp"
#include "apps/viewer/tank_painter.hpp"
#include "apps/viewer/tank_ui.hpp"
#include "apps/viewer/ui.hpp"
#include "apps/viewer/widgets.hpp"
#include "image/png.hpp"
#include "scene/tank_writer.hpp"
#include "spheres/file.hpp"

namespace brume::viewer {
namespace {

using TankClock = std::chrono::steady_clock;

// A device that keeps getting lost is broken.
constexpr std::size_t kMostTankDevicesLost = 5;
// A window whose picture is complete sleeps between events.
constexpr double kTankIdleSeconds = 0.05;
// Of the tank's longest side, in a second of a held key; after a slow frame no farther than in this time [s].
constexpr float kGlideSpeed = 0.5f;
constexpr double kLongestGlide = 0.25;

double tank_seconds_between(TankClock::time_point from, TankClock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

class TankViewer {
 public:
  TankViewer(const TankMaker& make, bool play, const ViewerOptions& options)
      : options_(options),
        plays_(play),
        window_(options.size_px, "Brume - " + options.level_name, KeyMap::tank),
        ui_(window_),
        shaders_(options.shaders) {
    choices_.panels = options.panels;
    choices_.overlay = options.overlay;
    choices_.vertical_sync = options.vertical_sync;
    make_screen();
    log_ = FrameLog(options.frame_log);  // An earlier file remains until there is something to write.
    if (options_.say) options_.say("loading " + options_.level_name + "...");
    begin_job("loading or packing spheres", make);
  }

  TankViewerReport run() {
    while (!window_.should_close() && !done_) {
      if (options_.check_signals) options_.check_signals();
      try {
        frame();
      } catch (const gpu::DeviceLost&) {
        recover();
      }
    }
    return report();
  }

 private:
  void make_screen() {
    screen_ = std::make_unique<TankScreen>(
        window_, ScreenOptions{options_.device, options_.validation, options_.vertical_sync});
    painter_.restart();
  }
  void begin_job(const std::string& title, TankMaker make) {
    job_title_ = title;
    job_ = std::make_unique<TankJob>(std::move(make));
  }
  void recover();
  void prepare(const spheres::Tank& tank);
  void adopt();
  void frame();
  void loading_frame(TankClock::time_point begin);
  void handle(const Input& input, double frame_seconds);
  void advance_time(double frame_seconds);
  void act(Action action);
  void apply(const TankRequests& requests);
  void lose_for_tests();
  void draw(TankClock::time_point begin, double frame_seconds);
  void finish_frame(TankClock::time_point begin, double frame_seconds);
  void log_frame(TankClock::time_point begin, double frame_seconds, PictureKind kind);
  void save_screenshot(const std::filesystem::path& picture, bool complete);
  void save(const std::filesystem::path& path, const Result<void>& saved);
  void take_messages();
  TankStatus status();
  std::optional<TankWork> work() const;
  TankViewerReport report();

  ViewerOptions options_;
  bool plays_;
  Window window_;
  Ui ui_;
  FrameLog log_;
  ShaderReload shaders_;
  NoticeList notices_;
  TankPainter painter_;
  TankChoices choices_;
  TankMouse mouse_;
  std::unique_ptr<TankScreen> screen_;

  std::unique_ptr<TankJob> job_;  ///< Running, or null.
  std::string job_title_;
  std::optional<TankState> state_;  ///< Empty while the first tank is made.
  spheres::Tank tank_;

  std::optional<TankClock::time_point> last_frame_;
  double run_seconds_ = 0;  ///< Of options_.exit_after.
  bool done_ = false;
  std::uint64_t frames_ = 0;
  std::size_t packings_ = 0, devices_lost_ = 0;
  std::vector<std::string> messages_;  ///< From the validation layers.
};

void TankViewer::take_messages() {
  for (std::string& message : screen_->context().take_validation_messages())
    messages_.push_back(std::move(message));
}

// Recreates all GPU state after a device loss; the scene is unaffected.
void TankViewer::recover() {
  take_messages();
  if (++devices_lost_ > kMostTankDevicesLost)
    throw gpu::DeviceLost(ErrorCode::no_device, "the device is lost repeatedly");
  ImGui::EndFrame();  // the loss may have interrupted a frame
  screen_.reset();
  make_screen();
  if (state_) prepare(tank_);
  notices_.add("the device was lost and has been recreated");
}

// In another thread, which has the device for itself: the window draws nothing new, but stays alive.
void TankViewer::prepare(const spheres::Tank& tank) {
  screen_->wait();
  auto done = std::async(std::launch::async, [&] { screen_->load(tank, window_.size_px()); });
  while (done.wait_for(std::chrono::milliseconds(10)) != std::future_status::ready) window_.poll(0);
  done.get();
  painter_.restart();
}

// The tank of the finished job takes the place of the one before.
void TankViewer::adopt() {
  const std::unique_ptr<TankJob> job = std::move(job_);
  try {
    scenario::TankScenario made = job->take();
    prepare(made.tank);
    tank_ = std::move(made.tank);
    const glm::vec3 size = planning::size_of(tank_);
    if (state_) {
      ++packings_;
      state_->set_packed(made.scene, size, !job->stops());
      notices_.add("packed " + std::to_string(tank_.spheres.size()) + " spheres");
      return;
    }
    state_.emplace(std::move(made.scene), size);
    state_->set_packed(state_->scene(), size, !job->stops());
  } catch (const gpu::DeviceLost&) {
    throw;
  } catch (const Error& error) {
    if (!state_) throw;
    notices_.add(error.what());
    if (!screen_->is_loaded()) prepare(tank_);
    return;
  }
  char ready[64];
  std::snprintf(ready, sizeof ready, " is ready after %.1f s", job->seconds());
  if (options_.say) options_.say(options_.level_name + ready);
  state_->set_playing(plays_);
  run_seconds_ = options_.begin_at.value_or(0);
  if (options_.begin_at) state_->seek(*options_.begin_at);
  last_frame_.reset();
}

std::optional<TankWork> TankViewer::work() const {
  if (!job_) return std::nullopt;
  return TankWork{job_title_, job_->seconds(), progress_to_show(0), true, job_->stops()};
}

void TankViewer::loading_frame(TankClock::time_point begin) {
  if (options_.overlay) {
    if (lay_out_tank_loading(options_.level_name, *work()).stop) job_->stop();
  } else {
    ImGui::Render();
  }
  if (!screen_->begin()) return;
  screen_->show({}, *ImGui::GetDrawData());
  screen_->wait();
  log_frame(begin, 0, PictureKind::film);
}

void TankViewer::act(Action action) {
  if (action == Action::pause) state_->set_playing(!state_->is_playing());
  if (action == Action::rewind) state_->seek(0);
  if (action == Action::next_view) {
    scene::TankView& view = state_->edit().view;
    view = view == scene::TankView::spheres ? scene::TankView::voxels : scene::TankView::spheres;
  }
  if (action == Action::undo) state_->undo();
  if (action == Action::redo) state_->redo();
  if (action == Action::camera_path) state_->set_follows_path(!state_->follows_path());
  if (action == Action::home) state_->go_home();
  if (action == Action::focus) state_->focus_on_middle(tank_);
  if (action == Action::panels) choices_.panels = !choices_.panels;
  if (action == Action::overlay) choices_.overlay = !choices_.overlay;
  if (action == Action::close_popup) close_popups();
  if (action == Action::help) choices_.help = !choices_.help;
  if (action == Action::full_screen) window_.toggle_full_screen();
  if (action == Action::screenshot) save_screenshot(free_name(options_.folder, "brume", ".png"), false);
  if (action == Action::save_recording) {
    const std::filesystem::path path = free_name(options_.folder, "tank", ".toml");
    save(path, scene::save_tank_scene(path, state_->to_save()));
  }
  if (action == Action::save_tank) {
    const std::filesystem::path path = free_name(options_.folder, "spheres", ".spheres");
    save(path, spheres::save_tank(path, tank_));
  }
}

void TankViewer::save(const std::filesystem::path& path, const Result<void>& saved) {
  notices_.add(saved ? "saved: " + path.string() : saved.failure().message);
}

void TankViewer::handle(const Input& input, double frame_seconds) {
  for (const Action action : input.pressed) act(action);
  const bool has_cursor = !ui_.takes_mouse();
  mouse_.update(*state_, choices_, input, window_.cursor_px(), glm::vec2(window_.size_px()), has_cursor);

  const auto held = [&](Action positive, Action negative) {
    return static_cast<float>(input.is_held(positive)) - static_cast<float>(input.is_held(negative));
  };
  const glm::vec3 steps(held(Action::right, Action::left), held(Action::up, Action::down),
                        held(Action::forward, Action::back));
  if (steps == glm::vec3(0)) return;
  const glm::vec3 size = state_->size();
  const float speed = kGlideSpeed * std::max({size.x, size.y, size.z});
  state_->move_camera(
      glided(state_->camera(), steps * (speed * static_cast<float>(std::min(frame_seconds, kLongestGlide)))));
}

// Advances the time, and stops it at exactly exit_after.
void TankViewer::advance_time(double frame_seconds) {
  if (!options_.exit_after) return state_->advance(frame_seconds);
  run_seconds_ += frame_seconds;
  done_ = run_seconds_ >= *options_.exit_after;
  if (done_) run_seconds_ = *options_.exit_after;
  state_->seek(run_seconds_);
}

void TankViewer::lose_for_tests() {
  const auto due = [&](std::optional<double>& at) {
    if (!at || state_->seconds() < *at) return false;
    at.reset();
    return true;
  };
  if (due(options_.lose_surface)) screen_->lose_surface();
  if (due(options_.lose_device)) throw gpu::DeviceLost(ErrorCode::no_device, "lost for a test");
}

void TankViewer::apply(const TankRequests& requests) {
  if (requests.seek) {
    state_->set_playing(false);
    state_->seek(*requests.seek);
  }
  for (const Action action : requests.actions) act(action);
  if (requests.stop && job_) job_->stop();
  if (requests.pack && !job_)
    begin_job("packing spheres", [scene = state_->scene()](const std::function<bool()>& stopped) {
      return scenario::TankScenario{scene, scenario::make_tank(scene, stopped).value_or_throw()};
    });
}

TankStatus TankViewer::status() {
  TankStatus status;
  status.lines = notices_.recent();
  status.work = work();
  status.samples = screen_->samples();
  status.seconds = painter_.seconds();
  status.moves = painter_.is_moving();
  status.picture_px = screen_->picture_px();
  status.spheres = tank_.spheres.size();
  status.hovered = mouse_.hovered();
  status.device = screen_->context().info().name;
  status.device_bytes = screen_->context().memory().bytes_in_use();
  status.timings = screen_->timings();
  for (const auto& [name, text] : shaders_.errors()) status.shader_errors += text;
  return status;
}

void TankViewer::frame() {
  const bool asleep = !state_ || (painter_.is_best() && !state_->is_playing());
  window_.poll(asleep && !options_.exit_after ? kTankIdleSeconds : 0);
  if (job_ && job_->is_ready()) adopt();
  const TankClock::time_point begin = TankClock::now();
  Input input = window_.take_input();
  ui_.begin_frame();
  if (!state_) return loading_frame(begin);
  // Input that the panels capture does not reach the picture.
  if (ui_.takes_keys()) input = {};
  if (ui_.takes_mouse()) {
    std::erase_if(input.pressed, [](Action a) { return a == Action::orbit || a == Action::pan; });
    input.wheel = 0;
  }

  const double frame_seconds = last_frame_ ? tank_seconds_between(*last_frame_, begin) : 0;
  last_frame_ = begin;
  handle(input, frame_seconds);
  advance_time(frame_seconds);
  apply(lay_out_tank(*state_, choices_, status()));
  if (!ui_.is_editing() && !mouse_.is_dragging()) state_->settle();

  if (shaders_.update(screen_->context())) painter_.restart();
  screen_->set_vertical_sync(choices_.vertical_sync);
  lose_for_tests();
  draw(begin, frame_seconds);
  if (done_ && !options_.screenshot.empty()) save_screenshot(options_.screenshot, true);
}

void TankViewer::draw(TankClock::time_point begin, double frame_seconds) {
  try {
    if (painter_.draw(*screen_, *state_, tank_, *ImGui::GetDrawData()))
      return finish_frame(begin, frame_seconds);
    window_.poll(kTankIdleSeconds);
  } catch (const gpu::DeviceLost&) {
    throw;
  } catch (const Error& error) {
    // Voxels need more memory than spheres.
    if (state_->scene().view == scene::TankView::spheres) throw;
    notices_.add(error.what());
    state_->edit().view = scene::TankView::spheres;
    painter_.restart();
  }
}

void TankViewer::log_frame(TankClock::time_point begin, double frame_seconds, PictureKind kind) {
  FrameLine line;
  line.seconds = state_ ? state_->seconds() : 0;
  line.frame_ms = 1e3 * frame_seconds;
  line.latency_ms = 1e3 * tank_seconds_between(begin, TankClock::now());
  line.size_px = window_.size_px();
  line.picture = kind;
  line.device_bytes = screen_->context().memory().bytes_in_use();
  line.shader_faults = shaders_.errors().size();
  if (options_.log_widgets) log_.add_widgets(ui_.widgets());
  log_.add(line);
}

void TankViewer::finish_frame(TankClock::time_point begin, double frame_seconds) {
  screen_->wait();
  painter_.measure(*screen_);
  ++frames_;
  log_frame(begin, frame_seconds, painter_.kind());
}

void TankViewer::save_screenshot(const std::filesystem::path& picture, bool complete) {
  const glm::uvec2 size = glm::max(window_.size_px(), glm::uvec2(1));
  const std::uint32_t limit = state_->scene().samples;
  screen_->wait();
  painter_.complete(*screen_, *state_, tank_, size, complete ? limit : 1, [&] {
    if (options_.check_signals) options_.check_signals();
    return false;
  });
  const image::Image8 image = screen_->picture();
  const std::filesystem::path scene = snapshot_timeline(picture);
  auto saved = scene::save_tank_scene(scene, state_->snapshot(screen_->samples()));
  if (saved) saved = image::save_png(picture, image);
  save(picture, saved);
  if (saved && !state_->is_complete())
    notices_.add("its scene packs all spheres: save those of this tank, too");
  if (!saved && done_) throw Error(saved.failure());
}

TankViewerReport TankViewer::report() {
  if (job_) job_->stop();
  job_.reset();
  screen_->wait();
  TankViewerReport report;
  report.device = screen_->context().info().name;
  report.frames = frames_;
  if (state_) report.seconds = options_.exit_after ? run_seconds_ : state_->seconds();
  report.spheres = tank_.spheres.size();
  report.samples = screen_->samples();
  report.picture_px = screen_->picture_px();
  report.process_bytes = resident_bytes();
  report.device_bytes = screen_->context().memory().bytes_in_use();
  report.packings = packings_;
  report.shader_reloads = shaders_.reloads();
  report.devices_lost = devices_lost_;
  take_messages();
  report.validation_messages = std::move(messages_);
  return report;
}

}  // namespace

TankViewerReport run_tank_viewer(const TankMaker& make, bool play, const ViewerOptions& options) {
  return TankViewer(make, play, options).run();
}

}  // namespace brume::viewer
