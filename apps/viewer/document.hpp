// What a window shows and edits: a level that is played, or a tank of spheres. The viewer's loop, window and
// user interface are the same for both.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/figures.hpp"
#include "apps/viewer/frame_log.hpp"
#include "apps/viewer/notice_list.hpp"
#include "apps/viewer/refiner.hpp"
#include "apps/viewer/screen.hpp"
#include "apps/viewer/viewer_options.hpp"
#include "apps/viewer/window_choices.hpp"
#include "core/progress.hpp"

namespace brume::viewer {

/// Work of another thread.
struct Work {
  std::string title;  ///< "packing spheres"
  std::string then;   ///< What comes after it, on the device; empty: nothing is said.
  bool can_stop = false, stops = false;
  double seconds = 0;  ///< Since its begin.
  std::optional<Progress::State> progress = std::nullopt;
};

/// What the viewer says of every document.
struct Status {
  std::vector<std::string> lines;  ///< Recent messages, the newest last.
  std::optional<Work> work;
  std::string device;
  std::uint64_t device_bytes = 0;
  std::vector<gpu::Timings::Scope> timings;  ///< GPU times of the last frame.
  std::string shader_errors;                 ///< Empty: none.
};

/// Requests from the widgets, applied after the layout.
struct UiRequests {
  std::optional<double> seek;  ///< [s]
  std::vector<Action> actions;
  bool play = false;                ///< Replay from the start along the camera path.
  bool pack = false, stop = false;  ///< Begin work, and end it early.
};

/// Begins work of another thread, which ends early when its argument returns true.
using Maker = std::function<void(const std::function<bool()>& stopped)>;

/// Marks a time on the slider, in a colour.
using TimeMark = std::function<void(double seconds, std::uint32_t colour)>;

inline WindowChoices first_window_choices(const ViewerOptions& options) {
  return {options.panels, false, options.overlay, options.vertical_sync};
}

class Document {
 public:
  virtual ~Document() = default;

  // Loading: make(), in another thread and without a device, prepare() and adopt(). Once more for each
  // UiRequests::pack; prepare() after the loss of a device, too.

  /// How the work is announced.
  virtual Work making() const = 0;
  virtual Maker make() = 0;
  /// Makes what the screen needs, in another thread that has the device for itself: of what make() made last
  /// if it `takes_made` and that is not adopted, else of what is shown.
  virtual void prepare(Screen& screen, bool takes_made) = 0;
  /// Shows what make() made last from now on, unless it does already.
  virtual void adopt() = 0;
  virtual bool is_loaded() const = 0;
  /// Frees what prepare() made: the screen is about to go.
  virtual void release() = 0;

  // Input, once adopted as all below.

  /// Takes an action. The viewer takes the ones that concern its window and files.
  virtual void act(Action action) = 0;
  /// Advances the time; whether that is the end of ViewerOptions::exit_after.
  virtual bool advance(double frame_seconds) = 0;
  /// Input that moves the camera, or what the mouse drags. `has_cursor`: it is not over the panels.
  virtual void move(const Input& input, double frame_seconds, bool has_cursor) = 0;
  virtual void apply(const UiRequests& requests) = 0;
  /// What was changed is a step to undo: no widget is held.
  virtual void settle() = 0;
  /// Whether the mouse turns the view, without a cursor.
  virtual bool captures_mouse(const Input&) const { return false; }
  /// Once a frame, when the device is at rest; whether the viewer's shaders are new.
  virtual void update(bool new_shaders) = 0;

  virtual double seconds() const = 0;
  /// Where the time slider ends [s].
  virtual double end_seconds() const = 0;
  virtual WindowChoices& choices() = 0;

  // User interface, in this order.

  virtual void lay_out_marks() = 0;
  virtual void lay_out_status() = 0;
  /// Whether the overlay says which keys show more.
  virtual bool shows_hint() const = 0;
  virtual void lay_out_sections(const Status& status, UiRequests& requests) = 0;
  virtual void lay_out_buttons(UiRequests& requests) = 0;
  virtual void mark_times(const TimeMark& mark) const = 0;
  virtual KeyMap keys() const = 0;
  virtual const char* help_note() const = 0;

  // Frames.

  /// What draws it; from prepare() until release().
  virtual Refiner& refiner() = 0;
  /// Shows something that requires less of the device from the next frame on, if there is such a thing.
  virtual bool fall_back(const Error&) { return false; }
  /// Takes the times of a frame, when the device has finished it.
  virtual void finish_frame(FrameFigures figures, PictureKind kind) = 0;
  /// Whether nothing moves without an input.
  virtual bool is_at_rest() const = 0;

  // Files.

  /// Saves what reproduces the picture of now, which is saved, too.
  virtual Result<void> save_snapshot(const std::filesystem::path& path) = 0;
  /// What F5 saves: the name of its file without number, and how.
  virtual const char* name_of_recording() const = 0;
  /// Says whether it was saved.
  virtual Result<void> save_recording(const std::filesystem::path& path) = 0;
  /// Removes what would recover the session: the user ends it.
  virtual void discard() {}
  /// Keeps the session so that it can be recovered: the program ends early.
  virtual void rescue() {}
  /// Before adopt(), too.
  virtual void report(ViewerReport& report) const = 0;

  /// Shows a line to the user.
  void notify(const std::string& line) { notices_.add(line); }
  std::vector<std::string> recent_notices() { return notices_.recent(); }

  Result<void> say_saved(const std::filesystem::path& path, Result<void> saved) {
    notify(saved ? "saved: " + path.string() : saved.failure().message);
    return saved;
  }

 private:
  NoticeList notices_;
};

/// Window and options must outlive the document.
std::unique_ptr<Document> make_document(Window& window, ScenarioLoader load, bool play,
                                        const ViewerOptions& options);
std::unique_ptr<Document> make_document(Window& window, TankMaker make, bool play,
                                        const ViewerOptions& options);

}  // namespace brume::viewer
