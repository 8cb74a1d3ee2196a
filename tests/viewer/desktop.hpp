// A virtual desktop (Xvfb), and a program on it that the test controls by keyboard and mouse.
#pragma once

// gtest comes before X11, whose macros break it.
#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "image/image.hpp"

struct _XDisplay;

namespace brume::viewer {

/// A virtual display of 1280 x 720, stopped by the destructor.
class Desktop {
 public:
  /// Fails the test if Xvfb is missing.
  Desktop();
  ~Desktop();
  Desktop(const Desktop&) = delete;
  Desktop& operator=(const Desktop&) = delete;
  _XDisplay* display() const { return display_; }
  const std::string& name() const { return name_; }  ///< ":7"

 private:
  pid_t server_ = -1;
  std::string name_;
  _XDisplay* display_ = nullptr;
};

/// A line of the frame log.
struct Frame {
  std::uint64_t number = 0;  ///< From 1.
  double seconds = 0;        ///< Session time.
  glm::uvec2 size_px{0};
  std::string picture;  ///< film, still or best.
  std::uint64_t mapped_bytes = 0, heap_bytes = 0, device_bytes = 0;
  std::size_t shader_faults = 0;
};

/// A widget of the panels, as the frame log lists it (--log-widgets).
struct WidgetLine {
  std::string id, kind, label;
  glm::ivec2 low_px{0}, high_px{0};
  bool reachable = false;  ///< Not scrolled away.
  bool in_popup = false;
  std::uint64_t uses = 0;  ///< Clicks so far.
};

/// `brume view` on a desktop. Tests wait for frames, for its session time or for an image, never for
/// wall-clock time: they pass on a machine of any speed.
class Program {
 public:
  Program(const Desktop& desktop, const std::filesystem::path& folder,
          const std::vector<std::string>& arguments);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Waits until the window shows an image, and gives it the keyboard focus. False if it never does.
  bool wait_for_window();
  bool runs();
  /// Waits for its end; returns the exit code, 128 + signal if a signal ended it.
  int wait();
  std::string error() const;  ///< Standard error so far.

  void key(unsigned long symbol, bool down);
  void tap(unsigned long symbol);
  void button(unsigned number, bool down);  ///< 1: left, 2: middle, 3: right.
  void click(unsigned number);
  void move_mouse(int x, int y);   ///< Relative [px].
  void place_mouse(int x, int y);  ///< In window coordinates.
  void resize(unsigned width, unsigned height);
  void hide();  ///< Minimizes the window.
  void show();
  void close();              ///< As the close button does.
  void kill();               ///< By SIGKILL: it can save nothing any more.
  void terminate();          ///< By SIGTERM.
  image::Image8 contents();  ///< The current contents of the window.

  /// All frames drawn so far.
  const std::vector<Frame>& frames();
  /// The widgets of the last frame drawn so far.
  const std::vector<WidgetLine>& widgets();
  /// Clicks that the widget of this id took in any frame so far, also if it is gone.
  std::uint64_t widget_uses(const std::string& id);
  // Every wait fails if the program ends or hangs.
  /// Waits until the window contents satisfy `wanted`.
  bool wait_for_contents(const std::function<bool(const image::Image8&)>& wanted);
  /// Waits until the last frame satisfies `wanted`.
  bool wait_for_frame(const std::function<bool(const Frame&)>& wanted);
  /// Waits for more frames. After two, all earlier input has been handled.
  bool wait_for_frames(std::size_t count);
  /// Waits until earlier input has been handled and the session time has then advanced by this much.
  bool wait_for_clock(double seconds);
  /// For a paused program: waits until earlier input has been handled and the window shows the full-quality
  /// image.
  bool wait_for_best();

 private:
  void read_line(const std::string& line);
  bool wait_until(const std::function<bool()>& holds, int poll_ms);
  const Desktop& desktop_;
  std::filesystem::path error_file_, log_file_;
  std::ifstream log_;
  std::string log_rest_;  ///< An incomplete line.
  std::vector<Frame> frames_;
  std::vector<WidgetLine> widgets_;
  std::map<std::string, std::uint64_t> widget_uses_;
  pid_t process_ = -1;
  int status_ = 0;
  unsigned long window_ = 0;
};

}  // namespace brume::viewer
