#include "apps/viewer/viewer.hpp"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <deque>

#include "apps/viewer/autosave.hpp"
#include "apps/viewer/frame_log.hpp"
#include "apps/viewer/screen.hpp"
#include "apps/viewer/screenshot.hpp"
#include "apps/viewer/shader_reload.hpp"
#include "apps/viewer/ui.hpp"
#include "core/log.hpp"
#include "render/playback.hpp"
#include "scenario/aim.hpp"
#include "scene/timeline_writer.hpp"

namespace brume::viewer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kNoticeSeconds = 4;
constexpr std::size_t kMostNotices = 4;
// A device that keeps getting lost is broken.
constexpr std::size_t kMostLostDevices = 5;
// A paused window sleeps between events.
constexpr double kIdleSeconds = 0.05;

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// Everything that a paused image depends on: it is rendered again only if the key changes.
struct PictureKey {
  double seconds = -1;
  glm::vec3 eye{0}, target{0};
  float vertical_fov = 0;
  glm::uvec2 size_px{0};
  std::uint64_t changes = 0;
  bool operator==(const PictureKey&) const = default;
};

class Viewer {
 public:
  Viewer(scenario::Scenario scenario, bool play, const ViewerOptions& options)
      : options_(options),
        session_(Session::create(std::move(scenario), play).value_or_throw()),
        autosave_(options.folder),
        window_(options.size_px, options.title),
        ui_(window_),
        quality_(options.frames_per_second),
        log_(options.frame_log),
        shaders_(options.shaders) {
    choices_.weapons = options.weapons;
    choices_.view = options.view;
    choices_.panels = options.panels;
    choices_.overlay = options.overlay;
    choices_.level = options.level;
    choices_.frames_per_second = options.frames_per_second;
    choices_.vertical_sync = options.vertical_sync;
    go_to_start();
    if (options.begin_at) {
      session_->seek(*options.begin_at);
      session_->set_paused(true);
    }
    make_screen();
  }

  ViewerReport run() {
    announce_recovered_sessions();
    try {
      run_frames();
      ViewerReport result = report();
      autosave_.discard();
      return result;
    } catch (...) {
      if (autosave_.finish(*session_))
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

  void make_screen() {
    screen_ =
        std::make_unique<Screen>(window_, session_->live().scenario(),
                                 ScreenOptions{options_.device, options_.validation, choices_.vertical_sync});
    masks_ = session_->live().scenario().masks.key();
    continues_ = false;
    rendered_ = {};
  }

  // Recreates all GPU state after a device loss; the session is unaffected.
  void recover() {
    take_messages();
    if (++devices_lost_ > kMostLostDevices)
      throw gpu::DeviceLost(ErrorCode::no_device, "the device is lost repeatedly");
    ImGui::EndFrame();  // the loss may have interrupted a frame
    screen_.reset();
    make_screen();
    notify("the device was lost and has been recreated");
  }

  void notify(const std::string& line) {
    notices_.push_back({line, Clock::now()});
    if (notices_.size() > kMostNotices) notices_.pop_front();
  }
  void notify_failure(const Result<void>& done) {
    if (!done) notify(done.failure().message);
  }

  const voxel::BitGrid& grid() const { return session_->simulation().world().grid(); }
  void go_to_start() {
    const scenario::Scenario& scenario = session_->live().scenario();
    player_.go_to(grid(), scene::camera_at(scenario.timeline, scenario.camera, 0));
  }

  void frame();
  void play_frame(const Input& input, double frame_seconds);
  void advance_time(double frame_seconds);
  void act(Action action);
  void perform(Action action);
  void choose(Action action);
  void update_mouse_capture(const Input& input);
  void apply(const UiRequests& requests);
  void update_quality();
  bool draw();
  bool is_still();
  render::FrameInput frame_input(std::vector<shared::Hole>& holes) const;
  void lose_for_tests();
  void finish_frame(Clock::time_point begin, double frame_seconds, double tick_seconds);
  void save_screenshot(const std::filesystem::path& picture);
  void save_recording(const std::filesystem::path& path);
  glm::vec3 aim() const;
  void take_messages();
  Notices notices();
  ViewerReport report();

  struct Notice {
    std::string line;
    Clock::time_point time;
  };

  ViewerOptions options_;
  std::unique_ptr<Session> session_;
  Autosave autosave_;
  Window window_;
  Ui ui_;
  Player player_;
  QualityControl quality_;
  FrameLog log_;
  ShaderReload shaders_;
  Choices choices_;
  Figures figures_;
  std::unique_ptr<Screen> screen_;
  sim::MaskKey masks_{};  ///< Key of the masks that the screen has.

  std::optional<Clock::time_point> last_frame_;
  std::uint32_t frame_index_ = 0;
  bool continues_ = false;  ///< The next frame may accumulate with the previous one.
  PictureKey rendered_;
  int still_frames_ = 0;        ///< Frames since the image changed.
  bool in_motion_ = false;      ///< This frame renders a new image of the running film.
  bool still_is_best_ = false;  ///< The paused image has full quality.
  std::uint64_t changes_ = 0;
  bool done_ = false;
  std::deque<Notice> notices_;
  std::vector<std::string> messages_;  ///< From the validation layers.
  std::size_t devices_lost_ = 0;
};

void Viewer::take_messages() {
  for (std::string& message : screen_->context().take_validation_messages())
    messages_.push_back(std::move(message));
}

// The mouse turns the view unless the cursor is needed.
void Viewer::update_mouse_capture(const Input& input) {
  window_.capture_mouse(!choices_.panels && !choices_.help && !choices_.free_cursor &&
                        !input.is_held(Action::free_cursor));
}

glm::vec3 Viewer::aim() const {
  const glm::vec2 size(glm::max(window_.size_px(), glm::uvec2(1)));
  const glm::vec2 point = window_.captures_mouse() ? glm::vec2(0.5f) : window_.cursor_px() / size;
  return direction_through(player_.camera(), size.x / size.y, glm::clamp(point, glm::vec2(0), glm::vec2(1)));
}

// Actions that change the level.
void Viewer::perform(Action action) {
  const glm::vec3 eye = player_.camera().position_world;
  if (action == Action::throw_smoke) notify_failure(session_->throw_smoke(eye, aim()));
  if (action == Action::shoot) notify_failure(session_->shoot(eye, aim(), choices_.weapons));
  if (action == Action::blast) notify_failure(session_->blast(eye, aim(), choices_.weapons));
  if (action == Action::door) {
    const auto door = session_->use_door(eye);
    notify(door ? *door : door.failure().message);
  }
  if (action == Action::reset) {
    notify_failure(session_->reset());
    go_to_start();
    choices_.probe = {};
  }
}

// Actions that change settings of the weapons or the view.
void Viewer::choose(Action action) {
  if (action == Action::shape_bullet) choices_.weapons.kind = ShotKind::bullet;
  if (action == Action::shape_glyph) choices_.weapons.kind = ShotKind::glyph;
  if (action == Action::shape_word) choices_.weapons.kind = ShotKind::word;
  if (action == Action::shape_picture) choices_.weapons.kind = ShotKind::picture;
  if (action == Action::fly) player_.set_flying(grid(), !player_.flying());
  if (action == Action::panels) choices_.panels = !choices_.panels;
  if (action == Action::overlay) choices_.overlay = !choices_.overlay;
  if (action == Action::help) choices_.help = !choices_.help;
  if (action == Action::toggle_cursor) choices_.free_cursor = !choices_.free_cursor;
  if (action == Action::full_screen) window_.toggle_full_screen();
  if (action == Action::next_view) {
    const auto next = (static_cast<std::size_t>(choices_.view) + 1) % passes::kDebugViewNames.size();
    choices_.view = static_cast<passes::DebugView>(next);
    ++changes_;
  }
  if (action == Action::probe) {
    const glm::vec3 eye = player_.camera().position_world, direction = aim();
    const scenario::Aim aimed = scenario::aim(grid(), eye, direction);
    // Just in front of the wall, which would block the line of sight.
    const float back = 0.5f * grid().layout().voxel_size;
    choices_.probe.pick(eye + std::max(aimed.meets.value_or(10) - back, 0.0f) * direction);
  }
}

void Viewer::act(Action action) {
  perform(action);
  choose(action);
  if (action == Action::pause) session_->set_paused(!session_->paused());
  if (action == Action::step_back) session_->step(-1);
  if (action == Action::step_on) session_->step(1);
  if (action == Action::screenshot) save_screenshot(free_name(options_.folder, "brume", ".png"));
  if (action == Action::save_recording) save_recording(free_name(options_.folder, "recording", ".toml"));
}

// Advances the clock, and stops it at exactly exit_after.
void Viewer::advance_time(double frame_seconds) {
  const double next = session_->seconds() + session_->passing(frame_seconds);
  done_ = options_.exit_after && next >= *options_.exit_after;
  session_->seek(done_ ? std::max(*options_.exit_after, session_->seconds()) : next);
}

// Handles input, advances the clock and moves the player.
void Viewer::play_frame(const Input& input, double frame_seconds) {
  for (const Action action : input.pressed) act(action);
  const bool turned = input.look_px != glm::dvec2(0);
  if (session_->follows_path()) {
    constexpr std::array kMoves{Action::forward, Action::back, Action::left,
                                Action::right,   Action::up,   Action::down};
    const bool moved = std::any_of(kMoves.begin(), kMoves.end(), [&](Action a) { return input.is_held(a); });
    if (turned || moved) session_->leave_path();
  }
  advance_time(frame_seconds);
  if (session_->follows_path()) {
    player_.follow(session_->path_camera());
    return;
  }
  player_.turn(input.look_px);
  if (input.wheel != 0) player_.change_fly_speed(grid(), input.wheel);
  player_.move(input, grid(), std::min(frame_seconds, Session::kLongestFrame));
  if (!session_->paused()) session_->record_camera(player_.camera());
}

render::FrameInput Viewer::frame_input(std::vector<shared::Hole>& holes) const {
  render::FrameInput input =
      render::frame_input(session_->live().scenario(), session_->simulation(), session_->seconds(), holes);
  input.view.camera = player_.camera();
  input.debug = {choices_.view, choices_.slice};
  return input;
}

// Whether the paused image is up to date. draw() renders it once more at full quality after a few frames: it
// is then identical to that of `brume render`.
bool Viewer::is_still() {
  const scene::Camera camera = player_.camera();
  const PictureKey now{session_->seconds(), camera.position_world, camera.target_world,
                       camera.vertical_fov, window_.size_px(),     changes_};
  if (now != rendered_) {
    rendered_ = now;
    still_frames_ = 0;
    still_is_best_ = false;
    return false;
  }
  ++still_frames_;
  return session_->paused();
}

bool Viewer::draw() {
  constexpr int kFramesUntilBest = 3;
  const bool still = is_still();
  const bool best = still && still_frames_ >= kFramesUntilBest && !still_is_best_;
  in_motion_ = !still;
  if (still && !best) return screen_->show(nullptr, quality_.quality(), *ImGui::GetDrawData());
  std::vector<shared::Hole> holes;
  render::FrameInput input = frame_input(holes);
  const Quality& quality = best ? quality_levels().front() : quality_.quality();
  input.view.continues = continues_ && choices_.temporal && !best;
  input.view.frame_index = best ? 0 : ++frame_index_;
  input.quality.step_scale = quality.step_scale;
  input.quality.resolve_error_scale = quality.resolve_error_scale;
  input.quality.light_update_fraction = quality.light_update_fraction;
  continues_ = !best;
  still_is_best_ = best;
  return screen_->show(&input, quality, *ImGui::GetDrawData());
}

void Viewer::update_quality() {
  quality_.set_frame_rate(choices_.frames_per_second);
  if (!choices_.level) {
    quality_.set_automatic();
  } else if (quality_.automatic() || quality_.level() != *choices_.level) {
    quality_.fix(*choices_.level);
  }
}

void Viewer::lose_for_tests() {
  const auto due = [&](std::optional<double>& at) {
    if (!at || session_->seconds() < *at) return false;
    at.reset();
    return true;
  };
  if (due(options_.lose_surface)) screen_->lose_surface();
  if (due(options_.lose_device)) throw gpu::DeviceLost(ErrorCode::no_device, "lost for a test");
}

void Viewer::apply(const UiRequests& requests) {
  if (requests.changed_picture) ++changes_;
  if (requests.play) session_->play();
  if (requests.seek) session_->scrub(*requests.seek);
  for (const Action action : requests.actions) act(action);
}

Notices Viewer::notices() {
  while (!notices_.empty() && seconds_between(notices_.front().time, Clock::now()) > kNoticeSeconds)
    notices_.pop_front();
  Notices notices;
  for (const Notice& notice : notices_) notices.lines.push_back(notice.line);
  notices.device = screen_->context().info().name;
  notices.device_bytes = screen_->context().memory().bytes_in_use();
  notices.quality = &quality_.quality();
  notices.picture_px = screen_->picture_px();
  for (const auto& [name, text] : shaders_.errors()) notices.shader_errors += text;
  return notices;
}

void Viewer::frame() {
  const bool asleep = still_is_best_ && session_->paused();
  window_.poll(asleep ? kIdleSeconds : 0);
  const Clock::time_point begin = Clock::now();
  Input input = window_.take_input();
  update_mouse_capture(input);
  ui_.begin_frame();
  // Input that the panels capture does not reach the game.
  if (ui_.takes_keys()) input = {};
  if (ui_.takes_mouse())
    std::erase_if(input.pressed, [](Action a) { return a == Action::throw_smoke || a == Action::shoot; });

  const double frame_seconds = last_frame_ ? seconds_between(*last_frame_, begin) : 0;
  last_frame_ = begin;
  play_frame(input, frame_seconds);
  const double tick_seconds = seconds_between(begin, Clock::now());
  apply(ui_.lay_out(choices_, *session_, player_, figures_, notices()));

  notify_failure(autosave_.update(*session_));
  if (const sim::MaskKey key = session_->live().scenario().masks.key(); !(key == masks_)) {
    screen_->set_masks(session_->live().scenario().masks);
    masks_ = key;
  }
  if (shaders_.update(screen_->context())) ++changes_;
  update_quality();
  screen_->set_vertical_sync(choices_.vertical_sync);
  lose_for_tests();
  if (draw()) {
    finish_frame(begin, frame_seconds, tick_seconds);
  } else {
    rendered_ = {};  // render a new image when the window shows again
    window_.poll(kIdleSeconds);
  }
  if (done_ && !options_.screenshot.empty()) save_screenshot(options_.screenshot);
}

void Viewer::finish_frame(Clock::time_point begin, double frame_seconds, double tick_seconds) {
  screen_->wait();
  const double latency = seconds_between(begin, Clock::now());
  FrameLine line{session_->seconds(), 1e3 * frame_seconds, 1e3 * tick_seconds, 1e3 * latency,
                 window_.size_px()};
  if (!in_motion_) line.picture = still_is_best_ ? PictureKind::best : PictureKind::still;
  line.device_bytes = screen_->context().memory().bytes_in_use();
  line.shader_faults = shaders_.errors().size();
  log_.add(line);
  // The first frame has no duration, and paused frames are no measure of the cost of the film.
  if (frame_seconds == 0 || !in_motion_) return;
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
  std::vector<shared::Hole> holes;
  const glm::uvec2 size = glm::max(window_.size_px(), glm::uvec2(1));
  screen_->wait();
  const image::Image8 image = screen_->picture(frame_input(holes), size);
  continues_ = false;
  still_is_best_ = false;
  const auto saved = save_snapshot(picture, image, session_->snapshot(player_.camera()));
  notify(saved ? "saved: " + picture.string() : saved.failure().message);
  if (!saved && done_) throw Error(saved.failure());
}

void Viewer::save_recording(const std::filesystem::path& path) {
  const auto saved = scene::save_timeline(path, session_->recording());
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
  report.seconds = session_->seconds();
  report.frames_per_second = figures_.frames_per_second();
  report.work_ms = figures_.median(&FrameFigures::work_ms);
  report.latency_ms = figures_.median(&FrameFigures::latency_ms);
  report.tick_ms = figures_.median(&FrameFigures::tick_ms);
  for (const std::string& name : figures_.pass_names())
    report.passes_ms.emplace_back(name, figures_.pass_median(name));
  report.tick = session_->simulation().world().tick();
  report.state_hash = session_->simulation().world().state_hash();
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

ViewerReport run_viewer(scenario::Scenario scenario, bool play, const ViewerOptions& options) {
  return Viewer(std::move(scenario), play, options).run();
}

}  // namespace brume::viewer
