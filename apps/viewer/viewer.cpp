#include "apps/viewer/viewer.hpp"

#include <imgui.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "apps/viewer/document.hpp"
#include "apps/viewer/job.hpp"
#include "apps/viewer/painter.hpp"
#include "apps/viewer/screenshot.hpp"
#include "apps/viewer/shader_reload.hpp"
#include "apps/viewer/ui.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

using Clock = std::chrono::steady_clock;

// A device that keeps getting lost is broken.
constexpr std::size_t kMostLostDevices = 5;
// How long the window sleeps between events while its picture does not change.
constexpr double kIdleSeconds = 0.05;

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

class Viewer {
 public:
  Viewer(Window& window, Document& document, const ViewerOptions& options)
      : options_(options), document_(document), window_(window), ui_(window), shaders_(options.shaders) {
    make_screen();
    if (options_.say) options_.say("loading " + options_.level_name + "...");
    job_ = std::make_unique<Job>(document_.make());
  }
  ~Viewer() {
    job_.reset();
    release_screen();
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  ViewerReport run() {
    try {
      while (!window_.should_close() && !done_) {
        if (options_.check_signals) options_.check_signals();
        try {
          document_.is_loaded() ? frame() : loading_frame();
        } catch (const gpu::DeviceLost&) {
          recover();
        }
      }
      ViewerReport result = report();
      document_.discard();
      return result;
    } catch (...) {
      document_.rescue();
      throw;
    }
  }

 private:
  // The screen.

  void make_screen() {
    painter_ = std::make_unique<Painter>(
        window_, ScreenOptions{options_.device, options_.validation, options_.vertical_sync});
  }
  void release_screen() {
    if (painter_) screen().finish();
    document_.release();
    painter_.reset();
  }
  Screen& screen() { return painter_->screen(); }
  void take_messages() {
    for (std::string& message : screen().context().take_validation_messages())
      messages_.push_back(std::move(message));
  }

  // Recreates all GPU state after a device loss; what is shown is unaffected.
  void recover() {
    take_messages();
    if (++devices_lost_ > kMostLostDevices)
      throw gpu::DeviceLost(ErrorCode::no_device, "the device is lost repeatedly");
    ImGui::EndFrame();  // the loss may have interrupted a frame
    release_screen();
    make_screen();
    if (document_.is_loaded() || !job_) prepare(!job_);
    document_.notify("the device was lost and has been recreated");
  }
  void lose_for_tests() {
    const auto due = [&](const std::optional<double>& at, bool& is_lost) {
      return at && document_.seconds() >= *at && !std::exchange(is_lost, true);
    };
    if (due(options_.lose_surface, surface_lost_)) screen().lose_surface();
    if (due(options_.lose_device, device_lost_))
      throw gpu::DeviceLost(ErrorCode::no_device, "lost for a test");
  }

  // Loading.

  Work work() const {
    Work work = document_.making();
    work.seconds = job_->seconds();
    work.progress = progress_to_show(0);
    work.stops = job_->stops();
    return work;
  }

  // Prepares in another thread, which has the device for itself: the window draws nothing new, but stays
  // alive.
  void prepare(bool takes_made) {
    screen().wait();
    auto done = std::async(std::launch::async, [&] { document_.prepare(screen(), takes_made); });
    while (done.wait_for(std::chrono::milliseconds(10)) != std::future_status::ready) window_.poll(0);
    done.get();
    if (takes_made) document_.adopt();
  }

  // Replaces what was shown by what the finished job has made.
  void adopt() {
    const std::unique_ptr<Job> job = std::move(job_);
    const bool is_first = !document_.is_loaded();
    try {
      job->take();
      if (const std::string then = document_.making().then; !then.empty()) show_loading({then, ""});
      prepare(true);
    } catch (const gpu::DeviceLost&) {
      throw;
    } catch (const Error& error) {
      if (is_first) throw;
      return document_.notify(error.what());
    }
    if (!is_first) return;
    last_frame_.reset();
    char ready[64];
    std::snprintf(ready, sizeof ready, " is ready after %.1f s", job->seconds());
    if (options_.say) options_.say(options_.level_name + ready);
  }

  void show_loading(const Work& work) {
    screen().wait();
    ui_.begin_frame();
    if (ui_.lay_out_loading(options_.level_name, work, options_.overlay)) job_->stop();
    if (!screen().begin()) return;
    screen().show([](gpu::Recorder&) {}, nullptr, *ImGui::GetDrawData());
    screen().wait();
  }

  // One frame while there is nothing to show yet. Work that nobody can stop shows only its seconds.
  void loading_frame() {
    window_.poll(0);
    if (job_->wait(kIdleSeconds)) return adopt();
    const Work now = work();
    if (!now.can_stop && (!options_.overlay || std::floor(now.seconds) == shown_seconds_)) return;
    shown_seconds_ = std::floor(now.seconds);
    show_loading(now);
    if (now.can_stop) log_frame({}, PictureKind::film);
  }

  // A frame.

  /// The input that the panels leave.
  Input take_input() {
    Input input = window_.take_input();
    window_.capture_mouse(document_.captures_mouse(input));
    ui_.begin_frame();
    if (ui_.takes_keys()) input = {};
    if (ui_.has_popup() && std::erase(input.pressed, Action::toggle_cursor) > 0) close_popups();
    if (ui_.takes_mouse()) {
      std::erase_if(input.pressed, [](Action a) {
        return a == kThrowSmoke || a == kShoot || a == Action::orbit || a == Action::pan;
      });
      input.wheel = 0;
    }
    return input;
  }
  void act(Action action) {
    document_.act(action);
    if (action == Action::close_popup) close_popups();
    if (action == Action::full_screen) window_.toggle_full_screen();
    if (action == Action::screenshot) save_picture(free_name(options_.folder, "brume", ".png"));
    if (action == Action::save_recording)
      save_recording(free_name(options_.folder, document_.name_of_recording(), ".toml"));
  }
  void apply(const UiRequests& requests) {
    document_.apply(requests);
    for (const Action action : requests.actions) act(action);
    if (requests.stop && job_) job_->stop();
    if (requests.pack && !job_) job_ = std::make_unique<Job>(document_.make());
  }
  Status status() {
    Status status;
    status.lines = document_.recent_notices();
    if (job_) status.work = work();
    status.device = screen().context().info().name;
    status.device_bytes = screen().context().memory().bytes_in_use();
    status.timings = screen().timings();
    for (const auto& [name, text] : shaders_.errors()) status.shader_errors += text;
    return status;
  }

  void frame() {
    const bool is_idle = painter_->kind() == PictureKind::best && document_.is_at_rest();
    window_.poll(is_idle ? kIdleSeconds : 0);
    if (job_ && job_->wait(0)) adopt();
    const Clock::time_point begin = Clock::now();
    const Input input = take_input();

    // Input and time.
    const double frame_seconds = last_frame_ ? seconds_between(*last_frame_, begin) : 0;
    last_frame_ = begin;
    for (const Action action : input.pressed) act(action);
    done_ = document_.advance(frame_seconds);
    document_.move(input, frame_seconds, !ui_.takes_mouse());
    FrameFigures figures;
    figures.frame_ms = 1e3 * frame_seconds;
    figures.tick_ms = 1e3 * seconds_between(begin, Clock::now());

    // Panels.
    apply(ui_.lay_out(document_, status()));
    if (!ui_.is_editing()) document_.settle();

    // The picture.
    document_.update(shaders_.update(screen().context()));
    screen().set_vertical_sync(document_.choices().vertical_sync);
    lose_for_tests();
    if (painter_->draw(document_, frame_seconds, *ImGui::GetDrawData())) {
      finish_frame(begin, std::move(figures));
    } else {
      window_.poll(kIdleSeconds);
    }
    if (done_ && !options_.screenshot.empty()) save_picture(options_.screenshot);
  }

  void finish_frame(Clock::time_point begin, FrameFigures figures) {
    screen().wait();
    figures.latency_ms = 1e3 * seconds_between(begin, Clock::now());
    figures.passes = screen().timings();
    log_frame(figures, painter_->kind());
    document_.finish_frame(std::move(figures), painter_->kind());
  }
  void log_frame(const FrameFigures& figures, PictureKind kind) {
    if (!log_) log_.emplace(options_.frame_log);
    FrameLine line{document_.is_loaded() ? document_.seconds() : 0,
                   figures.frame_ms,
                   figures.tick_ms,
                   figures.latency_ms,
                   window_.size_px(),
                   kind};
    line.device_bytes = screen().context().memory().bytes_in_use();
    line.shader_faults = shaders_.errors().size();
    if (options_.log_widgets) log_->add_widgets(ui_.widgets());
    log_->add(line);
  }

  // Files and the end.

  void save_picture(const std::filesystem::path& path) {
    screen().wait();
    const glm::uvec2 size = glm::max(window_.size_px(), glm::uvec2(1));
    const auto saved =
        document_.say_saved(path, painter_->save(document_, path, size, done_, options_.check_signals));
    if (!saved && done_) throw Error(saved.failure());
  }
  void save_recording(const std::filesystem::path& path) {
    const auto saved = document_.save_recording(path);
    if (!saved && done_) throw Error(saved.failure());
  }

  ViewerReport report() {
    done_ = true;
    job_.reset();
    if (document_.is_loaded() && !options_.record.empty()) save_recording(options_.record);
    screen().wait();
    ViewerReport report;
    report.device = screen().context().info().name;
    document_.report(report);
    report.process_bytes = resident_bytes();
    report.device_bytes = screen().context().memory().bytes_in_use();
    report.shader_reloads = shaders_.reloads();
    report.devices_lost = devices_lost_;
    take_messages();
    report.validation_messages = std::move(messages_);
    return report;
  }

  const ViewerOptions& options_;
  Document& document_;
  Window& window_;
  Ui ui_;
  std::optional<FrameLog> log_;  ///< From the first frame on: an earlier file remains until then.
  ShaderReload shaders_;
  std::unique_ptr<Painter> painter_;

  std::unique_ptr<Job> job_;   ///< Running, or null.
  double shown_seconds_ = -1;  ///< Age of the job as shown.
  std::optional<Clock::time_point> last_frame_;
  bool done_ = false;
  std::vector<std::string> messages_;  ///< From the validation layers.
  std::size_t devices_lost_ = 0;
  bool surface_lost_ = false, device_lost_ = false;  ///< For tests.
};

template <typename Make>
ViewerReport run(const Make& make, KeyMap keys, bool play, const ViewerOptions& options) {
  Window window(options.size_px, "Brume - " + options.level_name, keys);
  const std::unique_ptr<Document> document = make_document(window, make, play, options);
  return Viewer(window, *document, options).run();
}

}  // namespace

ViewerReport run_viewer(const ScenarioLoader& load, bool play, const ViewerOptions& options) {
  return run(load, KeyMap::level, play, options);
}

ViewerReport run_viewer(const TankMaker& make, bool play, const ViewerOptions& options) {
  return run(make, KeyMap::tank, play, options);
}

}  // namespace brume::viewer
